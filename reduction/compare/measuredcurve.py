"""The curve of a test, as a comparison takes it: mean tension on bins of strain, by branch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from reduction.record import Floats, Integers, read_only_arrays, require_shapes
from reduction.uncertainty.product import Component

Loading = Literal["static", "dynamic"]
CurveName = Literal["ascending", "descending", "midline"]
BRANCHES: tuple[CurveName, CurveName] = ("ascending", "descending")
CURVES: tuple[CurveName, ...] = (*BRANCHES, "midline")
NODES_A_BIN = 40
"""Steps of the strains between two bin centres at which a prediction is read."""


@dataclass(frozen=True)
@read_only_arrays
class Reading:
    """How a test shows a curve: weights of the strains between the bin centres.

    Samples lie at some strains of a bin and the mean is moved to its centre; at a kink that is
    not the tension at the centre.  A prediction that is read in the same way has the same kink.

    Parameters
    ----------
    node : ndarray, shape (n_node,)
        Equally spaced strains, `NODES_A_BIN` a bin, from one bin below the first bin. [1]
    weight : ndarray, shape (n_strain, 3 * NODES_A_BIN + 1)
        Of the nodes from the bin below each bin to the bin above it; zero where the judged curve
        is not known. [1]
    """

    node: Floats
    weight: Floats

    def of(self, curve: Floats) -> Floats:
        """A curve at the nodes, shape (..., n_node), as the test shows it, (..., n_strain)."""
        windows = np.lib.stride_tricks.sliding_window_view(curve, self.weight.shape[1], axis=-1)
        return np.asarray(np.einsum("...bm,bm->...b", windows[..., ::NODES_A_BIN, :], self.weight))


@dataclass(frozen=True)
@read_only_arrays
class MeasuredCurve:
    """Tension of a test on one axis of strain, cycle by cycle and over the cycles.

    NaN stands where a branch was not visited.  The *judged* curve is the midline of the two
    branches, or the ascending branch of a test that has no other.

    Parameters
    ----------
    strain : ndarray, shape (n_strain,)
        Bin centres, equally spaced, of the whole relaxed length. [1]
    tension : ndarray, shape (n_cycle, 2, n_strain)
        Of each cycle, ascending before descending, at the bin centre. [N]
    count : ndarray of int, shape (n_cycle, 2, n_strain)
        Samples in the bin. [1]
    cycle_number : ndarray of int, shape (n_cycle,)
        First cycle of each row; a row is one cycle unless ``cycles_pooled`` is above 1.
    branch_tension, branch_standard_uncertainty : ndarray, shape (2, n_strain)
        Mean over the cycles after break-in, and its standard uncertainty, type A alone. [N]
    midline_tension, midline_standard_uncertainty : ndarray, shape (n_strain,)
        Half way between the branches, and its standard uncertainty, type A alone. [N]
    scatter_contribution : ndarray, shape (n_component, n_strain)
        What the type A standard uncertainty of the judged curve has in common over strain, as
        signed contributions: cycles lie high or low as a whole. [N]
    component : tuple of Component, length n_component
        Errors that all cycles share.
    contribution : ndarray, shape (n_component, 3, n_strain)
        Of each, to both branches and the midline, one standard uncertainty, signed; zero where
        there is no curve. [N]
    strain_error : ndarray, shape (n_component, n_strain)
        What the strain of the judged curve is read wrong by in it: the part of the contribution
        that moves the curve along its axis. [1]
    loading : {"static", "dynamic"}
        How it was pulled.
    reading : Reading
        How the judged curve was read from the samples.
    end_strain, end_tension, end_standard_uncertainty : float
        Where the judged curve ends beyond its last bin centre: mean of the samples between, and
        its type A; NaN where there are none. [1], [N], [N]
    cycles_pooled : int
        Consecutive cycles in a row of ``tension``.
    notes : tuple of str
        What a reader has to know.
    """

    strain: Floats
    tension: Floats
    count: Integers
    cycle_number: Integers
    branch_tension: Floats
    branch_standard_uncertainty: Floats
    midline_tension: Floats
    midline_standard_uncertainty: Floats
    scatter_contribution: Floats
    component: tuple[Component, ...]
    contribution: Floats
    strain_error: Floats
    loading: Loading
    reading: Reading
    end_strain: float = float("nan")
    end_tension: float = float("nan")
    end_standard_uncertainty: float = float("nan")
    cycles_pooled: int = 1
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Check shapes once and make the arrays read-only."""
        n_strain, n_cycle = self.strain.size, self.cycle_number.size
        shapes = {
            "tension": (n_cycle, 2, n_strain),
            "count": (n_cycle, 2, n_strain),
            "branch_tension": (2, n_strain),
            "branch_standard_uncertainty": (2, n_strain),
            "midline_tension": (n_strain,),
            "midline_standard_uncertainty": (n_strain,),
            "scatter_contribution": (self.scatter_contribution.shape[0], n_strain),
            "contribution": (len(self.component), len(CURVES), n_strain),
            "strain_error": (len(self.component), n_strain),
        }
        require_shapes(self, shapes, of="measured curve")

    @property
    def judged(self) -> CurveName:
        """The curve that the prediction is judged by."""
        return "midline" if np.isfinite(self.midline_tension).any() else "ascending"

    def tension_of(self, curve: CurveName) -> Floats:
        """Mean over the cycles, shape (n_strain,). [N]."""
        if curve == "midline":
            return self.midline_tension
        return np.asarray(self.branch_tension[BRANCHES.index(curve)])

    def standard_uncertainty_of(self, curve: CurveName) -> Floats:
        """Of that mean, type A alone, shape (n_strain,). [N]."""
        if curve == "midline":
            return self.midline_standard_uncertainty
        return np.asarray(self.branch_standard_uncertainty[BRANCHES.index(curve)])

    def contribution_of(self, curve: CurveName) -> Floats:
        """Of the shared errors to that mean, signed, shape (n_component, n_strain). [N]."""
        return np.asarray(self.contribution[:, CURVES.index(curve)])

    def curves(self) -> tuple[CurveName, ...]:
        """Curves that were measured anywhere."""
        return tuple(name for name in CURVES if np.isfinite(self.tension_of(name)).any())

    def independent_uncertainty(self) -> Floats:
        """Type A of the judged curve that no two strains share, shape (n_strain,). [N]."""
        whole = self.standard_uncertainty_of(self.judged) ** 2
        common = np.sum(self.scatter_contribution**2, axis=0)
        return np.asarray(np.sqrt(np.maximum(whole - common, 0.0)))

"""What is wrong alike with every sample of a test, along its branches.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of
   uncertainty in measurement," F.1.2.3 (correlation by common influence quantities).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from reduction.checks import as_spread
from reduction.record import Floats, read_only_arrays, require_shapes
from reduction.uncertainty.product import Component

_AT_AN_END = 5  # points whose straight line goes on beyond an end


class CurveErrors(NamedTuple):
    """What shared errors do to points of two branches, shape (n_component, 2, n_strain).

    ``tension`` at the strain of the point [N], ``strain`` at its tension [1].
    """

    tension: Floats
    strain: Floats


@dataclass(frozen=True)
@read_only_arrays
class SharedErrors:
    """Errors that all samples of a test share, each one standard uncertainty above zero.

    An error of tension is known by the tension at which it is, one of strain by the strain:
    either can be read between and just beyond the points.

    Parameters
    ----------
    component : tuple of Component, length n_component
        Each once.
    strain : ndarray, shape (n_point,)
        Rising. [1]
    tension : ndarray, shape (2, n_point)
        Of both branches at these strains, NaN where not known. [N]
    tension_error : ndarray, shape (n_component, 2, n_point)
        Logged less true at one strain; NaN where not known. A branch of which nothing is known
        has the errors of the other. [N]
    strain_error : ndarray, shape (n_component, 2, n_point)
        Logged less true at one tension; likewise. [1]
    """

    component: tuple[Component, ...]
    strain: Floats
    tension: Floats
    tension_error: Floats
    strain_error: Floats

    def __post_init__(self) -> None:
        """Check shapes and make the arrays read-only."""
        n_point = self.strain.size
        rows = (len(self.component), 2, n_point)
        shapes = {"tension": (2, n_point), "tension_error": rows, "strain_error": rows}
        require_shapes(self, shapes, of="shared errors")

    def at(self, strain: Floats, tension: Floats) -> CurveErrors:
        """Errors at points of both branches, strain (n_strain,) and tension (2, n_strain)."""
        found = np.zeros((2, len(self.component), 2, strain.size))
        for branch in range(2):
            for row in range(len(self.component)):
                of_tension = self._known(self.tension, self.tension_error[row], branch)
                found[0, row, branch] = read_along(tension[branch], *of_tension)
                axis = np.broadcast_to(self.strain, (2, self.strain.size))
                of_strain = self._known(axis, self.strain_error[row], branch)
                found[1, row, branch] = read_along(strain, *of_strain)
        return CurveErrors(*found)

    @staticmethod
    def _known(at: Floats, error: Floats, branch: int) -> tuple[Floats, Floats]:
        """Points of a branch in rising order; of the other one where it has none."""
        for own in (branch, 1 - branch):
            there = np.isfinite(at[own]) & np.isfinite(error[own])
            if there.any():
                order = np.argsort(at[own][there], kind="stable")
                return at[own][there][order], error[own][there][order]
        return np.zeros(1), np.zeros(1)


def constant_errors(
    *,
    tension_offset: float = 0.0,
    strain_offset: float = 0.0,
    tension_gain: float = 0.0,
    strain_gain: float = 0.0,
    of: str = "",
) -> SharedErrors:
    """Zero and scale of the load and of the strain as shared errors.

    Parameters
    ----------
    tension_offset, strain_offset : float
        Standard uncertainties of the zero. [N], [1]
    tension_gain, strain_gain : float
        Of the scale, relative; a strain gain is that of the relaxed length too. [1]
    of : str
        Whose they are.

    Returns
    -------
    errors : SharedErrors
        Those that are not zero.

    Raises
    ------
    SettingsError
        If one is negative or unknown.

    Notes
    -----
    Each is one error ([1]_).

    Examples
    --------
    >>> cell = constant_errors(tension_offset=10.0, tension_gain=0.01)
    >>> print(cell.at(np.array([0.5]), np.array([[2000.0], [1900.0]])).tension[:, :, 0].round(6))
    [[10. 10.]
     [20. 19.]]
    """
    knots = np.array([0.0, 1.0])
    stated = {
        "tension_offset": (tension_offset, np.ones(2), np.zeros(2)),
        "tension_gain": (tension_gain, knots, np.zeros(2)),
        "strain_offset": (strain_offset, np.zeros(2), np.ones(2)),
        "strain_gain": (strain_gain, np.zeros(2), knots),
    }
    kept = {name: row for name, row in stated.items() if as_spread(name, row[0]) > 0}
    errors = np.array([(size * load, size * place) for size, load, place in kept.values()])
    rows = np.broadcast_to(
        errors.reshape(-1, 2, 1, 2).transpose(1, 0, 2, 3), (2, len(kept), 2, 2)
    )  # fmt: skip
    return SharedErrors(
        tuple(Component(name, of) for name in kept),
        strain=knots,
        tension=np.stack([knots, knots]),
        tension_error=rows[0].copy(),
        strain_error=rows[1].copy(),
    )


def error_words(component: Component) -> str:
    """What an error is called in a note.

    Parameters
    ----------
    component : Component
        One error.

    Returns
    -------
    words : str
        Its source, and whose it is where that is said.

    Raises
    ------
    Nothing
        Any error has a source.

    Examples
    --------
    >>> print(error_words(Component("tension_gain", "load cell A")))
    tension_gain of load cell A
    """
    number = f" {component.number + 1}" if component.number else ""
    whose = f" of {component.of}" if component.of else ""
    return f"{component.source}{number}{whose}"


def read_along(at: Floats, known: Floats, values: Floats) -> Floats:
    """Values between known points on straight lines, and beyond them on the line of the last five.

    Parameters
    ----------
    at : ndarray, shape (n,)
        Where; NaN gives NaN. [any]
    known : ndarray, shape (n_known,)
        Not falling. [as at]
    values : ndarray, shape (n_known,)
        There. [any]

    Returns
    -------
    found : ndarray, shape (n,)
        [as values]

    Raises
    ------
    ValueError
        If the known points do not pair up.

    Examples
    --------
    >>> print(read_along(np.array([-1.0, 0.5, 4.0]), np.array([0.0, 1.0, 2.0]),
    ...     np.array([1.0, 2.0, 3.0])).round(9))
    [0.  1.5 5. ]
    """
    found = np.interp(at, known, values)
    for outside, end in ((at < known[0], slice(None, _AT_AN_END)),
                         (at > known[-1], slice(-_AT_AN_END, None))):  # fmt: skip
        x, y = known[end], values[end]
        away = x - x.mean()
        if outside.any() and away.any():
            slope = float(away @ y / (away @ away))
            found[outside] = y.mean() + slope * (at[outside] - x.mean())
    return np.asarray(np.where(np.isfinite(at), found, np.nan))

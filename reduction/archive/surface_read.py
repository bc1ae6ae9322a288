"""Response surfaces out of their archive, as they went in: to evaluate, to draw, to compare."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.stored import stored
from reduction.archive.surface_schema import SURFACE_SCHEMA
from reduction.errors import ArchiveError
from reduction.record import Floats, Integers
from reduction.surface.blocks import block_columns
from reduction.surface.coding import engineering_matrix
from reduction.surface.leastsquares import FIT_REASONS
from reduction.surface.parts import Anova, BlockEffects, Canonical, Diagnostics, LackOfFit
from reduction.surface.product import LACK_OF_FIT_REASONS, STATIONARY_REASONS, ResponseSurfaces
from reduction.vocabulary import RESPONSES, SURFACE_NAMES

_SPREAD = "_standard_uncertainty"
_LABEL_OF_DIM = {
    "factor": "factor_name",
    "term": "term_name",
    "run": "run_name",
    "anova_row": "anova_source",
    "block": "block_name",
}
"""Text that says how far an experiment fills a dimension."""


def surface_names(dataset: xr.Dataset, experiment: str) -> tuple[str, ...]:
    """Return the responses of an experiment that have a surface, transformed ones last.

    Parameters
    ----------
    dataset : xarray.Dataset
        An archive of experiments.
    experiment : str
        Name of one.

    Returns
    -------
    names : tuple of str
        Of `reduction.vocabulary.SURFACE_NAMES`; empty for a screening.

    Raises
    ------
    ArchiveError
        If the archive has no such experiment.
    """
    row = _row_of(dataset, experiment)
    return tuple(
        name
        for name in SURFACE_NAMES
        if f"{name}_transform" in dataset
        and str(dataset.variables[f"{name}_transform"].values[row])
    )


def surfaces_of(
    dataset: xr.Dataset, experiment: str, responses: Sequence[str] | None = None
) -> ResponseSurfaces:
    """Return surfaces as they were fitted; `reduction.surface` works on them as before.

    Parameters
    ----------
    dataset : xarray.Dataset
        An archive of experiments.
    experiment : str
        Name of one.
    responses : sequence of str, optional
        Of `surface_names`; all of them where not given.

    Returns
    -------
    surfaces : ResponseSurfaces
        In the order asked for, each with a pattern of its own.

    Raises
    ------
    ArchiveError
        If the archive has no such experiment, or the experiment no such surface.
    """
    known = surface_names(dataset, experiment)
    names = known if responses is None else tuple(responses)
    missing = [name for name in names if name not in known]
    if missing or not names:
        raise ArchiveError(
            f"experiment '{experiment}' has no such surface",
            found=", ".join(missing) or "no surface",
            needed=", ".join(known) or "an experiment with surfaces",
        )
    return _Reader(dataset, _row_of(dataset, experiment), names).surfaces()


def _row_of(dataset: xr.Dataset, experiment: str) -> int:
    known = (
        []
        if "experiment" not in dataset
        else dataset.variables["experiment"].values.astype(str).tolist()
    )
    if experiment not in known:
        raise ArchiveError(
            "the archive has no such experiment",
            found=experiment,
            needed=", ".join(known) or "an archive of experiments",
        )
    return known.index(experiment)


class _Reader:
    """One experiment of an archive, cut to its own length."""

    def __init__(self, dataset: xr.Dataset, row: int, names: tuple[str, ...]) -> None:
        self.dataset, self.row, self.names = dataset, row, names
        self.sizes: dict[str, int] = {}
        for dim, label in _LABEL_OF_DIM.items():
            if label in dataset:
                self.sizes[dim] = int(np.count_nonzero(dataset[label].values[row].astype(str)))
        self.sizes["term_other"] = self.sizes["term"]
        self.sizes["direction"] = self.sizes["factor"]

    def own(self, name: str) -> NDArray[Any]:
        """Give a variable of this experiment."""
        variable = self.dataset[name]
        cut = tuple(slice(self.sizes[str(dim)]) for dim in variable.dims[1:])
        values: NDArray[Any] = np.asarray(variable.values[self.row])[cut]
        return values

    def labels(self, name: str) -> tuple[str, ...]:
        """Give a text of this experiment, empty where the file has none."""
        dim = str(SURFACE_SCHEMA[name].dims[1])
        if name not in self.dataset:
            return ("",) * self.sizes[dim]
        return tuple(str(text) for text in self.own(name))

    def stack(self, what: str) -> NDArray[Any]:
        """Give what is said of each response, the responses first."""
        return np.stack([self.own(f"{name}_{what}") for name in self.names])

    def random(self, what: str) -> Floats:
        """Give the uncertainty of each response from the scatter of its runs alone."""
        kind = "_random" if f"{self.names[0]}_{what}_random{_SPREAD}" in self.dataset else ""
        return self.stack(f"{what}{kind}{_SPREAD}")

    def codes(self, what: str, reasons: dict[int, str]) -> NDArray[np.int8]:
        """Give the code of each reason; an archive without the text has none to give."""
        code = {text: number for number, text in reasons.items()}
        texts = [stored(self.dataset, f"{name}_{what}") for name in self.names]
        found = [0 if text is None else code[str(text.values[self.row])] for text in texts]
        return np.array(found, dtype=np.int8)

    def surfaces(self) -> ResponseSurfaces:
        """Put the surfaces together again."""
        exponents = self.own("term_exponent").astype(np.int64)
        low, high = self.own("factor_low"), self.own("factor_high")
        return ResponseSurfaces(
            response_names=self.names,
            factor_names=self.labels("factor_name"),
            run_names=self.run_names(),
            low=low,
            high=high,
            coded=self.own("run_coded_level"),
            exponents=exponents,
            term_names=self.labels("term_name"),
            transform=tuple(str(text) for text in self.stack("transform")),
            transform_exponent=self.stack("transform_exponent"),
            transform_exponent_interval=np.stack(
                [self.stack("transform_exponent_low"), self.stack("transform_exponent_high")],
                axis=-1,
            ),
            coefficient=self.stack("coefficient"),
            coefficient_standard_uncertainty=self.random("coefficient"),
            t=self.stack("t"),
            p_value=self.stack("p_value"),
            term_degrees_of_freedom=self.stack("term_degrees_of_freedom"),
            error_term=self.labels("term_error"),
            coefficient_engineering=self.stack("coefficient_engineering"),
            coefficient_engineering_standard_uncertainty=self.random("coefficient_engineering"),
            covariance_factor=self.stack("covariance_factor"),
            engineering_matrix=engineering_matrix(exponents, low=low, high=high),
            pattern=np.arange(len(self.names)),
            is_used=np.isfinite(self.measured()),
            sigma=self.stack("sigma"),
            degrees_of_freedom=self.counts("degrees_of_freedom"),
            r2=self.stack("r2"),
            adjusted_r2=self.stack("adjusted_r2"),
            predicted_r2=self.stack("predicted_r2"),
            overall_f=self.stack("overall_f"),
            overall_p_value=self.stack("overall_p_value"),
            printed_f=self.stack("printed_f"),
            fitted=self.stack("fitted"),
            residual=self.stack("residual"),
            anova=self.anova(),
            lack_of_fit=self.lack_of_fit(),
            canonical=self.canonical(),
            diagnostics=Diagnostics(
                leverage=self.stack("leverage"),
                cooks_distance=self.stack("cooks_distance"),
                studentized_residual=self.stack("studentized_residual"),
                deleted_residual=self.stack("deleted_residual"),
                probability_plot_correlation=self.stack("probability_plot_correlation"),
            ),
            blocks=self.blocks(),
            condition_number=float(self.own("condition_number")),
            reason=self.codes("refusal", FIT_REASONS),
            notes=self.notes(),
        )

    def run_names(self) -> tuple[str, ...]:
        """Give the runs, with the specimen where there are several, as `RunTable.names`."""
        runs, specimens = self.labels("run_name"), self.labels("run_specimen")
        many = len(set(specimens)) > 1
        pairs = zip(runs, specimens, strict=True)
        return tuple(f"{run} {specimen}" if many else run for run, specimen in pairs)

    def measured(self) -> Floats:
        """Give the response that each surface is of, before any transform."""
        of = [next(base for base in RESPONSES if name.endswith(base)) for name in self.names]
        return np.stack([self.own(f"{base}_measured") for base in of])

    def counts(self, what: str) -> Integers:
        """Give numbers that are counted; those of a surface that is not there are 0."""
        counted: Integers = np.nan_to_num(self.stack(what)).astype(np.int64)
        return counted

    def anova(self) -> Anova:
        """Give the analysis of variance."""
        return Anova(
            source=self.labels("anova_source"),
            degrees_of_freedom=self.stack("anova_degrees_of_freedom"),
            sum_of_squares=self.stack("anova_sum_of_squares"),
            mean_square=self.stack("anova_mean_square"),
            f=self.stack("anova_f"),
            p_value=self.stack("anova_p_value"),
            error_term=self.labels("anova_error_term"),
        )

    def lack_of_fit(self) -> LackOfFit:
        """Give what the analysis of variance says of lack of fit, and the repeats."""
        source = self.labels("anova_source")
        lack, pure = source.index("lack of fit"), source.index("pure error")
        squares = self.stack("anova_sum_of_squares")
        freedom = self.counts("anova_degrees_of_freedom")
        return LackOfFit(
            degrees_of_freedom=freedom[:, lack],
            pure_error_degrees_of_freedom=freedom[:, pure],
            sum_of_squares=squares[:, lack],
            pure_error_sum_of_squares=squares[:, pure],
            f=self.stack("lack_of_fit_f"),
            p_value=self.stack("lack_of_fit_p_value"),
            reason=self.codes("lack_of_fit_refusal", LACK_OF_FIT_REASONS),
            cell=self.own("run_cell").astype(np.int64) - 1,
            tolerance=float(self.own("replicate_tolerance")),
        )

    def canonical(self) -> Canonical:
        """Give stationary points and principal directions."""
        return Canonical(
            stationary_point=self.stack("stationary_point"),
            stationary_point_engineering=self.stack("stationary_point_engineering"),
            stationary_point_standard_uncertainty=self.random("stationary_point"),
            stationary_value=self.stack("stationary_value"),
            eigenvalue=self.stack("eigenvalue"),
            eigenvalue_standard_uncertainty=self.random("eigenvalue"),
            eigenvector=self.stack("eigenvector").transpose(0, 2, 1),
            kind=self.stack("stationary_kind").astype(np.int8),
            is_inside=self.stack("stationary_point_is_inside").astype(bool),
            reason=self.codes("stationary_refusal", STATIONARY_REASONS),
        )

    def blocks(self) -> BlockEffects | None:
        """Give the blocks; None where there is one."""
        treatment = str(self.own("block_treatment")) if "block_treatment" in self.dataset else ""
        if not treatment:
            return None
        names, index, _ = block_columns(self.labels("run_block"))
        return BlockEffects(
            names=names,
            index=index,
            treatment=treatment,
            effect=self.stack("block_effect"),
            standard_deviation=self.stack("block_standard_deviation"),
            at_boundary=self.stack("block_at_boundary").astype(bool),
        )

    def notes(self) -> tuple[str, ...]:
        """Give the notes of the surfaces."""
        if "note" not in self.dataset:
            return ()
        columns = [
            self.dataset.variables[f"note{part}"].values for part in ("_experiment", "_stage", "")
        ]
        name = str(self.dataset.variables["experiment"].values[self.row])
        return tuple(
            str(text)
            for experiment, stage, text in zip(*columns, strict=True)
            if (str(experiment), str(stage)) == (name, "surfaces")
        )

"""An experiment: runs as they were done, and the surfaces or effects over them.

`reduction.experiments.experiment_fit` makes it from the runs' products and `reduction.archive`
stores it; neither knows the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from reduction.experiments.fit_results import ResponseSurfaces
from reduction.experiments.run_sheet import Caution
from reduction.experiments.screening import ScreeningEffects
from reduction.experiments.stiffness_forms import FormQuality, StiffnessForm
from reduction.record.contributions import Component, Contributions
from reduction.record.errors import DataError
from reduction.record.measurement import Floats, read_only_arrays
from reduction.record.notes import Note
from reduction.stages.three_parameter_line.line_model import SingleTimeCheck


@dataclass(frozen=True)
@read_only_arrays
class RunTable:
    """One row per run and specimen, as measured.

    Parameters
    ----------
    run : tuple of str, length n_runs
        Test or step.
    specimen : tuple of str, length n_runs
        Which specimen was run.
    coded_plan : ndarray, shape (n_runs, n_columns)
        As planned: the factors, then dummy columns. [1]
    level : ndarray, shape (n_runs, n_factors)
        As reached; NaN where a run was not done. [SI unit of each factor]
    response : ndarray, shape (n_responses, n_runs)
        Mean over the cycles; NaN where refused. [SI unit of each response]
    response_standard_uncertainty : ndarray, shape (n_responses, n_runs)
        Type A, within the run. [SI unit of each response]
    frequency : ndarray, shape (n_runs,)
        Of the cycles. [Hz]
    mean_tension, tension_amplitude, peak_tension, minimum_tension : ndarray, shape (n_runs,)
        Means over the cycles; the last two of the greatest and the least of them. [N]
    rated_break_strength : ndarray, shape (n_runs,)
        Of the specimen; NaN where not stated. [N]
    remark : tuple of str, length n_runs
        Why a run has no number, and how its cycles affect the model; semicolons between several.
    shared : Contributions or None
        Contributions of errors that runs share to responses and levels, by name, shape
        (n_components, n_runs); None where none is known.
    response_whole_uncertainty : ndarray or None, shape (n_responses, n_runs)
        Standard uncertainty from all errors as each run states it: for K_1 and tau by Monte Carlo
        where they are not linear in their errors. None or NaN where it is the root of the sum of
        squares of both parts. [SI unit of each response]
    """

    run: tuple[str, ...]
    specimen: tuple[str, ...]
    coded_plan: Floats
    level: Floats
    response: Floats
    response_standard_uncertainty: Floats
    frequency: Floats
    mean_tension: Floats
    tension_amplitude: Floats
    peak_tension: Floats
    minimum_tension: Floats
    rated_break_strength: Floats
    remarks: tuple[tuple[Note, ...], ...]
    shared: Contributions | None = None
    response_whole_uncertainty: Floats | None = None

    def __post_init__(self) -> None:
        """Check that every column has one entry per run, and make the arrays read-only."""
        n_runs = len(self.run)
        columns = {
            "specimen": len(self.specimen),
            "coded_plan": self.coded_plan.shape[0],
            "level": self.level.shape[0],
            "response": self.response.shape[1],
            "frequency": self.frequency.size,
            "remarks": len(self.remarks),
        }
        for name, found in columns.items():
            if found != n_runs:
                raise DataError(
                    f"{name} does not fit the runs", found=str(found), needed=str(n_runs)
                )

    @property
    def names(self) -> tuple[str, ...]:
        """Run names, with the specimen where a run has several."""
        many = len(set(self.specimen)) > 1
        pairs = zip(self.run, self.specimen, strict=True)
        return tuple(f"{run} {specimen}" if many else run for run, specimen in pairs)


@dataclass(frozen=True)
@read_only_arrays
class SharedSurfaces:
    """What errors that runs share add to the coefficients of surfaces.

    Parameters
    ----------
    component : tuple of Component, length n_components
        Each error.
    coefficient, coefficient_engineering : ndarray, shape (n_components, n_responses, n_terms)
        Signed, for one standard uncertainty of the error. [as the coefficients of the surfaces]
    """

    component: tuple[Component, ...]
    coefficient: Floats
    coefficient_engineering: Floats


@dataclass(frozen=True)
@read_only_arrays
class ExperimentResult:
    """What the runs of one experiment show together.

    Parameters
    ----------
    name, kind : str
        As in the campaign; ``box-behnken`` or ``plackett-burman``.
    factor_names, factor_units : tuple of str, length n_factors
        Names, and SI units of the levels.
    low, high : ndarray, shape (n_factors,)
        Levels that are -1 and +1. [SI unit of each factor]
    response_names : tuple of str, length n_responses
        Names of the rows of ``runs.response``.
    runs : RunTable
        In the order of the campaign.
    surfaces : ResponseSurfaces or None
        Of every response as measured, followed by each transformed one, which is named
        ``log_`` or ``box_cox_`` and the response; None where none could be fitted.
    screening : ScreeningEffects or None
        Effects of a Plackett-Burman design on every response.
    stiffness_forms : tuple of StiffnessForm
        Forms of mooring codes, fitted to the apparent spring constant of the same runs.
    form_quality : FormQuality or None
        Quality of those forms compared with the quadratic surface.
    single_time : SingleTimeCheck or None
        Whether one relaxation time holds across frequency.
    derived_dissipation_spring_constant, derived_relaxation_time : ndarray, shape (n_runs,)
        K_1 and tau from surfaces of E' and E'' at the levels of each run, for comparison with
        those of its own loops; NaN where refused. [N], [s]
    cautions : tuple of Caution
        Of the runs as reached.
    notes : tuple of Note
        What a reader of the numbers needs to know.
    refusal_status : int
        Exit status of the error that left neither surfaces nor effects; 0 where
        there are any.
    shared : SharedSurfaces or None
        Of ``surfaces``; None where no shared error is known.
    """

    name: str
    kind: Literal["box-behnken", "plackett-burman"]
    factor_names: tuple[str, ...]
    factor_units: tuple[str, ...]
    low: Floats
    high: Floats
    response_names: tuple[str, ...]
    runs: RunTable
    surfaces: ResponseSurfaces | None
    screening: ScreeningEffects | None
    stiffness_forms: tuple[StiffnessForm, ...]
    form_quality: FormQuality | None
    single_time: SingleTimeCheck | None
    derived_dissipation_spring_constant: Floats
    derived_relaxation_time: Floats
    cautions: tuple[Caution, ...] = ()
    notes: tuple[Note, ...] = ()
    refusal_status: int = 0
    shared: SharedSurfaces | None = None

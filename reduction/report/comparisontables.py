"""Tables of comparisons: verdicts, curves, events, energies, fitted numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.report.comparisonview import ComparisonView, FittedNumber
from reduction.report.htmltable import (
    NOT_GIVEN,
    Cell,
    Table,
    factors_of,
    make_table,
    measured,
    number,
    number_text,
    span,
    words,
)
from reduction.report.style import Shown, shown
from reduction.report.uncertainty import NORMAL, factor_words, plus_minus

__all__ = [
    "calibration_table", "correlation_table", "curve_table", "energy_table", "event_table",
    "verdict_table",
]  # fmt: skip

_SIGN = "Differences are predicted less measured: below zero the hose is stiffer than predicted."
_PLUS_MINUS = (
    f"±: expanded uncertainty, 95 % ({factor_words([NORMAL])}) of the difference, of test and of"
    " prediction together, as stated for both."
)


def verdict_table(views: Sequence[ComparisonView]) -> Table | None:
    """Return what each comparison says: a line a comparison."""
    if not views:
        return None
    strain, force = shown("strain", views[0].units), shown("tension", views[0].units)
    rows = []
    for view in views:
        worst, at = (
            view.judged_scalar(name) for name in ("worst_tension_difference", "worst_strain")
        )
        rows.append(
            [
                words(view.name), words(view.test), words(view.hose), words(view.loading),
                words(view.short_verdict),
                number(view.judged_scalar("tension_bias"), force, digits=3),
                number(view.judged_scalar("tension_rms"), force, digits=3),
                number(view.judged_scalar("tension_relative_rms"), strain, digits=3),
                number(worst, force, digits=3),
                number(at, strain, digits=3),
                number(view.scalar("largest_ratio"), digits=3),
                number(view.scalar("coverage_factor"), digits=3),
            ]
        )  # fmt: skip
    return make_table(
        "Tests against their predicted hoses, at the judged curve of each.",
        (
            "comparison", "test", "hose", "pulled", "verdict", force.label("bias"),
            force.label("RMS"), strain.label("relative RMS"), force.label("worst"),
            strain.label("at strain"), "largest ratio [1]", "at most [1]",
        ),
        rows, synthetic=any(view.is_synthetic for view in views), is_compact=True,
        remarks=[
            f"{_SIGN} Relative RMS: over the RMS of the measured tension.",
            "Largest ratio: difference over its standard uncertainty, at its largest; \"differs\""
            " where it is more than a right prediction shows in 95 % of all cases (at most)."
            " \"Agrees\" says that an error of the model cannot be seen, not that there is none;"
            " \"says little\" is agreement within a band so wide that it could hardly differ."
            " Bias, RMS and worst have no uncertainty of their own: the ratio has.",
        ],
    )  # fmt: skip


def curve_table(view: ComparisonView) -> Table:
    """Return the differences of each measured curve, and what the calibration leaves."""
    strain, force = shown("strain", view.units), shown("tension", view.units)
    columns = (
        ("tension_bias", force), ("tension_rms", force), ("tension_relative_rms", strain),
        ("worst_tension_difference", force), ("worst_strain", strain),
    )  # fmt: skip
    rows = [
        [
            words(f"{curve}, judged" if curve == view.judged else curve),
            *(number(float(view.of_curve(name, curve)), unit) for name, unit in columns),
        ]
        for curve in view.curves
    ]
    if view.fitted:
        left = [
            number(view.scalar(name), unit)
            for name, unit in (
                ("calibrated_bias", force), ("calibrated_rms", force),
                ("calibrated_relative_rms", strain),
            )
        ]  # fmt: skip
        rows.append([words(f"{view.judged}, calibrated"), *left, words(""), words("")])
    return make_table(
        f"Predicted less measured tension of each curve, {view.name}.",
        (
            "curve", force.label("bias"), force.label("RMS"), strain.label("relative RMS"),
            force.label("greatest difference"), strain.label("at strain"),
        ),
        rows, synthetic=view.is_synthetic,
        remarks=[
            "The prediction is elastic and has no loop: either branch is off by half of it, so the"
            f" {view.judged} is judged."
        ]
        if view.judged == "midline"
        else [f"The test has no other curve than its {view.judged} branch, which is judged."],
    )  # fmt: skip


def event_table(view: ComparisonView) -> Table:
    """Return what happens to the cords, predicted and measured, in tension and in strain."""
    strain, force = shown("strain", view.units), shown("tension", view.units)
    rows = [
        [
            words(event.words),
            number(event.strain, strain),
            number(event.tension, force),
            number(event.measured_tension, force),
            measured(
                event.tension_difference,
                NORMAL * event.tension_difference_standard_uncertainty,
                force,
            ),
            number(event.measured_strain, strain),
            measured(
                event.strain_difference,
                NORMAL * event.strain_difference_standard_uncertainty,
                strain,
            ),
        ]
        for event in view.events
    ]
    missing = any(not np.isfinite(event.measured_tension) for event in view.events)
    return make_table(
        f"What happens to the cords, {view.name}: at the predicted strain the tension, and at the"
        " predicted tension the strain.",
        (
            "event", strain.label("predicted strain"), force.label("predicted tension"),
            force.label("measured there"), force.label("difference of tension"),
            strain.label("strain of that tension"), strain.label("difference of strain"),
        ),
        rows, synthetic=view.is_synthetic,
        remarks=[
            f"{_SIGN} {_PLUS_MINUS}",
            *([f"{NOT_GIVEN}: the test did not go there."] if missing else []),
        ],
    )  # fmt: skip


def energy_table(view: ComparisonView) -> Table | None:
    """Return energies between the same two strains; None where nothing could be integrated."""
    if not np.isfinite(view.scalar("measured_energy")):
        return None
    strain, energy = shown("strain", view.units), shown("energy", view.units)
    return make_table(
        f"Energy taken up by a length of hose at rest, {view.name}.",
        (
            strain.label("between strains"), energy.label("measured, ascending"),
            energy.label("predicted"), energy.label("difference"), energy.label("loop"),
            strain.label("loop over measured"),
        ),
        [
            [
                span(
                    view.scalar("energy_strain_low"), view.scalar("energy_strain_high"), strain,
                    places=1,
                ),
                *(
                    number(view.scalar(name), energy)
                    for name in (
                        "measured_energy", "predicted_energy", "energy_difference", "loop_energy"
                    )
                ),
                number(view.scalar("loop_energy_share"), strain, digits=3),
            ]
        ],
        synthetic=view.is_synthetic,
        remarks=["The prediction has no loop, and lies below the ascending branch by about half of"
                 " it even where the midline agrees. No uncertainty is carried to an energy."],
    )  # fmt: skip


def calibration_table(view: ComparisonView) -> Table | None:
    """Return the fitted numbers with intervals and bounds; None where none was fitted."""
    if not view.fitted:
        return None
    rows = []
    for one in view.fitted:
        unit = one.shown(view.units)
        rows.append(
            [
                words(unit.label(one.words)),
                number(one.start, unit),
                measured(one.value, (one.high - one.low) / 2, unit, factor=_factor(one)),
                _interval(one, unit),
                _range(one.lower_bound, one.upper_bound, unit),
                words("yes" if one.is_at_bound else "no"),
            ]
        )
    return make_table(
        f"Numbers of hose {view.hose} fitted to test {view.test}, {view.name}.",
        ("number", "start", "fitted", "95 % interval", "kept between", "at a bound"),
        rows, synthetic=view.is_synthetic,
        remarks=[
            plus_minus(
                factors_of(rows),
                "scatter of the test, what its stated errors may imitate, and neighbouring strains"
                " that err alike", left_out="an error of the model",
            )
            + " An interval is not cut at the bounds.",
            f"Residuals are worth {view.scalar('effective_points'):.0f} independent points; scatter"
            f" to be added for them to be explained: {_force_text(view, 'model_error')}.",
        ],
    )  # fmt: skip


def correlation_table(view: ComparisonView) -> Table | None:
    """Return how the fitted numbers go together; None of fewer than two."""
    if len(view.fitted) < 2:
        return None
    table = view.array("parameter_correlation")
    names = [one.words for one in view.fitted]
    return make_table(
        f"Correlation of the fitted numbers, {view.name}.",
        ("number", *names),
        [
            [words(name), *(_correlation(float(value)) for value in row)]
            for name, row in zip(names, table, strict=True)
        ],
        synthetic=view.is_synthetic,
        remarks=[_collinearity(view.scalar("collinearity"))],
    )  # fmt: skip


def _collinearity(index: float) -> str:
    if np.isinf(index):
        return "Collinearity index: none, since the curve does not answer to one of them at all."
    return f"Collinearity index: {number_text(index, 3)}; above 10 to 15 it is called poor."


def _factor(one: FittedNumber) -> float:
    """Coverage factor of the interval of a fitted number."""
    spread = one.value_standard_uncertainty
    return (one.high - one.low) / 2 / spread if spread > 0 else float("nan")


def _interval(one: FittedNumber, unit: Shown) -> Cell:
    """95 % interval to the digits of the uncertainty."""
    half = one.value_standard_uncertainty * unit.factor
    if not (np.isfinite(half) and half > 0):
        return _range(one.low, one.high, unit)
    places = int(np.clip(1 - np.floor(np.log10(half)), 0, 10))
    return span(one.low, one.high, unit, places=places)


def _range(low: float, high: float, unit: Shown) -> Cell:
    if not (np.isfinite(low) and np.isfinite(high)):
        return words("")
    ends = " to ".join(number_text(end * unit.factor, 3) for end in (low, high))
    return Cell(ends, f"{low!r} {high!r}", is_number=True)


def _correlation(value: float) -> Cell:
    return Cell(f"{value:+.3f}", repr(value), is_number=True) if np.isfinite(value) else words("")


def _force_text(view: ComparisonView, name: str) -> str:
    force = shown("tension", view.units)
    return f"{number_text(force.factor * view.scalar(name), 3)} {force.unit}"

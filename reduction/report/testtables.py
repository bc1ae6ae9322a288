"""Tables of what a cyclic test gave: segments, means, slips, checks, elastomer laws, flags."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from reduction.archive.freedom import cycles_averaged
from reduction.record import Floats
from reduction.report.htmltable import (
    Cell,
    Table,
    count,
    factors_of,
    make_table,
    measured,
    number,
    span,
    words,
)
from reduction.report.style import shown
from reduction.report.uncertainty import (
    NORMAL,
    expanded_of,
    plus_minus_of_tests,
    shared_sources,
)
from reduction.report.view import TestView, any_synthetic
from reduction.vocabulary import BRANCH_NAMES

__all__ = [
    "elastomer_table", "flag_table", "identity_table", "segment_table", "slip_table",
    "stress_table", "summary_table",
]  # fmt: skip


def segment_table(tests: Sequence[TestView]) -> Table | None:
    """Return the piecewise-linear moduli: the answer, in the form of Tables 5 and 6."""
    rows = [row for view in tests for row in _segments(view)]
    if not rows:
        return None
    units = tests[0].units
    of = " of the rubber" if any(view.is_rubber for view in tests) else ""
    columns = (
        "test", "specimen", "branch", "segment",
        shown("stress", units).label("segment modulus"),
        shown("strain", units).label("strain range"),
        shown("tension", units).label("tension range"), "cycles [1]", "strain method",
    )  # fmt: skip
    return make_table(
        f"Elastic modulus{of}, piecewise linear, from trimmed branches.", columns, rows,
        synthetic=any_synthetic(tests), is_tall=len(rows) > 16,
        remarks=[plus_minus_of_tests(factors_of(rows), tests, ["segment_modulus"])],
    )  # fmt: skip


def _segments(view: TestView) -> Iterator[list[Cell]]:
    modulus = view.array("segment_modulus")
    if modulus is None:
        return
    spread = expanded_of(view, "segment_modulus", modulus)
    ends = {
        name: view.array_like(f"segment_{name}", modulus)
        for name in ("strain_low", "strain_high", "tension_low", "tension_high")
    }
    methods = view.texts("strain_method") or ("",) * len(view.specimens)
    branches = view.texts("branch_name") or BRANCH_NAMES
    averaged = np.broadcast_to(
        cycles_averaged(view.data, "segment_modulus"), (len(view.specimens),)
    )
    for own in zip(*np.nonzero(np.isfinite(modulus)), strict=True):
        specimen, branch, segment = (int(place) for place in own)
        yield [
            words(view.id),
            words(view.specimens[specimen]),
            words(branches[branch]),
            count(float(segment + 1)),
            measured(
                modulus[own],
                spread.half[own],
                shown("stress", view.units),
                factor=spread.factor[own],
            ),
            span(
                ends["strain_low"][own],
                ends["strain_high"][own],
                shown("strain", view.units),
                places=1,
            ),
            span(
                ends["tension_low"][own],
                ends["tension_high"][own],
                shown("tension", view.units),
                places=0,
            ),
            count(float(averaged[specimen])),
            words(methods[specimen]),
        ]


def summary_table(view: TestView) -> Table | None:
    """Return the means over the cycles of a test, and what changed over them."""
    force, stress = shown("tension", view.units), shown("stress", view.units)
    percent, energy = shown("strain", view.units), shown("energy", view.units)
    hertz, plain = shown("frequency", view.units), None
    quantities = (
        ("test_mean_strain", percent, percent.label("mean strain")),
        ("test_strain_amplitude", percent, percent.label("strain amplitude")),
        ("test_mean_tension", force, force.label("mean tension")),
        ("test_tension_amplitude", force, force.label("tension amplitude")),
        ("test_frequency", hertz, hertz.label("frequency")),
        ("test_apparent_spring_constant", force, force.label("apparent spring constant")),
        ("test_storage_spring_constant", force, force.label("E', storage spring constant")),
        ("test_loss_spring_constant", force, force.label("E'', loss spring constant")),
        ("test_dynamic_modulus", stress, stress.label("dynamic modulus")),
        ("test_loss_factor", plain, "loss factor [1]"),
        ("test_hysteresis_energy", energy, energy.label("hysteresis energy")),
        ("peak_tension_per_decade", force, force.label("peak tension per decade of cycles")),
        ("dynamic_modulus_per_decade", stress, stress.label("dynamic modulus per decade")),
        (
            "peak_tension_change",
            percent,
            percent.label("change of peak tension, first to last cycle"),
        ),
        ("creep_per_cycle", force, force.label("drift of peak tension per cycle")),
        (
            "slack_strain_at_unloading",
            percent,
            percent.label("strain where it goes slack, unloading"),
        ),
    )
    given = [row for row in quantities if row[0] in view.data]
    if not given:
        return None
    rows = []
    is_known = False
    for name, unit, label in given:
        values = view.array_like(name, np.empty(len(view.specimens)))
        spread = expanded_of(view, name, values)
        cells = (
            measured(value, half, unit, factor=factor)
            for value, half, factor in zip(values, spread.half, spread.factor, strict=True)
        )
        rows.append([words(label), *cells])
        is_known |= bool(np.isfinite(values).any())
    if not is_known:
        return None
    return make_table(
        "Means over the cycles of the test, and what changed over them.",
        ("what, with its unit", *view.specimens), rows, synthetic=view.is_synthetic,
        remarks=_about_means(view, rows, [name for name, *_ in given]),
    )  # fmt: skip


def _about_means(view: TestView, rows: Sequence[Sequence[Cell]], names: Sequence[str]) -> list[str]:
    """Say what ± holds, and of which rows it is scatter alone."""
    said = plus_minus_of_tests(factors_of(rows), [view], names)
    if not shared_sources([view], names):
        return [said]
    own = [
        row[0].text.partition(" [")[0]
        for row, name in zip(rows, names, strict=True)
        if factors_of([row]) and not shared_sources([view], [name])
    ]
    return [said, *([f"Scatter alone: {'; '.join(own)}."] if own else [])]


def stress_table(view: TestView) -> Table | None:
    """Return stress at stated elongations; it is a stress and never called a modulus."""
    levels, stress = view.array("strain_level"), view.array("stress_at_strain")
    if levels is None or stress is None or not np.isfinite(stress).any():
        return None
    unit = shown("stress", view.units)
    rows = [
        [words(name), *(number(value, unit) for value in stress[place])]
        for place, name in enumerate(view.specimens)
    ]
    columns = ("specimen", *(unit.label(f"stress at {100 * level:g} %") for level in levels))
    return make_table(
        "Nominal stress at stated elongations of the first loading (the rubber trade calls it"
        " M100 and the like; it is no modulus).",
        columns, rows, synthetic=view.is_synthetic,
    )  # fmt: skip


def slip_table(view: TestView) -> Table | None:
    """Return the steps of the splices."""
    cycles = view.array("slip_cycle")
    if cycles is None:
        return None
    force, small = shown("tension", view.units), shown("small length", view.units)
    low, high = (
        view.array_like("slip_cycle_low", cycles),
        view.array_like("slip_cycle_high", cycles),
    )
    step, length = (view.array_like(f"slip_{name}", cycles) for name in ("tension_step", "length"))
    of_step, of_length = (
        expanded_of(view, f"slip_{name}", cycles) for name in ("tension_step", "length")
    )
    rows = [
        [
            words(specimen),
            count(cycles[place]),
            Cell(f"{low[place]:.0f} to {high[place]:.0f}", is_number=True),
            measured(step[place], of_step.half[place], force, factor=of_step.factor[place]),
            measured(length[place], of_length.half[place], small, factor=of_length.factor[place]),
        ]
        for place, specimen in enumerate(view.texts("slip_specimen"))
    ]
    columns = (
        "specimen", "first cycle after the step", "the step lies in cycles",
        force.label("step of peak tension"), small.label("splice let out"),
    )  # fmt: skip
    return make_table(
        "Steps of a splice, told apart from steady creep.", columns, rows,
        synthetic=view.is_synthetic, remarks=[
            plus_minus_of_tests(factors_of(rows), [view], ["slip_tension_step", "slip_length"])
        ],
    )  # fmt: skip


def identity_table(view: TestView) -> Table | None:
    """Return how well the closed-cycle identity holds, over the cycles of each specimen."""
    residual = view.array("identity_residual")
    if residual is None or not np.isfinite(residual).any():
        return None
    percent = shown("strain", view.units)
    rows = []
    for place, specimen in enumerate(view.specimens):
        own = np.abs(residual[place][np.isfinite(residual[place])])
        ends: Floats = own if own.size else np.array([np.nan])
        rows.append(
            [
                words(specimen),
                count(float(own.size)),
                number(float(np.median(ends)), percent, digits=2),
                number(float(np.max(ends)), percent, digits=2),
            ]
        )
    return make_table(
        "Check: stroke-mean modulus ascending minus descending equals the tension lost over area"
        " and strain stroke, on every cycle; residual over the stroke-mean modulus.",
        ("specimen", "cycles checked", "median residual [%]", "greatest residual [%]"), rows,
        synthetic=view.is_synthetic,
    )  # fmt: skip


def elastomer_table(view: TestView) -> Table | None:
    """Return the fitted laws with their parameters, range and stability."""
    laws = view.texts("elastomer_law")
    if not laws:
        return None
    stress, percent = shown("stress", view.units), shown("strain", view.units)
    like = np.empty(len(laws))
    column = {
        name: view.array_like(f"elastomer_{name}", like)
        for name in ("rms_stress", "strain_low", "strain_high", "is_stable", "aicc")
    }
    rows = [
        [
            words(view.texts("elastomer_specimen")[place]),
            words(law),
            words("; ".join(_parameters(view, place + 1))),
            span(column["strain_low"][place], column["strain_high"][place], percent, places=1),
            number(column["rms_stress"][place], stress, digits=3),
            number(column["aicc"][place]),
            words("yes" if column["is_stable"][place] == 1 else "no"),
        ]
        for place, law in enumerate(laws)
    ]
    columns = (
        "specimen", "law", "parameters", percent.label("fitted range"),
        stress.label("rms residual"), "corrected Akaike criterion [1]", "stable over the range",
    )  # fmt: skip
    return make_table(
        "Hyperelastic laws of the first loading; a law says nothing outside its fitted range.",
        columns, rows, synthetic=view.is_synthetic,
        remarks=[
            plus_minus_of_tests(
                [NORMAL], [view], ["elastomer_modulus", "elastomer_exponent"],
                found_from="regression",
            )
        ],
    )  # fmt: skip


def _parameters(view: TestView, fit: int) -> Iterator[str]:
    belongs = view.array("elastomer_parameter_fit")
    if belongs is None:
        return
    stress = shown("stress", view.units)
    for place in np.flatnonzero(belongs == fit):
        for name, unit in (("modulus", stress), ("exponent", None)):
            values = view.array_like(f"elastomer_{name}", belongs)
            half = expanded_of(view, f"elastomer_{name}", belongs).half
            if np.isfinite(values[place]):
                words_ = view.texts("elastomer_parameter_name")[place].replace("_", " ")
                text = measured(values[place], half[place], unit).text
                yield f"{words_} {text}{f' {unit.unit}' if unit else ''}"


def flag_table(view: TestView) -> Table | None:
    """Return how many samples of each channel carry each flag; only flags that occur."""
    counts = view.array("n_flagged")
    if counts is None or not counts.any():
        return None
    masks = [place for place in range(counts.shape[1]) if counts[:, place].any()]
    names = [view.texts("quality_mask")[place].replace("_", " ") for place in masks]
    rows = [
        [words(channel), *(count(counts[row, place]) for place in masks)]
        for row, channel in enumerate(view.texts("channel"))
    ]
    return make_table(
        f"Samples flagged, of {view.scalar('n_rows_kept'):,.0f} kept and"
        f" {view.scalar('n_rows_read'):,.0f} read; nothing is deleted.",
        ("channel", *(f"{name} [1]" for name in names)), rows, synthetic=view.is_synthetic,
    )  # fmt: skip

"""Tangent modulus, elastomer laws and stepwise tests."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from reduction.archive.uncertainty_budget import random_freedom
from reduction.quantities.flags import BRANCH_VALUES
from reduction.quantities.names import BRANCH_NAMES
from reduction.record.measurement import Floats
from reduction.report.figure_data import Figure, Trace, axis, band, line, make_figure, plain_numbers
from reduction.report.test_view import (
    NORMAL,
    Expanded,
    TestView,
    expand,
    expanded_of,
    factor_words,
    plus_minus,
    plus_minus_of_tests,
    shared_sources,
)
from reduction.report.text_style import (
    COLOURS,
    DASHES,
    LINE_DASHES,
    Shown,
    colour,
    plot_text,
    shown,
)
from reduction.stages.moduli.elastomer_laws import (
    LAWS,
    PARAMETERS,
    hyperelastic_stress,
    mooney_plot,
)

BRANCH_COLOURS = {"ascending": COLOURS[0], "descending": COLOURS[1]}


def draw_moduli(view: TestView) -> list[Figure]:
    """Draw one figure a specimen: mean with bands, trimmed ends and first loading beside."""
    strain, modulus = view.array("strain_bin"), view.array("tangent_modulus")
    if strain is None or modulus is None:
        return []
    in_stress, in_strain = shown("stress", view.units), shown("strain", view.units)
    parts = {
        name: view.array_like(f"tangent_modulus_{name}", modulus) * in_stress.factor
        for name in ("minimum", "maximum", "untrimmed")
    }
    everything = expanded_of(view, "tangent_modulus", modulus)
    scatter = _scatter_of(view, modulus)
    about = _about_bands(view, scatter, everything)
    parts |= {
        "all": everything.half * in_stress.factor, "scatter": scatter.half * in_stress.factor,
    }  # fmt: skip
    modulus = modulus * in_stress.factor
    x = strain * in_strain.factor
    found = []
    for index, specimen in enumerate(view.specimens):
        data: list[Trace] = []
        for place, branch in enumerate(view.texts("branch_name") or BRANCH_NAMES):
            own = (index, place)
            tint = BRANCH_COLOURS[branch]
            mean = modulus[own]
            data += [
                band(
                    x, parts["minimum"][own], parts["maximum"][own], colour=tint, alpha=0.13,
                    name=f"{branch}: least to greatest", showlegend=True, visible="legendonly",
                ),
                *(
                    band(
                        x, mean - parts[kind][own], mean + parts[kind][own], colour=tint,
                        alpha=alpha, name=f"{branch}: mean ± {kind}", legendgroup=branch,
                    )
                    for kind, alpha in (("all", 0.2), ("scatter", 0.4))
                ),
                line(
                    x, mean, name=branch, colour=tint, dash=DASHES[branch], width=2.2,
                    legendgroup=branch,
                ),
                line(
                    x, _trimmed_ends(mean, parts["untrimmed"][own]),
                    name=f"{branch}, trimmed away", colour=tint, dash="dot", width=1.3,
                    mode="lines+markers",
                    marker={"symbol": "x-thin-open", "size": 6, "color": tint},
                ),
            ]  # fmt: skip
            data += _first_loading(view, own, branch, in_strain, in_stress)
        found.append(
            make_figure(
                f"{view.key}-modulus-{index}",
                f"{view.id}: modulus, {specimen}",
                "Tangent modulus against strain, mean over the cycles. Dotted with crosses:"
                f" trimmed ends of a branch, where the rate is not constant; not used. {about}",
                [trace for trace in data if any(value is not None for value in trace["y"])],
                synthetic=view.is_synthetic,
                height=400,
                xaxis=axis(in_strain.label("strain")),
                yaxis=_modulus_axis(modulus, modulus + parts["all"], in_stress),
            )
        )
    return found


def draw_cycle_curves(view: TestView) -> list[Figure]:
    """Draw the modulus of the first and the last kept cycle, one figure a specimen."""
    strain, modulus = view.array("strain_bin"), view.array("tangent_modulus_by_cycle")
    cycles = view.array("selected_cycle")
    if strain is None or modulus is None or cycles is None or cycles.size < 2:
        return []
    in_stress, in_strain = shown("stress", view.units), shown("strain", view.units)
    spread = expanded_of(view, "tangent_modulus_by_cycle", modulus).half
    x = strain * in_strain.factor
    found = []
    for index, specimen in enumerate(view.specimens):
        data: list[Trace] = []
        for order, kept in enumerate((0, cycles.size - 1)):
            tint = COLOURS[order]
            for place, branch in enumerate(view.texts("branch_name") or BRANCH_NAMES):
                mean = modulus[index, kept, place] * in_stress.factor
                half = spread[index, kept, place] * in_stress.factor
                words = f"cycle {cycles[kept]:.0f}, {branch}"
                of = {"cycle": int(cycles[kept])}
                data += [
                    band(x, mean - half, mean + half, name=words, colour=tint, alpha=0.25, meta=of),
                    line(x, mean, name=words, colour=tint, dash=DASHES[branch], meta=of),
                ]
        found.append(
            make_figure(
                f"{view.key}-first-last-{index}", f"{view.id}: first and last cycle, {specimen}",
                "Tangent modulus of the first and of the last cycle, ascending solid,"
                f" descending dashed. {_about_cycles(view)}",
                [trace for trace in data if trace["y"]], synthetic=view.is_synthetic,
                xaxis=axis(in_strain.label("strain")),
                yaxis=axis(in_stress.label("tangent modulus"), rangemode="tozero"),
            )
        )  # fmt: skip
    return found


def _scatter_of(view: TestView, modulus: Floats) -> Expanded:
    """Return the expanded uncertainty of the scatter alone."""
    name = "tangent_modulus"
    both = view.array_like(f"{name}_standard_uncertainty", modulus)
    random = view.array(f"{name}_random_standard_uncertainty")
    return expand(
        both if random is None else random, degrees_of_freedom=random_freedom(view.data, name)
    )


def _about_bands(view: TestView, scatter: Expanded, everything: Expanded) -> str:
    """Say what the bands are; they are one where nothing but scatter is known."""
    name = "tangent_modulus"
    if not shared_sources([view], [name]):
        return plus_minus_of_tests(everything.factors, [view], [name], mark="Band, ±")
    held = f"scatter between cycles, noise, regression alone ({factor_words(scatter.factors)})"
    outer = plus_minus_of_tests(everything.factors, [view], [name], mark="outer band, ±")
    return f"Inner band: {held}; {outer}"


def _about_cycles(view: TestView) -> str:
    """Say what the band of a single cycle is."""
    if not shared_sources([view], ["tangent_modulus"]):
        return plus_minus([NORMAL], "noise, regression", mark="Band, ±")
    held = "noise, regression; and errors common to all samples, which move both cycles together"
    return plus_minus([NORMAL], held, left_out="", mark="Band, ±")


def _trimmed_ends(trimmed: Floats, whole: Floats) -> Floats:
    """Return the whole curve where the trimmed one has no value, and one bin into it to join on."""
    is_left = np.isfinite(trimmed)
    is_next = np.zeros_like(is_left)
    is_next[1:] |= ~is_left[:-1] & np.isfinite(whole[:-1])
    is_next[:-1] |= ~is_left[1:] & np.isfinite(whole[1:])
    return np.where(~is_left | is_next, whole, np.nan)


def _first_loading(
    view: TestView, own: tuple[int, int], branch: str, in_strain: Shown, in_stress: Shown
) -> list[Trace]:
    strain = view.array("first_loading_strain_bin")
    modulus = view.array("tangent_modulus_first_loading")
    if strain is None or modulus is None or not np.isfinite(modulus[own]).any():
        return []
    return [
        line(
            strain * in_strain.factor, modulus[own] * in_stress.factor,
            name=f"first loading, {branch}", colour=COLOURS[2], dash="dot", width=1.4,
            visible="legendonly",
        )
    ]  # fmt: skip


def _modulus_axis(mean: Floats, upper: Floats, in_stress: Shown) -> dict[str, object]:
    """Return one axis for all specimens, scaled to what is trusted."""
    title = in_stress.label("tangent modulus")
    if not np.isfinite(mean).any():
        return axis(title)
    usual = np.quantile(upper[np.isfinite(upper)], 0.97) if np.isfinite(upper).any() else 0.0
    return axis(title, range=plain_numbers(1.15 * np.array([0.0, max(np.nanmax(mean), usual)])))


FIT_POINTS = 60

LEAST_STRAIN = 0.05
"""Below this the reduced stress is a small number over a small number. [1]"""

_NAMES = {
    "neo-hookean": "neo-Hookean", "mooney-rivlin": "Mooney-Rivlin", "yeoh": "Yeoh",
    "ogden-2": "Ogden, two terms",
}  # fmt: skip


def draw_mooney(view: TestView) -> list[Figure]:
    """Draw the first loading of each specimen and the laws fitted to it, in their range."""
    strain, tension = (
        view.array("first_loading_strain_bin"), view.array("branch_tension_first_loading"),
    )  # fmt: skip
    area = view.array("area")
    if strain is None or tension is None or area is None or not view.texts("elastomer_law"):
        return []
    unit = shown("stress", view.units)
    ascending = (view.texts("branch_name") or BRANCH_NAMES).index("ascending")
    used = strain >= LEAST_STRAIN
    found = []
    for index, specimen in enumerate(view.specimens):
        stress = tension[index, ascending, used] / area[index]
        inverse, reduced = mooney_plot(strain[used], stress)
        data = [
            line(
                inverse, reduced * unit.factor, name="first loading", colour="#8C8C8C",
                mode="markers", marker={"size": 5, "color": "#8C8C8C"},
            ),
            *_laws(view, specimen, unit.factor),
        ]  # fmt: skip
        figure = make_figure(
            f"{view.key}-mooney-{index}", f"{view.id}: Mooney plot, {specimen}",
            "Reduced stress: stress of the first loading over twice the difference of stretch ratio"
            " and its inverse square. Lines: the fitted laws in their range. An upturn at the left"
            " shows the limited extensibility of the rubber.",
            data, synthetic=view.is_synthetic,
            xaxis=axis("inverse of the stretch ratio [1]"),
            yaxis=axis(unit.label("reduced stress")),
        )  # fmt: skip
        if len(data) > 1 and figure.has_data:
            found.append(figure)
    return found


def _laws(view: TestView, specimen: str, factor: float) -> Iterator[Trace]:
    owners, names = view.texts("elastomer_specimen"), view.texts("elastomer_law")
    low, high = view.array("elastomer_strain_low"), view.array("elastomer_strain_high")
    if low is None or high is None:
        return
    for place, (owner, name) in enumerate(zip(owners, names, strict=True)):
        parameters = _parameters(view, place + 1)
        law = next((one for one in LAWS if one == name), None)
        if owner != specimen or law is None or set(parameters) != set(PARAMETERS[law]):
            continue
        strain = np.linspace(max(low[place], LEAST_STRAIN), high[place], FIT_POINTS)
        inverse, reduced = mooney_plot(
            strain, hyperelastic_stress(strain, law=law, parameters=parameters)
        )
        order = LAWS.index(law)
        yield line(
            inverse, reduced * factor, name=_NAMES.get(law, law), colour=colour(order),
            dash=LINE_DASHES[order], width=1.6,
        )  # fmt: skip


def _parameters(view: TestView, fit: int) -> dict[str, float]:
    """Return the parameters of a fit by name; each stands as a modulus or as an exponent."""
    belongs = view.array("elastomer_parameter_fit")
    if belongs is None:
        return {}
    moduli = view.array_like("elastomer_modulus", belongs)
    values = np.where(
        np.isfinite(moduli), moduli, view.array_like("elastomer_exponent", belongs)
    )  # fmt: skip
    names = view.texts("elastomer_parameter_name")
    return {names[place]: float(values[place]) for place in np.flatnonzero(belongs == fit)}


OF_STEPS = (
    "scatter of the readings of length, and of weight where that is stated, and the curve between"
    " two readings"
)
"""What a number of a stepwise test has for itself: there are readings and no cycles."""

_TINTS = {"ascending": COLOURS[0], "descending": COLOURS[1]}


def flagged_steps(view: TestView) -> list[str]:
    """Return what is known against each reading, as words; empty where it is sound."""
    n_steps = int(view.data.sizes["step"])
    flags = view.array("step_flag")
    if flags is None:
        return [""] * n_steps
    meanings = view.flag_meanings("step_flag")
    return [
        ", ".join(name.replace("_", " ") for name, mask in meanings.items() if int(flag) & mask)
        for flag in flags
    ]


def draw_steps(view: TestView) -> list[Figure]:
    """Draw the readings, and the interval and secant moduli."""
    strain, tension = view.array("strain"), view.array("tension")
    if not view.is_stepwise or strain is None or tension is None:
        return []
    in_strain, in_tension = shown("strain", view.units), shown("tension", view.units)
    x, y = strain * in_strain.factor, tension * in_tension.factor
    branch = view.array_like("branch", strain)
    data: list[Trace] = [
        line(
            np.where(branch == BRANCH_VALUES[name], x, np.nan), y, name=name, colour=tint,
            dash=DASHES[name], mode="lines+markers", marker={"size": 6, "color": tint},
        )
        for name, tint in _TINTS.items()
    ]  # fmt: skip
    words = flagged_steps(view)
    flagged = np.array([bool(word) for word in words])
    if flagged.any():
        clock = np.array(view.texts("clock") or ("",) * flagged.size)
        data.append(
            {
                "type": "scatter", "mode": "markers+text", "name": "flagged",
                "x": plain_numbers(x[flagged]), "y": plain_numbers(y[flagged]),
                "text": [plot_text(time, 12) for time in clock[flagged]],
                "textposition": "bottom center", "textfont": {"size": 10},
                "marker": {
                    "symbol": "circle-open", "size": 14, "color": COLOURS[3],
                    "line": {"width": 2},
                },
            }
        )  # fmt: skip
    readings = make_figure(
        f"{view.key}-steps", f"{view.id}: tension against strain",
        "Each reading of the stepwise test; ascending solid, descending dashed; ringed readings are"
        f" flagged and not used for moduli{_reasons(view, words)}.",
        data, synthetic=view.is_synthetic, height=400,
        xaxis=axis(in_strain.label("strain")), yaxis=axis(in_tension.label("tension")),
    )  # fmt: skip
    moduli = _moduli(view)
    return [figure for figure in (readings, moduli) if figure.has_data]


def _reasons(view: TestView, words: list[str]) -> str:
    clock = view.texts("clock") or tuple(f"reading {k}" for k in range(1, len(words) + 1))
    said = [f"{time}: {word}" for time, word in zip(clock, words, strict=True) if word]
    return f" ({'; '.join(said)})" if said else ""


def _moduli(view: TestView) -> Figure:
    in_strain, in_stress = shown("strain", view.units), shown("stress", view.units)
    data: list[Trace] = []
    middle, modulus = view.array("interval_strain"), view.array("interval_modulus")
    if middle is not None and modulus is not None:
        half = expanded_of(view, "interval_modulus", modulus).half
        branch = view.array_like("interval_branch", modulus)
        for name, tint in _TINTS.items():
            own = (branch == BRANCH_VALUES[name]) & np.isfinite(modulus)
            data.append(
                line(
                    middle[own] * in_strain.factor, modulus[own] * in_stress.factor,
                    name=f"interval, {name}", colour=tint, dash=DASHES[name],
                    mode="lines+markers", marker={"size": 6, "color": tint},
                    error_y={
                        "type": "data", "array": plain_numbers(half[own] * in_stress.factor),
                        "color": tint, "thickness": 1, "width": 3,
                    },
                )
            )  # fmt: skip
    strain, secant = view.array("strain"), view.array("secant_modulus")
    if strain is not None and secant is not None:
        data.append(
            line(
                strain * in_strain.factor, secant * in_stress.factor, name="secant",
                colour=COLOURS[2], dash="dot", width=1.2, mode="lines+markers",
                marker={"size": 5, "symbol": "diamond", "color": COLOURS[2]},
            )
        )  # fmt: skip
    said = plus_minus_of_tests(
        [NORMAL], [view], ["interval_modulus"], found_from=OF_STEPS, mark="Bars, ±"
    )
    return make_figure(
        f"{view.key}-step-moduli", f"{view.id}: interval and secant modulus",
        "Interval modulus: slope of stress on strain between two readings, at their middle. Secant"
        f" modulus: stress over strain of one reading. {said}",
        [trace for trace in data if trace["y"]], synthetic=view.is_synthetic, height=400,
        xaxis=axis(in_strain.label("strain")), yaxis=axis(in_stress.label("modulus")),
    )  # fmt: skip

"""Mooney plot: reduced stress of a first loading against the inverse of the stretch ratio.

A Mooney-Rivlin solid is a straight line here and a neo-Hookean one a level line, so the
plot shows at a glance where a law holds and where it does not.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from reduction.moduli.elastomer import mooney_plot
from reduction.moduli.hyperelastic import LAWS, PARAMETERS, hyperelastic_stress
from reduction.report.figure import Figure, Trace, axis, line, make_figure
from reduction.report.style import colour, shown
from reduction.report.view import TestView
from reduction.vocabulary import BRANCH_NAMES

FIT_POINTS = 60
LEAST_STRAIN = 0.05
"""Below this the reduced stress is a small number over a small number. [1]"""
_NAMES = {
    "neo-hookean": "neo-Hookean", "mooney-rivlin": "Mooney-Rivlin", "yeoh": "Yeoh",
    "ogden-2": "Ogden, two terms",
}  # fmt: skip
_DASHES = ("solid", "dash", "dot", "dashdot")


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
            " and its inverse square. Lines: the fitted laws in their range. An upturn at"
            " the left is the rubber coming to the end of its chains.",
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
            dash=_DASHES[order], width=1.6,
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

"""A hose from its plan to its response and events.

It is independent of the archive that stores it.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from reduction.prediction.hose_geometry import (
    NEUTRAL_ANGLE,
    greatest_layer_angle,
    layer_range,
    least_layer_angle,
    number_of_cords,
    ribbon_width,
)
from reduction.prediction.hose_product import HoseDesign, HoseEvents, HosePrediction
from reduction.prediction.hose_tension import (
    find_events,
    predict_hose,
    predict_two_layers,
    torque_balanced_angle,
)
from reduction.prediction.hose_uncertainty import HoseUncertainty, propagate_hose, with_pick_up
from reduction.record.arrays import runs_of_true
from reduction.record.errors import SettingsError
from reduction.record.measurement import Bools, Floats
from reduction.record.notes import Note, note

HOSE_SERIES = (
    "strain", "free_strain", "tension", "fill_pressure", "cord_tension", "cord_strain",
    "cord_share", "rubber_share", "end_cap_load", "current_wrap_angle", "cord_spacing",
    "current_inner_diameter",
)  # fmt: skip
"""Numbers of a predicted hose at each strain."""


@dataclass(frozen=True)
class HelicalLayer:
    """A layer that carries no load: fish-bite protection, conductors.

    ``wrap_angle`` is from the axis [rad]; ``strain_limit`` is the greatest tensile strain
    that it withstands and ``compression_limit`` the greatest compressive strain, a positive number
    [1]; NaN where none is stated.
    """

    name: str
    wrap_angle: float
    strain_limit: float
    compression_limit: float


@dataclass(frozen=True)
class HosePlan:
    """Input of a prediction.

    ``standard_uncertainty`` is by name of `reduction.prediction.hose_product.HOSE_PARAMETERS`, in
    the unit of that parameter; ``strain_step`` and ``greatest_strain`` refer to the whole length
    [1], the latter NaN to continue to the break of the cords; ``length`` is relaxed, NaN where not
    stated [m].
    """

    name: str
    design: HoseDesign
    standard_uncertainty: dict[str, float] = field(default_factory=dict)
    strain_step: float = 0.01
    greatest_strain: float = float("nan")
    layers: tuple[HelicalLayer, ...] = ()
    length: float = float("nan")


@dataclass(frozen=True)
class HoseTarget:
    """Required state of a hose where its cords carry their working share.

    ``strain`` refers to the whole length [1], ``tension`` is the safe working load, None where any
    is acceptable [N].
    """

    strain: float
    tension: float | None


@dataclass(frozen=True)
class _LayerResponse:
    """Strain of a layer that carries no load while the hose goes to its working load.

    ``least_strain``, ``greatest_strain`` and ``break_strain``, the greatest up to the break of
    the cords, are strains of the layer [1]; ``least_angle`` is the smallest angle at which it
    is not stretched beyond its limit, ``greatest_angle`` the greatest at which it is not
    compressed beyond its limit, NaN where no limit is stated [rad].
    """

    layer: HelicalLayer
    least_strain: float
    greatest_strain: float
    break_strain: float
    least_angle: float
    greatest_angle: float


@dataclass(frozen=True)
class PredictedHose:
    """A plan with its response, its events, their uncertainty and its other layers.

    ``ribbon_width`` is that of each cord layer [m], ``number_of_cords`` that of both layers [1];
    ``working_torque`` holds the hose against turning at the working load [N m], and
    ``balanced_wrap_angle`` is that of an outer layer with which no torque is left [rad].
    """

    plan: HosePlan
    prediction: HosePrediction
    events: HoseEvents
    uncertainty: HoseUncertainty
    ribbon_width: tuple[float, float]
    number_of_cords: float
    working_torque: float
    balanced_wrap_angle: float
    layers: tuple[_LayerResponse, ...]
    notes: tuple[Note, ...]


_MOST_POINTS = 20_000

_HIGH_UNCERTAINTY = 0.2


def predict_from_plan(plan: HosePlan) -> PredictedHose:
    """Predict one hose."""
    design = plan.design
    events = find_events(design)
    strain = _strains(plan, float(events.cord_break.strain))
    prediction = predict_hose(design, strain)
    uncertainty = with_pick_up(design, propagate_hose(design, strain, plan.standard_uncertainty))
    working, at_break = float(events.working.strain), float(events.cord_break.strain)
    share = float(design.dead_length_share)
    layers = tuple(_layer(layer, working, at_break, share) for layer in plan.layers)
    first, second = (
        float(ribbon_width(diameter, design.wrap_angle)) for diameter in design.layer_diameter
    )
    relative = float(uncertainty.working.tension_standard_uncertainty) / float(
        events.working.tension
    )
    notes = [*_notes_of_design(plan, prediction), *(said for one in layers for said in _says(one))]
    if relative > _HIGH_UNCERTAINTY:
        notes.append(note("working-load-uncertain", effect=relative))
    return PredictedHose(
        plan=plan,
        prediction=prediction,
        events=events,
        uncertainty=uncertainty,
        ribbon_width=(first, second),
        number_of_cords=float(
            number_of_cords(design.wrap_diameter, design.wrap_angle, design.cords_per_length)
        ),
        # that of layers of one diameter would be rounding
        working_torque=float(
            predict_two_layers(design, float(design.wrap_angle), [working]).torque[0]
        )
        if np.any(np.not_equal(*design.layer_diameter))
        else 0.0,
        balanced_wrap_angle=torque_balanced_angle(design, working),
        layers=layers,
        notes=tuple(notes),
    )


def _strains(plan: HosePlan, at_break: float) -> Floats:
    """Whole steps up to the end, and the end itself where it is the break of the cords."""
    end = at_break if np.isnan(plan.greatest_strain) else plan.greatest_strain
    if end / plan.strain_step > _MOST_POINTS:
        raise SettingsError(
            f"hose '{plan.name}' has no end of strains",
            found=f"{end / plan.strain_step:.3g} steps of {100 * plan.strain_step:g} %",
            needed=f"at most {_MOST_POINTS}",
            hint="Make strain_step larger, or greatest_strain smaller.",
        )
    n_steps = int(np.floor(end / plan.strain_step + 1e-9)) + 1
    steps = np.arange(n_steps, dtype=np.float64) * plan.strain_step
    if np.isnan(plan.greatest_strain) and steps[-1] < end:
        return np.append(steps, end)
    return steps


def _layer(
    layer: HelicalLayer, working: float, at_break: float, dead_length_share: float
) -> _LayerResponse:
    upto = layer_range(layer.wrap_angle, working, dead_length_share=dead_length_share)
    further = layer_range(layer.wrap_angle, at_break, dead_length_share=dead_length_share)
    least = greatest = np.nan
    if np.isfinite(layer.strain_limit):
        least = float(
            least_layer_angle(
                working, strain_limit=layer.strain_limit, dead_length_share=dead_length_share
            )
        )
    if np.isfinite(layer.compression_limit):
        greatest = float(
            greatest_layer_angle(
                working,
                compression_limit=layer.compression_limit,
                dead_length_share=dead_length_share,
            )
        )
    return _LayerResponse(
        layer=layer,
        least_strain=float(upto.least_strain),
        greatest_strain=float(upto.greatest_strain),
        break_strain=float(further.greatest_strain),
        least_angle=least,
        greatest_angle=greatest,
    )


def _says(one: _LayerResponse) -> list[Note]:
    """Strains of a layer beyond its limits."""
    name, said = one.layer.name, []
    if one.greatest_strain > one.layer.strain_limit:
        said.append(
            note(
                "layer-stretched", layer=name, strain=one.greatest_strain,
                limit=one.layer.strain_limit, angle=one.least_angle,
            )
        )  # fmt: skip
    if -one.least_strain > one.layer.compression_limit:
        said.append(
            note(
                "layer-compressed", layer=name, strain=one.least_strain,
                limit=one.layer.compression_limit, angle=one.greatest_angle,
            )
        )  # fmt: skip
    if one.greatest_angle < one.least_angle:
        said.append(note("layer-without-angle", layer=name))
    return said


# [Pa], 1, [Pa], [rad], 1: outside of these, a unit or a diameter is more likely to be wrong
_CORD_STRESS, _CORD_SHARE, _RUBBER = (0.25e9, 2.2e9), (0.15, 1.02), (0.5e6, 20e6)

_ANGLE, _DEAD = (np.radians(50), np.radians(85)), 0.3


def doubts_of_design(plan: HosePlan) -> list[Note]:
    """Warnings about numbers of a design that no hose has."""
    design, name = plan.design, plan.name
    cord, spacing, scale, rubber, angle, dead = (
        float(np.mean(one))
        for one in (
            design.cord_diameter, design.cords_per_length, design.cord_load_scale,
            design.rubber_modulus, design.wrap_angle, design.dead_length_share,
        )
    )  # fmt: skip
    stress = float(design.cord.load[-1]) * scale / (np.pi * cord**2 / 4)
    found = []
    if not _CORD_STRESS[0] <= stress <= _CORD_STRESS[1]:
        found.append(note("cord-stress-outside-band", name, stress=stress,
                          low=_CORD_STRESS[0], high=_CORD_STRESS[1]))  # fmt: skip
    if not _CORD_SHARE[0] <= cord * spacing <= _CORD_SHARE[1]:
        found.append(note("cords-do-not-fit", name, share=cord * spacing))
    if not _RUBBER[0] <= rubber <= _RUBBER[1]:
        found.append(note("hose-rubber-outside-band", name, modulus=rubber,
                          low=_RUBBER[0], high=_RUBBER[1]))  # fmt: skip
    if not _ANGLE[0] <= angle <= _ANGLE[1]:
        found.append(note("wrap-angle-outside-band", name, angle=angle))
    if dead > _DEAD:
        found.append(note("dead-length-large", name, share=dead))
    return found


def _notes_of_design(plan: HosePlan, prediction: HosePrediction) -> list[Note]:
    design: HoseDesign = plan.design
    notes = doubts_of_design(plan)
    if float(design.wrap_angle) <= NEUTRAL_ANGLE:
        notes.append(note("no-slack-zone", angle=float(design.wrap_angle)))
    for name, code in (("is_jammed", "cords-touch"), ("is_bore_too_small", "bore-too-small")):
        where = _ranges(prediction.strain, getattr(prediction, name))
        if where:
            notes.append(note(code, where=where))
    beyond = prediction.strain[prediction.is_broken]
    if beyond.size:
        notes.append(note("cords-broken", strain=float(beyond[0])))
    if not plan.standard_uncertainty:
        notes.append(note("hose-without-uncertainty"))
    return notes


def _ranges(strain: Floats, is_so: Bools) -> str:
    """Ranges with a property; cords of a steep hose may touch at rest and again near the end."""
    return " and ".join(
        f"from {100 * strain[first]:.1f} to {100 * strain[stop - 1]:.1f}"
        for first, stop in runs_of_true(is_so)
    )

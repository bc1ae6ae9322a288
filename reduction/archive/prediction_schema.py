"""Every variable that an archive of predictions may have.

=========================  ===========================================================
dimension                  one entry for
=========================  ===========================================================
``hose``                   each hose; text coordinate
``hose_point``             each strain of its table, from 1
``hose_event``             slackest cords, pick-up, working load, break; text coordinate
``uncertainty_source``     each number of a design that may be uncertain; text coordinate
``cord_layer``             the inner and the outer one; text coordinate
``cord_point``             each measured point of the cord, from 1
``hose_layer``             each layer that carries no load, from 1
``note``                   each note of any hose
=========================  ===========================================================

A hose that has fewer entries than another ends in NaN, empty text or 0.  A contribution is the
change for one standard uncertainty of its source, with its sign: the covariance of two points
is the sum over the sources of their products.
"""

from __future__ import annotations

from itertools import chain

from reduction.archive.reasons import PART, SETTING
from reduction.archive.variable import Variable, count, label, mask, measured, stated

HOSE_STATES = {"slack": 1, "broken": 2, "jammed": 4, "bore_too_small": 8}
"""Masks: cords carry nothing, are broken, touch; the bore is below its limit."""

_H = ("hose",)
_P = ("hose", "hose_point")
_E = ("hose", "hose_event")
_S = ("hose", "uncertainty_source", "hose_point")
_L = ("hose", "cord_layer")
_C = ("hose", "cord_point")
_N = ("hose", "hose_layer")

_GIVEN = "given: the strain at which the hose is predicted"
_GEOMETRY = "follows from strain and wrap angle alone"
_CURVE = "see cord_strain_scale and cord_load_scale"
_NOT_CARRIED = "not carried through: see the tension"

PREDICTION_SCHEMA: dict[str, Variable] = {
    row.name: row
    for row in chain(
        label("hose", _H),
        label("hose_event", ("hose_event",)),
        label("uncertainty_source", ("uncertainty_source",)),
        label("cord_layer", ("cord_layer",)),
        count("hose_point", ("hose_point",)),
        count("cord_point", ("cord_point",)),
        count("hose_layer", ("hose_layer",)),
        *(
            measured(name, _H)
            for name in (
                "wrap_angle",
                "inner_diameter",
                "outer_diameter",
                "cords_per_length",
                "rubber_modulus",
                "cord_load_scale",
                "cord_strain_scale",
                "dead_length_share",
            )
        ),
        measured("layer_diameter", _L),
        stated("cord_diameter", _H, "limits the spacing alone"),
        label("rubber_law", _H),
        stated("working_share", _H, SETTING),
        stated("minimum_inner_diameter", _H, SETTING),
        stated("ribbon_width", _L, _GEOMETRY),
        stated("number_of_cords", _H, _GEOMETRY),
        stated("cord_curve_strain", _C, _CURVE),
        stated("cord_curve_load", _C, _CURVE),
        stated("strain", _P, _GIVEN),
        stated("free_strain", _P, _GEOMETRY),
        measured("tension", _P),
        measured("fill_pressure", _P),
        *(
            stated(name, _P, _NOT_CARRIED)
            for name in (
                "cord_tension",
                "cord_strain",
                "cord_share",
                "rubber_share",
                "end_cap_load",
            )
        ),
        *(
            stated(name, _P, _GEOMETRY)
            for name in ("current_wrap_angle", "cord_spacing", "current_inner_diameter")
        ),
        mask("hose_state", _P, HOSE_STATES),
        stated("tension_contribution", _S, PART),
        stated("fill_pressure_contribution", _S, PART),
        measured("event_strain", _E),
        measured("event_tension", _E),
        measured("event_fill_pressure", _E),
        stated("event_cord_tension", _E, _NOT_CARRIED),
        stated("event_cord_strain", _E, _NOT_CARRIED),
        label("hose_layer_name", _N),
        *(
            stated(f"hose_layer_{name}", _N, why)
            for name, why in (
                ("wrap_angle", SETTING),
                ("strain_limit", SETTING),
                ("compression_limit", SETTING),
                ("least_strain", _NOT_CARRIED),
                ("greatest_strain", _NOT_CARRIED),
                ("break_strain", _NOT_CARRIED),
                ("least_angle", _NOT_CARRIED),
                ("greatest_angle", _NOT_CARRIED),
            )
        ),
        label("note_hose", ("note",)),
        label("note", ("note",)),
    )
}
"""Every variable that an archive of predictions may have."""

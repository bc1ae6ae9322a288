"""Quantities of predictions from construction alone."""

from __future__ import annotations

from reduction.vocabulary.row import Quantity

OF_PREDICTIONS = (
    Quantity("hose", "", "hose that is predicted"),
    Quantity("hose_point", "1", "number of the strain in the table of the hose"),
    Quantity(
        "free_strain", "1", "nominal strain of the part of the hose that stretches", "000 eps_h"
    ),
    Quantity("fill_pressure", "Pa", "pressure in the bore above that outside", "000 p_h, eq 24"),
    Quantity("cord_tension", "N", "tension of one cord", "000 P_c"),
    Quantity(
        "cord_strain",
        "1",
        "strain of a cord along its helix, below zero where it is slack",
        "000 eps_c, eq 8",
    ),
    Quantity(
        "cord_share", "1", "share of the net tension that the cords carry, the end cap taken off"
    ),
    Quantity("rubber_share", "1", "share of the net tension that the rubber carries"),
    Quantity(
        "end_cap_load",
        "N",
        "axial load that the fill pressure takes off that of the cords",
        "000 p_h A_b",
    ),
    Quantity(
        "current_wrap_angle",
        "rad",
        "angle of the cords from the axis of the stretched hose",
        "000 eq 7",
    ),
    Quantity("cord_spacing", "m", "distance between centres of neighbouring cords", "000 c, eq 23"),
    Quantity("current_inner_diameter", "m", "bore of the stretched hose"),
    Quantity("hose_state", "1", "what is to be said of the hose at that strain"),
    Quantity("hose_event", "", "what happens to the cords"),
    Quantity("event_strain", "1", "strain of the hose at the event"),
    Quantity("event_tension", "N", "tension of the hose at the event"),
    Quantity("event_fill_pressure", "Pa", "fill pressure at the event"),
    Quantity("event_cord_tension", "N", "tension of one cord at the event"),
    Quantity("event_cord_strain", "1", "strain of a cord at the event"),
    Quantity("uncertainty_source", "", "number of the design that is uncertain"),
    Quantity(
        "tension_contribution", "N", "change of tension for a standard uncertainty of the source"
    ),
    Quantity(
        "fill_pressure_contribution",
        "Pa",
        "change of fill pressure for a standard uncertainty of the source",
    ),
    Quantity(
        "wrap_angle", "rad", "wrap angle of the cords at rest, from the hose axis", "000 alpha_0"
    ),
    Quantity("cord_layer", "", "cord layer"),
    Quantity("layer_diameter", "m", "mean diameter of the cord layer at rest", "000 d_w0"),
    Quantity("inner_diameter", "m", "inner diameter of the hose at rest"),
    Quantity("outer_diameter", "m", "outer diameter of the hose at rest"),
    Quantity("cords_per_length", "m-1", "cords per length of fabric, across them", "000 n_c"),
    Quantity("cord_diameter", "m", "diameter of a cord"),
    Quantity("rubber_modulus", "Pa", "Young's modulus of the rubber at small strain", "000 E_r"),
    Quantity("rubber_law", "", "how the rubber wall carries tension"),
    Quantity("working_share", "1", "share of the break load of a cord at the safe working load"),
    Quantity("cord_load_scale", "1", "factor on the load of the cord curve"),
    Quantity("cord_strain_scale", "1", "factor on the strain of the cord curve"),
    Quantity("dead_length_share", "1", "share of the relaxed length that does not stretch"),
    Quantity("minimum_inner_diameter", "m", "smallest bore that is allowed"),
    Quantity(
        "ribbon_width", "m", "width to which the ribbon of a cord layer is cut", "000 w_c, eq 10"
    ),
    Quantity(
        "number_of_cords", "1", "cords in the section of the hose, both layers", "000 N, eq 11"
    ),
    Quantity("cord_point", "1", "number of the measured point of the cord"),
    Quantity("cord_curve_strain", "1", "strain of a measured point of the cord"),
    Quantity("cord_curve_load", "N", "load of a measured point of the cord"),
    Quantity("hose_layer", "1", "number of the layer that carries no load"),
    Quantity("hose_layer_name", "", "layer that carries no load"),
    Quantity("hose_layer_wrap_angle", "rad", "wrap angle of the layer at rest, from the hose axis"),
    Quantity("hose_layer_strain_limit", "1", "greatest tensile strain that the layer bears"),
    Quantity(
        "hose_layer_compression_limit", "1", "greatest compressive strain that the layer bears"
    ),
    Quantity("hose_layer_least_strain", "1", "least strain of the layer up to the working load"),
    Quantity(
        "hose_layer_greatest_strain", "1", "greatest strain of the layer up to the working load"
    ),
    Quantity(
        "hose_layer_break_strain", "1", "greatest strain of the layer up to the break of the cords"
    ),
    Quantity(
        "hose_layer_least_angle",
        "rad",
        "smallest angle at which the layer is not stretched beyond its limit",
    ),
    Quantity(
        "hose_layer_greatest_angle",
        "rad",
        "greatest angle at which the layer is not compressed beyond its limit",
    ),
    Quantity("note_hose", "", "hose that the note is of"),
)

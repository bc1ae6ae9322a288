"""SPEC.toml of a wave load and of an armour: the hose of Zhang (2015), the steel of Wang (2022)."""

from reduction.campaign.prediction_specs import load_armour_case, load_wave_case
from reduction.prediction.armour import predict_armour_case
from reduction.prediction.wave_load import predict_wave_load

WAVE = """
[wave_load]
outer_diameter = "114 mm"
wall_thickness = "6 mm"
wall_density = "1.25 g/cm^3"
content_density = "0.83 g/cm^3"
water_density = "1.025 g/cm^3"
water_depth = "6 m"
wave_height = "1.25 m"
wave_period = "3.57 s"
wave_length = "20 m"
wave_theory = "airy"
current_velocity = "0.5 m/s"
wind_velocity = "10 m/s"
hose_length = "100 m"
"""
LEAST_WAVE = """
[wave_load]
outer_diameter = "114 mm"
wall_thickness = "6 mm"
wall_density = "1.25 g/cm^3"
content_density = "0 kg/m^3"
water_depth = "6 m"
wave_height = "1.25 m"
wave_period = "3.57 s"
"""
ARMOUR = """
[armour]
axial_strain = "0.1 %"
[[armour.layers]]
name = "inner"
winding_angle = "20 deg"
wire_radius = "2.5 mm"
core_radius = "25 mm"
n_wires = 30
yield_stress = "700 MPa"
[[armour.layers]]
name = "outer"
winding_angle = "20 deg"
wire_diameter = "5 mm"
core_diameter = "60 mm"
n_wires = 36
lay = "left"
yield_stress = "700 MPa"
"""
LEAST_ARMOUR = """
[armour]
axial_strain = 0.001
[[armour.layers]]
winding_angle = "45 deg"
wire_radius = "2.5 mm"
core_radius = "25 mm"
"""


def changed(text, old, new):
    """The text with one place in it replaced."""
    assert old in text
    return text.replace(old, new, 1)


def predicted_wave(path, text=WAVE, **changes):
    path.write_text(text, encoding="utf-8")
    return predict_wave_load(**load_wave_case(path) | changes)


def predicted_armour(path, text=ARMOUR):
    path.write_text(text, encoding="utf-8")
    case = load_armour_case(path)
    return predict_armour_case(
        case.layers, case.strain, names=case.layer_names, tolerance=case.tolerance
    )

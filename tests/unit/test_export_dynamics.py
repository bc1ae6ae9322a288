"""None"""

import math
from dataclasses import replace

import numpy as np
import pytest
from export_lines import constant, growing, syrope
from export_sources import LEVELS, REST, SPRING, TIME, loop, source, surface

from reduction.lines.export_dynamics import _half_widths, line_dynamics
from reduction.lines.export_sources import line_from_lookup
from reduction.lines.line_lookup import look_up
from reduction.lines.lookup_product import LineCurve, LineLevels
from reduction.record.contributions import Component
from reduction.record.errors import DataError, SettingsError
from reduction.stages.three_parameter_line.line_model import identify_by_amplitude


def test_the_dashpot_of_a_mooring_code_gives_the_same_stiffness_at_every_frequency():
    part = constant()
    slow, fast = part.static_stiffness, part.fast_stiffness
    omega = np.logspace(-4, 3, 40)
    maxwell = slow + (fast - slow) / (1 - 1j / (omega * part.relaxation_time))
    spring = 1 / (1 / slow - 1 / fast)
    series = 1 / (1 / fast + 1 / (spring + 1j * omega * part.slow_dashpot_coefficient))
    np.testing.assert_allclose(series, maxwell, rtol=1e-12)
    assert part.relaxation_time == 3.0


def test_a_stiffness_that_grows_is_taken_at_its_mean_tension():
    assert growing().fast_stiffness == 3e4 + 10 * 2000


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"dashpot_coefficient": -1.0}, "must be zero or positive"),
        ({"dashpot_coefficient": math.nan}, "must be zero or positive"),
        ({"dynamic_stiffness_per_mean_tension": 5.0}, "has no mean tension"),
        ({"dynamic_stiffness": 2e4}, "not above the static one"),
        ({"static_stiffness": 0.0}, "not above the static one"),
    ],
)
def test_a_line_that_is_not_stiffer_when_fast_is_refused(changed, message):
    with pytest.raises(SettingsError, match=message):
        constant(**changed)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"form": "CUBIC"}, "form of a Syrope working curve is not known"),
        ({"k1": 0.0}, "form LINEAR cannot have"),
        ({"form": "QUADRATIC", "k2": 1.5}, "form QUADRATIC cannot have"),
        ({"form": "EXP", "k1": 1.0, "k2": 1.0}, "form EXP cannot have"),
        ({"mean_tension": 4e6}, "do not fit its original working curve"),
        ({"greatest_mean_tension": 7e6}, "do not fit its original working curve"),
        ({"slow_damping": 0.0}, "stiffness and damping of a Syrope line"),
        ({"dynamic_stiffness": 5e7, "dynamic_stiffness_per_mean_tension": 0.0}, "stiffer than"),
    ],
)
def test_a_syrope_that_moordyn_would_not_survive_is_refused(changed, message):
    with pytest.raises(SettingsError, match=message):
        syrope(**changed)


def test_a_working_curve_ends_at_the_greatest_mean_tension_and_begins_at_its_share_of_strain():
    for form, k1, k2 in (("LINEAR", 0.2, 0), ("QUADRATIC", 0.2, 0.5), ("EXP", 0.2, 1.5)):
        at_top = syrope(form=form, k1=k1, k2=k2, mean_tension=3e6)
        assert at_top.initial_strain == pytest.approx(0.04)
        at_zero = syrope(form=form, k1=k1, k2=k2, mean_tension=1e-3)
        assert at_zero.initial_strain == pytest.approx(0.008, abs=1e-9)
    assert syrope(k1=1e8).initial_strain == pytest.approx(0.04 - 2e6 / 1e8)


@pytest.mark.parametrize(
    ("form", "k1", "k2", "slope"),
    [
        # 3 MN over 0.04 (1 - k1) of strain, times 1, 1 + k2 and k2 / (1 - exp(-k2)) at the top
        ("LINEAR", 0.5, 0.0, 3e6 / 0.02),
        ("LINEAR", 1.6e8, 0.0, 1.6e8),
        ("QUADRATIC", 0.2, 1.0, 3e6 / 0.032 * 2),
        ("EXP", 0.2, 1.5, 3e6 / 0.032 * 1.5 / (1 - np.exp(-1.5))),
    ],
)
def test_a_working_curve_that_is_stiffer_than_the_fast_spring_is_refused(form, k1, k2, slope):
    """MoorDyn starts it a fifth below the tension that it is told."""
    fields = {"form": form, "k1": k1, "k2": k2, "dynamic_stiffness_per_mean_tension": 0.0}
    assert syrope(**fields, dynamic_stiffness=1.001 * slope).k1 == k1
    with pytest.raises(SettingsError, match="working curve is stiffer than the dynamic stiffness"):
        syrope(**fields, dynamic_stiffness=0.999 * slope)


# dynamics of an exported line against the K_ap and H that its own surfaces give


def measured(apparent, energy, **changed):
    one = source(growth=0.0, **changed)
    more = {
        "apparent_spring_constant": surface("apparent_spring_constant", apparent, sigma=400.0),
        "hysteresis_energy": surface("hysteresis_energy", energy, sigma=0.02 * abs(energy)),
    }
    return replace(one, surfaces=one.surfaces | more)


def test_k_1_and_tau_are_those_that_give_back_the_loop_and_not_the_printed_ones():
    apparent, energy = loop()
    found = line_dynamics(measured(apparent, energy), LEVELS)
    part = found.part
    assert part.static_stiffness == REST
    assert part.fast_stiffness == pytest.approx(REST + SPRING, rel=1e-9)
    # printed is 3 s
    assert part.relaxation_time == pytest.approx(TIME, rel=1e-9)
    assert part.apparent_stiffness == pytest.approx(apparent, rel=1e-12)
    assert part.hysteresis_energy_at(0.3, 700.0) == pytest.approx(energy, rel=1e-9)
    assert found.notes[0].startswith("K_1 30000 N and tau 0.8 s are identified")
    off = 100 * (loop(time=3.0)[0] / apparent - 1)
    assert f"where the line has {apparent:.5g}, {off:+.1f} percent" in found.notes[1]
    assert not any(text.startswith("DOUBTFUL") for text in found.notes)


def test_k_ap_over_frequency_stands_beside_the_surface():
    apparent, energy = loop()
    (text,) = (
        one for one in line_dynamics(measured(apparent, energy), LEVELS).notes if "0.1 Hz" in one
    )
    turned = 2j * np.pi * 0.1 * TIME
    slow = abs(REST + SPRING * turned / (1 + turned))
    # the surface of this test does not change with the frequency
    said = f"0.1 Hz {slow:.5g} against {apparent:.5g} N ({100 * (slow / apparent - 1):+.1f} percent"
    assert f"{said}, OUTSIDE its interval)" in text
    assert f"0.3 Hz {apparent:.5g} against {apparent:.5g} N (" in text


def test_without_surfaces_of_k_1_and_tau_the_loop_is_enough():
    one = measured(*loop())
    one = replace(
        one, surfaces={name: one.surfaces[name] for name in one.surfaces if name.endswith(("apparent_spring_constant", "energy"))}
    )  # fmt: skip
    found = line_dynamics(one, LEVELS)
    assert found.part.relaxation_time == pytest.approx(TIME)
    assert "no surfaces of K_1 and tau" in found.notes[1]


def test_where_no_line_gives_back_the_loop_the_printed_one_stands_if_k_ap_is_in_its_interval():
    # K_ap of the printed 3e4 N and 3 s is 49,200 N
    apparent = loop(time=3.0)[0] + 300
    found = line_dynamics(measured(apparent, -1.0), LEVELS)
    assert found.part.relaxation_time == pytest.approx(3.0)
    assert found.notes[0].startswith("DOUBTFUL")
    assert "not positive" in found.notes[0]
    assert f"{100 * ((apparent - 300) / apparent - 1):+.1f} percent" in found.notes[0]


@pytest.mark.parametrize(
    ("rest", "apparent", "energy", "message"),
    [
        (2e4, 6e4, -1.0, "printed ones give a K_ap different"),
        (6e4, 5e4, 5.0, "the storage spring constant does not exceed"),
        (2e4, 4.92e4, -1.0, "not positive"),
    ],
)
def test_what_no_parameters_give_back_is_refused(rest, apparent, energy, message):
    curves = (
        LineCurve("strain", "tension", 0.0, 4000.0, coefficient=np.array([0, 1e-4])),
        LineCurve(
            "quasi_static_spring_constant", "mean_tension", 0.0, 4000.0,
            coefficient=np.array([rest]),
        ),
    )  # fmt: skip
    one = measured(apparent, energy, curves=curves)
    if "not positive" in message:
        one.surfaces["relaxation_time"] = surface("relaxation_time", -1.0)
    with pytest.raises(DataError, match=message):
        line_dynamics(one, LEVELS)


def test_without_printed_parameters_there_is_nothing_to_fall_back_to():
    one = measured(4.9e4, -1.0)
    for name in ("dissipation_spring_constant", "relaxation_time"):
        del one.surfaces[name]
    with pytest.raises(DataError, match="not positive; found K_0 20000 N, K_ap 49000 N"):
        line_dynamics(one, LEVELS)


def test_damping_whose_interval_holds_zero_is_doubtful():
    apparent, energy = loop()
    one = measured(apparent, energy)
    one.surfaces["hysteresis_energy"] = surface("hysteresis_energy", energy, sigma=energy)
    notes = line_dynamics(one, LEVELS).notes
    assert any("the damping may be zero" in text for text in notes)
    one.surfaces["hysteresis_energy"] = surface("hysteresis_energy", energy, sigma=np.nan)
    assert any("H has no interval" in text for text in line_dynamics(one, LEVELS).notes)
    # K_1 of a fifteenth of K_ap moves fifteen times as much as K_ap
    apparent, energy = loop(spring=2e3)
    one = measured(apparent, energy)
    one.surfaces["apparent_spring_constant"] = surface(
        "apparent_spring_constant", apparent, sigma=0.1 * apparent
    )
    assert any("the dashpot is poorly known" in text for text in line_dynamics(one, LEVELS).notes)
    # K_1 and tau alone: sigma 10 s of 3 s, and none
    assert any("the dashpot may be zero" in text for text in line_dynamics(source(), LEVELS).notes)
    alone = source()
    alone.surfaces["relaxation_time"] = surface("relaxation_time", 3.0, sigma=np.nan)
    assert any("tau has no interval" in text for text in line_dynamics(alone, LEVELS).notes)


def test_growth_that_would_make_the_stiffness_negative_is_not_written_and_said():
    # K_0 + K_1 is 50,000 N at 2,000 N of mean and falls to 0 at 1,000 N: 50 N per N
    found = line_dynamics(source(growth=5e4), LEVELS)
    assert found.part.dynamic_stiffness_per_mean_tension == 0
    assert "negative at zero tension" in found.part.growth
    assert found.part.fast_stiffness == pytest.approx(5e4)
    # K_1 of -30,000 N is no line
    assert "does not increase" in line_dynamics(source(growth=-1e3), LEVELS).part.growth


def rope_of_levels(springs, *, also=()):
    """A rope without an experiment: K_1 at means of 1, 2, 3 kN ..., and other levels beside."""
    rows = [(0.3, 1000.0 * (k + 1), 700.0, spring) for k, spring in enumerate(springs)]
    at = np.array([row[:3] for row in (*rows, *also)])
    loops = np.array([loop(spring=row[3]) for row in (*rows, *also)])
    size = len(at)
    levels = tuple(
        LineLevels(
            quantity, ("frequency", "mean_tension", "tension_amplitude"), at, loops[:, place],
            0.01 * loops[:, place], np.full(size, np.inf), tuple(f"C{k}" for k in range(size)),
        )
        for place, quantity in enumerate(("apparent_spring_constant", "hysteresis_energy"))
    )  # fmt: skip
    return source(surfaces={}, factor_names=(), levels=levels)


def test_k_ap_at_another_tested_amplitude_stands_beside_that_of_the_line():
    """The line has one K_ap at all amplitudes; a rope that was tested at half of it has another."""
    mean = LEVELS["mean_tension"]
    one = rope_of_levels([2.5e4, 3e4, 3.5e4], also=[(0.3, mean, 350.0, 9e4)])
    (text,) = (note for note in line_dynamics(one, LEVELS).notes if "all amplitudes" in note)
    line, tested = loop(spring=3e4)[0], loop(spring=9e4)[0]
    shown = [f"{float(f'{one:.4g}'):.0f}" for one in (line, tested)]
    off = 100 * (line / tested - 1)
    assert f"C3 (0.3 Hz, +- 350 N) {' against '.join(shown)} N ({off:+.1f} percent)" in text
    alone = line_dynamics(rope_of_levels([2.5e4, 3e4, 3.5e4]), LEVELS)
    assert not any("all amplitudes" in note for note in alone.notes)


def test_the_growth_of_a_rope_tested_at_three_means_is_that_of_its_tests():
    """K_1 of 25, 30 and 35 kN at 1, 2 and 3 kN of mean: 5 N per N; another amplitude is left out."""
    one = rope_of_levels([2.5e4, 3e4, 3.5e4], also=[(0.3, 2500.0, 900.0, 9e4)])
    part = line_dynamics(one, LEVELS).part
    assert part.dynamic_stiffness_per_mean_tension == pytest.approx(5.0, rel=1e-6)
    assert part.fast_stiffness == pytest.approx(5e4, rel=1e-6)
    assert part.dynamic_stiffness == pytest.approx(4e4, rel=1e-6)
    two = line_dynamics(rope_of_levels([2.5e4, 3e4]), LEVELS).part
    assert two.dynamic_stiffness_per_mean_tension == 0
    assert "takes tests at 3 means with this frequency and amplitude" in two.growth


def test_notes_of_the_surfaces_go_along():
    one = source()
    one.surfaces["relaxation_time"] = replace(
        one.surfaces["relaxation_time"], notes=("the surface fails its F test",)
    )
    notes = line_from_lookup(one, levels=LEVELS).notes
    assert "relaxation_time: the surface fails its F test" in notes
    assert notes.count("wet") == 1


def test_a_mean_tension_is_needed():
    with pytest.raises(SettingsError, match="need a mean tension"):
        line_dynamics(source(), {"frequency": 0.3})


# intervals of K_1 and tau of an exported line against the line of scaled and shifted surfaces

CELL, CLOCK = Component("tension_gain", "cell"), Component("lag", "clock")
NAMES = ("quasi_static_spring_constant", "apparent_spring_constant", "hysteresis_energy")


def line(values, rows, sigma=0.0):
    """K_0, K_ap and H as flat surfaces; the rows are of the errors that all of them share."""
    one = source(curves=(), growth=0.0)
    surfaces = {}
    for name, value in zip(NAMES, values, strict=True):
        moved = {cause: found[name] for cause, found in rows.items()}
        table = np.zeros((len(moved), 10))
        table[:, 0] = list(moved.values())
        surfaces[name] = replace(
            surface(name, value, sigma=sigma * value), component=tuple(moved), contribution=table
        )
    return replace(one, surfaces=surfaces)


def found_half_widths(one):
    values = [look_up(one, name, **LEVELS) for name in NAMES]
    return _half_widths(identified(*(found.value for found in values)), *values)


def identified(rest, apparent, energy):
    return identify_by_amplitude(
        apparent_spring_constant=apparent, hysteresis_energy=energy, tension_amplitude=700.0,
        frequency=0.3, quasi_static_spring_constant=rest,
    )  # fmt: skip


VALUES = (REST, *loop())


def test_the_gain_of_one_load_cell_is_in_k_1_as_it_is_and_leaves_tau_alone():
    """At a true amplitude a cell that reads 1 % high makes H, an area over its square, 1 % low."""
    gain = dict(zip(NAMES, np.array([0.01, 0.01, -0.01]) * VALUES, strict=True))
    half = found_half_widths(line(VALUES, {CELL: gain}))
    assert half["dissipation_spring_constant"] == pytest.approx(1.96 * 0.01 * SPRING, rel=1e-6)
    assert half["relaxation_time"] == pytest.approx(0.0, abs=1e-9)
    assert half["dashpot_coefficient"] == pytest.approx(1.96 * 0.01 * SPRING * TIME, rel=1e-6)
    # as three errors, none of which knows the others, tau would not be left alone
    apart = {
        Component("tension_gain", name): {
            other: gain[name] * (other == name) for other in NAMES
        } for name in NAMES
    }  # fmt: skip
    assert found_half_widths(line(VALUES, apart))["relaxation_time"] > 0.03 * TIME


@pytest.mark.parametrize("shares", [(0.01, -0.004, 0.02), (0.0, 0.01, 0.0), (-0.02, 0.01, 0.01)])
def test_any_shared_error_moves_k_1_and_tau_as_another_line_would_have_them(shares):
    step = 1e-4
    rows = dict(zip(NAMES, step * np.array(shares) * VALUES, strict=True))
    half = found_half_widths(line(VALUES, {CLOCK: rows}))
    ends = [
        identified(*(np.array(VALUES) * (1 + side * step * np.array(shares)))) for side in (1, -1)
    ]
    for name, value in half.items():
        moved = abs(getattr(ends[0], name) - getattr(ends[1], name)) / 2
        assert value == pytest.approx(1.96 * moved, rel=1e-4, abs=1e-12)


def test_what_is_of_each_surface_alone_is_added_as_squares_with_that_of_k_0():
    half = found_half_widths(line(VALUES, {}, sigma=0.001))
    own = look_up(line(VALUES, {}, sigma=0.001), NAMES[1], **LEVELS)
    share = float((own.surface_high - own.value) / own.value)
    squares = 0.0
    for place in range(3):
        ends = []
        for side in (1, -1):
            values = list(VALUES)
            values[place] *= 1 + side * 1e-5
            ends.append(float(identified(*values).relaxation_time))
        squares += ((ends[0] - ends[1]) / 2e-5 * share) ** 2
    assert half["relaxation_time"] == pytest.approx(np.sqrt(squares), rel=1e-4)


def test_the_deck_says_how_well_they_are_known():
    gain = dict(zip(NAMES, np.array([0.01, 0.01, -0.01]) * VALUES, strict=True))
    notes = line_dynamics(line(VALUES, {CELL: gain}), LEVELS).notes
    assert "; 95 percent of K_1 +-588 N, of tau +-" in notes[0]
    rest = LineCurve(NAMES[0], "mean_tension", 0.0, 4000.0, coefficient=np.array([REST]))
    exact = line(VALUES, {}, sigma=0.001)
    del exact.surfaces[NAMES[0]]
    notes = line_dynamics(replace(exact, curves=(rest,)), LEVELS).notes
    assert notes[0].endswith("K_0 taken as exact: it has no interval")
    unknown = line(VALUES, {}, sigma=np.nan)
    assert line_dynamics(unknown, LEVELS).notes[0].endswith("and so have K_1 and tau none")

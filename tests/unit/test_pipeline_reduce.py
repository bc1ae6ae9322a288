"""One test from its located record to its product."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reduction.archive.test_dataset import _sample_values
from reduction.pipeline.cyclic_test import _compare_specimens, notes_on_jumps
from reduction.pipeline.located_test import locate
from reduction.pipeline.reduce_test import reduce_test
from reduction.record.contributions import InstrumentErrors
from reduction.record.errors import DataError
from reduction.record.measurement import Quality, Record, Specimen
from reduction.record.row_counts import notes_on_rows
from reduction.record.settings import CycleSettings, ReductionSettings
from reduction.stages.moduli.modulus_product import ModulusCurves
from reduction.stages.reduced_test import History, TestDescription
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.strain.zero_strain import jumps_of_length

DIAMETER = 0.025
SPIKE = 700


def reduced(specimen, load_cell=2.0, zero=1.0, preload=0.0):
    """A slow pull of a linear cord, slack at first, with one spike of 5 kN in its tension."""
    time = np.arange(0, 120, 0.1)
    position = 1 + np.interp(time, [0, 20, 120], [0, 0, 0.5])
    noise = np.random.default_rng(7)
    tension = preload + 400 * (position - 1) + noise.normal(0, 0.2, time.size)
    tension[SPIKE] = 5000
    flags = np.zeros((1, time.size), dtype=np.uint16)
    flags[0, SPIKE] = Quality.SPIKE
    record = Record(
        test_id="Q-1",
        specimens=("cord",),
        time=time,
        crosshead_position=position,
        tension=tension[None],
        quality_flag=flags,
        crosshead_position_quality_flag=np.zeros(time.size, dtype=np.uint16),
        tension_standard_uncertainty=(load_cell,),
    )
    settings = ReductionSettings()
    return reduce_test(
        locate(record, kind="quasi-static", settings=settings),
        description=TestDescription("c", "Q-1", "quasi-static", "position", "triangular", 1, {}),
        specimens=(specimen,),
        models=(
            StrainModel("cord", "gauge-length", {"gauge_length": 1.0, "reference_position": zero}),
        ),
        history=None,
        sources=(),
        settings=settings,
        settings_json="{}",
    )


@pytest.fixture(scope="module")
def pulled():
    return reduced(Specimen("cord", kind="elastomer", diameter=(DIAMETER,)))


def test_stress_is_tension_over_the_area_at_zero_tension(pulled):
    area = np.pi * DIAMETER**2 / 4
    usable = np.arange(pulled.record.n_samples) != SPIKE
    expected = pulled.record.tension[0, usable] / area
    stress = _sample_values(pulled, pulled.record)["nominal_stress"]
    np.testing.assert_allclose(stress[0, usable], expected, rtol=1e-12)
    np.testing.assert_allclose(pulled.nominal_stress_standard_uncertainty, [2.0 / area])


def test_a_spike_stays_in_the_record_and_gives_no_stress(pulled):
    assert pulled.record.tension[0, SPIKE] == 5000
    stress = _sample_values(pulled, pulled.record)["nominal_stress"]
    assert np.isnan(stress[0, SPIKE])
    assert np.nanmax(stress) < 0.5e6


def test_a_rope_without_a_diameter_has_no_stress():
    found = reduced(Specimen("cord", kind="rope"))
    assert "nominal_stress" not in _sample_values(found, found.record)
    assert found.nominal_stress_standard_uncertainty is None


def test_a_first_rise_that_stretches_nothing_gives_no_law_and_says_why():
    cord = Specimen("cord", kind="elastomer", diameter=(DIAMETER,))
    found = reduced(cord, zero=1.6)
    assert found.elastomers == ()
    (note,) = [text for text in map(str, found.notes) if "hyperelastic" in text]
    assert note.startswith("cord: no hyperelastic law: the first rise of the record is not a pull")
    assert "(strain reaches -1" in note and "the zero of strain" in note


@pytest.mark.parametrize(
    ("kind", "preload", "is_given"),
    [("other", 30.0, True), ("other", 100.0, False), ("elastomer", 30.0, False)],
)
def test_a_coupon_may_be_pulled_from_a_preload_and_rubber_may_not(kind, preload, is_given):
    # synthetic: of 200 N and the preload; what rubber does at a strain needs its first stretch
    found = reduced(Specimen("cord", kind=kind, diameter=(DIAMETER,)), preload=preload)
    assert (found.first_loading is not None) is is_given


def test_the_gauge_length_is_the_relaxed_length_of_a_pull(pulled):
    assert pulled.pulls[0].reference_length == 1.0
    assert not any("length at which strain is zero" in note for note in map(str, pulled.notes))


def test_the_cubic_of_a_hose_stands_where_it_fits():
    hose = reduced(Specimen("cord", kind="stretch hose", diameter=(DIAMETER,)))
    assert hose.pulls[0] is not None
    assert hose.first_loading is not None
    assert hose.elastomers == () and hose.stress_at_strain is None


def test_a_hose_without_a_diameter_has_tensions_and_no_stress():
    hose = reduced(Specimen("cord", kind="stretch hose"))
    assert "nominal_stress" not in _sample_values(hose, hose.record) and hose.pulls[0] is not None
    assert any("no diameter or area is stated" in note for note in map(str, hose.notes))


def test_cycles_of_two_sines_say_so_and_have_no_loss():
    time = np.arange(0, 120, 0.05)
    wave = np.sin(0.2 * np.pi * time) + 0.3 * np.sin(0.74 * np.pi * time)
    zeros = np.zeros((1, time.size), dtype=np.uint16)
    record = Record(
        "C-1", ("cord",), time, 1.3 + 0.1 * wave, 400 * (0.3 + 0.1 * wave)[None], zeros, zeros[0]
    )
    settings = ReductionSettings()
    test = reduce_test(
        locate(record, kind="cyclic", settings=settings),
        description=TestDescription("c", "C-1", "cyclic", "position", "sinusoidal", 1, {}),
        specimens=(Specimen("cord", kind="elastomer", diameter=(DIAMETER,)),),
        models=(
            StrainModel("cord", "gauge-length", {"gauge_length": 1.0, "reference_position": 1.0}),
        ),
        history=None, sources=(), settings=settings, settings_json="{}",
    )  # fmt: skip
    (note,) = [one for one in test.loop_notes if one.code == "wave-not-periodic"]
    assert note.severity == "warning" and "Its energy and loss are not given" in str(note)
    assert np.isnan(test.loops.hysteresis_energy).all()
    np.testing.assert_allclose(test.amplitude.apparent_spring_constant, [400], rtol=0.01)


@pytest.mark.parametrize(("late", "most"), [(0.0, 1.0), (0.7, 3.0)])
def test_corners_out_of_step_cancel_in_a_spring_constant_whatever_the_lag(late, most):
    """A linear cord, ten readings a ramp, no stated lag: corners lie anywhere between readings."""
    at = np.arange(800.0)
    both = (1 - 4 * np.abs((at - on) / 20.3 % 1 - 0.5) for on in (0.0, late))
    position, tension = (1.3 + 0.1 * next(both)), 400 * (0.3 + 0.1 * next(both))
    zeros = np.zeros((1, at.size), dtype=np.uint16)
    settings = ReductionSettings()
    test = reduce_test(
        locate(
            Record("C-1", ("cord",), at / 10, position, tension[None], zeros, zeros[0]),
            kind="cyclic", settings=settings,
        ),
        description=TestDescription("c", "C-1", "cyclic", "position", "triangular", 1, {}),
        specimens=(Specimen("cord", kind="elastomer", diameter=(DIAMETER,)),),
        models=(
            StrainModel("cord", "gauge-length", {"gauge_length": 1.0, "reference_position": 1.0}),
        ),
        history=None, sources=(), settings=settings, settings_json="{}",
    )  # fmt: skip
    (error,) = test.amplitude.apparent_spring_constant - 400
    (stated,) = test.amplitude.uncertainty["apparent_spring_constant"]
    # corners rounded apart from each other would make it 10 N
    assert abs(error) < 2 * stated < 2 * most


@pytest.mark.parametrize("step", [0.0, 20.0, -20.0])
def test_a_zero_that_moves_while_the_machine_stands_is_told_and_in_the_mean_tension(step):
    """Sixteen cycles of 4 s, 6 s at the valley, sixteen more: 400 N a unit strain, 120 +- 60 N."""
    time = np.arange(0, 144, 0.05)
    at = np.where(time < 69, np.clip(time - 5, 0, 64), np.maximum(time - 11, 64))
    strain = np.interp(time, [0, 2, 5], [0, 0, 1]) * (
        0.3 - 0.15 * np.cos(np.pi * np.minimum(at, 128) / 2)
    )
    tension = 400 * strain + step * (time > 72) + np.random.default_rng(3).normal(0, 0.1, time.size)
    zeros = np.zeros((1, time.size), dtype=np.uint16)
    record = Record("C-2", ("cord",), time, 1 + strain, tension[None], zeros, zeros[0])
    settings = ReductionSettings()
    test = reduce_test(
        locate(record, kind="cyclic", settings=settings),
        description=TestDescription("c", "C-2", "cyclic", "position", "sinusoidal", 1, {}),
        specimens=(Specimen("cord", kind="elastomer", diameter=(DIAMETER,)),),
        models=(
            StrainModel("cord", "gauge-length", {"gauge_length": 1.0, "reference_position": 1.0}),
        ),
        history=None, sources=(), settings=settings, settings_json="{}",
        instruments=(InstrumentErrors("cord", tension_instrument="A"),),
    )  # fmt: skip
    told = [one for one in test.loop_notes if one.code == "zero-moves-at-stop"]
    assert [round(one.numbers["size"]) for one in told] == ([step] if step else [])
    assert test.amplitude.mean_tension[0] == pytest.approx(120 + step / 2, abs=1)
    if step:
        shared = test.contributions.shared_standard_uncertainty("test_mean_tension")
        np.testing.assert_allclose(shared, 20 / np.sqrt(3), rtol=0.02)


# which channel says where a test is held, and which samples count there


def record(repeats=False):
    """Rest, ramp, a hold at 300 N in which the crosshead creeps."""
    time = np.arange(0, 300, 0.5)
    load = np.interp(time, [0, 20, 40, 300], [0, 0, 300, 300])
    noise = np.random.default_rng(2)
    position = 1 + load / 1000 + 0.02 * np.log10(1 + np.clip(time - 40, 0, None))
    flags = np.zeros((1, time.size), dtype=np.uint16)
    if repeats:
        flags[0, time >= 40] = Quality.STUCK | Quality.SATURATED
        flags[0, 5:60] = Quality.STUCK
    else:
        load = load + noise.normal(0, 0.2, time.size)
    logged = Record(
        test_id="A",
        specimens=("cord",),
        time=time,
        crosshead_position=position + noise.normal(0, 0.0002, time.size),
        tension=load[None],
        quality_flag=flags,
        crosshead_position_quality_flag=np.zeros(time.size, dtype=np.uint16),
    )
    return replace(logged, notes=tuple(notes_on_rows(logged)))


@pytest.mark.parametrize(
    ("kind", "control", "on_tension"),
    [
        ("creep", "position", True),
        ("creep", "load", True),
        ("quasi-static", "load", True),
        ("quasi-static", "position", False),
        ("relaxation", "position", False),
        ("relaxation", "load", False),
    ],
)
def test_creep_and_load_control_are_held_on_tension_and_relaxation_never(kind, control, on_tension):
    settings = ReductionSettings(cycles=CycleSettings(control=control))
    found = locate(record(), kind=kind, settings=settings).standstills
    assert (found.tension_tolerance is not None) is on_tension
    assert (found.start_time == 40).any() == on_tension


@pytest.mark.parametrize("kind", ["creep", "quasi-static"])
def test_a_load_controller_that_hunts_breaks_no_hold(kind):
    # 0.6 % of the load, about every 7 s
    one = record()
    hunting = np.random.default_rng(0).normal(0, 0.006, 45)
    load = one.tension * (1 + np.interp(one.time, 7 * np.arange(45), hunting))
    settings = ReductionSettings(cycles=CycleSettings(control="load"))
    found = locate(replace(one, tension=load), kind=kind, settings=settings).standstills
    assert found.start_time[1:] == pytest.approx([40], abs=1)
    assert found.end_time[1:] == pytest.approx([299.5])


def test_a_load_that_repeats_one_value_in_a_hold_of_it_is_no_fault():
    located = locate(record(repeats=True), kind="creep", settings=ReductionSettings())
    assert located.standstills.mean_tension[0, -1] == pytest.approx(300)
    assert np.isfinite(located.tension[0, 80:]).all()
    flags = located.record.quality_flag[0]
    assert not flags[80:].any()
    # at rest the flag stays: nothing is held there
    assert (flags[5:30] == Quality.STUCK).all()
    rows, freed = map(str, located.record.notes)
    assert "flagged, of 600 rows: tension of cord stuck 55. Saturated" in rows
    assert "520 samples in holds at constant tension repeat one value" in freed
    still = locate(record(repeats=True), kind="relaxation", settings=ReductionSettings())
    assert np.isnan(still.tension[0, 80:]).all()


def test_rests_of_a_load_that_creep_are_no_fault_and_clipped_peaks_are():
    time = np.arange(0, 40, 0.01)
    # rests of 1 s, in which strain lags behind; and a load cell that ends at 0.9 of the amplitude
    load = np.interp(time % 4, [0, 1, 2, 3, 4], [0, 1, 1, 0, 0])
    lags = load + 0.1 * np.convolve(load, 0.02 * np.exp(-time / 0.5))[: time.size]
    sine = np.sin(2 * np.pi * time / 4)
    for tension, position, is_fault in ((load, lags, False), (np.minimum(sine, 0.9), sine, True)):
        is_top = tension == tension.max()
        logged = Record(
            "A", ("cord",), time, 1 + 0.01 * position, (1000 + 500 * tension)[None],
            np.where(is_top, Quality.SATURATED, 0).astype(np.uint16)[None],
            np.zeros(time.size, dtype=np.uint16),
        )  # fmt: skip
        settings = ReductionSettings(cycles=CycleSettings(control="load", waveform="other"))
        kept = locate(logged, kind="quasi-static", settings=settings).record.quality_flag[0]
        np.testing.assert_array_equal(kept != 0, is_top & is_fault)


def test_a_kind_that_is_not_reduced_is_refused():
    with pytest.raises(DataError, match="of a kind that this version does not reduce"):
        locate(record(), kind="stepwise", settings=ReductionSettings())


# what is said where the mean of the cycles jumps

N_CYCLES = 60


def loops_of(strain, stiffness):
    """Cycles of 100 to 300 N in load control, with a strain and a stiffness each."""
    noise = np.random.default_rng(5)
    amplitude = 100.0 / stiffness
    return SimpleNamespace(
        cycle_start_time=10.0 * np.arange(N_CYCLES)[None],
        mean_strain=(strain + noise.normal(0, 1e-5, N_CYCLES))[None],
        mean_tension=(200 + noise.normal(0, 0.05, N_CYCLES))[None],
        apparent_spring_constant=stiffness[None],
        strain_amplitude=amplitude[None],
        tension_amplitude=np.full((1, N_CYCLES), 100.0),
    )


@pytest.mark.parametrize(
    ("left", "code"), [(1.0, "strain-jumps"), (0.79, "stiffness-changes-at-cycle")]
)
def test_a_slip_leaves_the_stiffness_and_a_strand_takes_some_of_it(left, code):
    is_after = np.arange(N_CYCLES) >= 40
    stiffness = np.where(is_after, left, 1.0) * 5000.0
    (found,) = notes_on_jumps(loops_of(0.1 + 0.02 * is_after, stiffness), ["line"], break_in=0)
    assert found.code == code and found.numbers["number"] == 40
    if left < 1:
        assert found.numbers["change"] == pytest.approx(left - 1)


@pytest.mark.parametrize("larger", [1.5, 0.6])
def test_another_amplitude_is_no_slip(larger):
    is_after = np.arange(N_CYCLES) >= 40
    loops = loops_of(0.1 - 0.002 * is_after, np.full(N_CYCLES, 5000.0))
    assert notes_on_jumps(loops, ["line"], break_in=0)
    for one in (loops.strain_amplitude, loops.tension_amplitude):
        one[0, is_after] *= larger
    assert not notes_on_jumps(loops, ["line"], break_in=0)


# specimens of one test side by side: each against the first, and what makes them unequal


def curves(*moduli):
    strain = np.array([1.0, 1.1, 1.2])
    modulus = np.array(moduli)[:, None, None] * np.ones((len(moduli), 2, 3))
    blank = dict.fromkeys(ModulusCurves.__dataclass_fields__, np.zeros(modulus.shape))
    return ModulusCurves(
        **blank
        | {
            "strain_bin": strain,
            "strain_bin_bounds": np.stack([strain - 0.05, strain + 0.05], axis=1),
            "tangent_modulus": modulus,
            "tangent_modulus_count": np.full(modulus.shape, 10),
            "tangent_modulus_standard_uncertainty": 0.01 * modulus,
            "notes": (),
        }
    )


def history(strain, cycles):
    n = len(strain)
    nothing = np.full(n, np.nan)
    return History(
        (("T-0",),) * n,
        np.array(strain),
        nothing,
        np.array(cycles),
        nothing,
        nothing,
        nothing,
        0 * nothing,
    )


def remarks(first, other, past):
    (ratio,) = _compare_specimens(curves(1e6, 1e6), (first, other), past)
    return [note for note in map(str, ratio.notes) if note.startswith("ratio b/a: ")]


def test_three_specimens_give_two_ratios_over_the_first():
    three = tuple(Specimen(name) for name in "abc")
    found = _compare_specimens(curves(1e6, 2e6, 0.5e6), three, history([1.0] * 3, [10.0] * 3))
    assert [(one.numerator, one.denominator) for one in found] == [("b", "a"), ("c", "a")]
    assert [float(one.ratio[0, 0]) for one in found] == pytest.approx([2.0, 0.5])
    assert all(one.notes == () for one in found)


def test_unequal_flexing_is_named_and_softening_is_said_of_rubber_alone():
    past = replace(history([1.0, 1.3], [10.0, 10.0]), earlier_flex_cycles=np.array([1e6, np.nan]))
    hoses = (Specimen("a", kind="stretch hose"), Specimen("b", kind="stretch hose"))
    found = remarks(*hoses, past)
    assert found == [
        "ratio b/a: different test histories: not known against 1000000 earlier flex cycles",
        "ratio b/a: different test histories: maximum earlier strain 130 % against 100 %",
    ]
    assert remarks(Specimen("a"), Specimen("b"), past)[-1].endswith(
        "rubber is softer below what it has seen"
    )
    alike = replace(past, earlier_flex_cycles=np.full(2, np.nan), earlier_maximum_strain=np.ones(2))
    assert remarks(*hoses, alike) == []


def test_one_specimen_is_compared_with_nothing():
    assert _compare_specimens(curves(1e6), (Specimen("a"),), None) == []


def test_equal_histories_leave_nothing_to_say():
    equal = history([1.28, 1.30], [10.0, 10.0])
    assert remarks(Specimen("a"), Specimen("b"), equal) == []
    first = history([np.nan, np.nan], [0.0, 0.0])
    assert remarks(Specimen("a"), Specimen("b"), first) == []


@pytest.mark.parametrize(
    ("past", "told"),
    [
        (history([1.2, 1.2], [10.0, 30.0]), "30 earlier cycles against 10"),
        (history([1.2, 1.8], [10.0, 10.0]), "maximum earlier strain 180 % against 120 %"),
        (history([np.nan, 1.8], [0.0, 0.0]), "maximum earlier strain 180 % against none known"),
        (None, "is not known: no order is given"),
    ],
)
def test_unequal_or_unknown_histories_are_told(past, told):
    (said,) = remarks(Specimen("a"), Specimen("b"), past)
    assert told in said


def test_another_condition_before_the_campaign_is_an_unequal_history():
    equal = history([1.2, 1.2], [10.0, 10.0])
    told = remarks(Specimen("a", condition="new"), Specimen("b", condition="used"), equal)
    assert told[0] == "ratio b/a: the conditions before the campaign differ: 'used' against 'new'"
    told = remarks(Specimen("a"), Specimen("b", condition="used"), equal)
    assert "'used' against not stated" in told[0]


@pytest.mark.parametrize(("taken_off", "n_jumps"), [(True, 1), (False, 0)])
def test_an_extensometer_that_is_taken_off_while_the_machine_waits_is_a_jump(taken_off, n_jumps):
    """The logger waits too, and the load relaxes by 4 % meanwhile; or the gauge stays on."""
    time = np.append(np.arange(300) / 10, 60 + np.arange(200) / 10)
    load = np.interp(time, [0, 29.9, 60, 80], [0, 7000, 6700, 7700])
    strain = np.where(time < 45, load / 7000 * 0.04, -0.13 if taken_off else 0.0402)
    assert len(jumps_of_length(time, strain, load, slack_tension=20.0)) == n_jumps

"""One test from its located record to its product."""

import numpy as np
import pytest

from reduction.archive.test_dataset import _sample_values
from reduction.pipeline.located_test import locate
from reduction.pipeline.reduce_test import reduce_test
from reduction.record.contributions import InstrumentErrors
from reduction.record.measurement import Quality, Record, Specimen
from reduction.record.settings import ReductionSettings
from reduction.stages.reduced_test import TestDescription
from reduction.stages.strain.strain_model import StrainModel

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

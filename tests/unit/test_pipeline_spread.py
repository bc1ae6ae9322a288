"""Unit tests of reduction.pipeline.reduce_test; expected values from the derivatives by hand."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reduction.pipeline.reduce_test import (
    _channel_contributions,
    _reading_spread,
    _readings_of,
    _with_readings,
)
from reduction.quantities.flags import PHASE_VALUES
from reduction.record.contributions import InstrumentErrors
from reduction.record.measurement import Record, Specimen
from reduction.stages.strain.strain_model import StrainModel

# slope of strain on the gauge length is -(p - p0) / L0^2: it depends on the sample
MODEL = StrainModel(
    "rope",
    "gauge-length",
    {"reference_position": 0.0, "gauge_length": 1.0},
    np.diag([0.0, 0.01**2]),
)
BARE = replace(MODEL, covariance=np.empty((0, 0)))
POSITION = np.array([0.0, 0.1, 0.3, 0.4, 0.9])
TENSION = np.array([0.0, 100.0, 300.0, 400.0, 900.0])
REST, CYCLING, HOLD = (PHASE_VALUES[name] for name in ("rest", "cycling", "hold"))
PHASE = np.array([REST, HOLD, CYCLING, CYCLING, REST], dtype=np.int8)
RMS = np.sqrt((0.3**2 + 0.4**2) / 2)
ROPE = Specimen("rope", diameter=(0.02,))
AREA = np.pi * 0.01**2


def record(of_tension=(), of_position=np.nan):
    return Record(
        "T", ("rope",), np.arange(5.0), POSITION, TENSION[None],
        np.zeros((1, 5), np.uint16), np.zeros(5, np.uint16), n_rows_read=5,
        tension_standard_uncertainty=of_tension, position_standard_uncertainty=of_position,
    )  # fmt: skip


def located():
    return SimpleNamespace(record=record(), position=POSITION, tension=TENSION[None])


def contributions(errors, model=MODEL, phase=PHASE):
    found = _channel_contributions(
        located(), POSITION[None], [model], [ROPE], [errors], phase=phase
    )
    sources = [one.source for one in found.component]
    return {
        name: dict(zip(sources, rows.reshape(len(sources)), strict=True))
        for name, rows in found.values.items()
    }


def test_a_layout_says_what_one_reading_is_good_to_and_the_campaign_the_rest():
    stated = InstrumentErrors(
        "rope", tension_gain=0.01, tension_offset=2.0, tension_reading=3.0, position_reading=4e-3
    )
    (found,) = _readings_of(record(of_tension=(0.5,)), [stated])
    assert (found.tension_reading, found.position_reading) == (0.5, 4e-3)
    assert (found.tension_gain, found.tension_offset) == (0.01, 2.0)
    (found,) = _readings_of(record(of_position=1e-3), [stated])
    assert (found.tension_reading, found.position_reading) == (3.0, 1e-3)


def test_without_a_campaign_s_word_the_layout_stands_alone():
    (found,) = _readings_of(record(of_tension=(0.5,)), ())
    assert (found.specimen, found.tension_reading, found.tension_gain) == ("rope", 0.5, 0.0)


def test_the_record_says_what_one_reading_is_good_to_whoever_said_it():
    kept = _with_readings(record(), [InstrumentErrors("rope", tension_reading=3.0)])
    assert kept.tension_standard_uncertainty == (3.0,)
    assert np.isnan(kept.position_standard_uncertainty)
    # a gain is no error of one reading
    kept = _with_readings(record(), [InstrumentErrors("rope", tension_gain=0.01)])
    assert kept.tension_standard_uncertainty == ()


def test_a_reading_counts_by_the_slope_of_strain_on_position():
    errors = InstrumentErrors("rope", position_reading=0.003)
    assert _reading_spread(located(), [MODEL], [errors], phase=PHASE) == pytest.approx([0.003])


def test_readings_of_both_channels_add_as_squares_through_the_splices():
    law = {
        "relaxed_free_length": 2.5, "relaxed_splice_length": 1.2, "splice_compliance": 0.0012,
        "splice_exponent": 0.85,
    }  # fmt: skip
    model = StrainModel("tether", "tension-driven", law)
    phase = np.array([REST, REST, REST, CYCLING, REST], dtype=np.int8)
    slope = 1.2 * 0.0012 * 0.85 * 400.0 ** (0.85 - 1) / 2.5
    errors = InstrumentErrors("tether", position_reading=0.002, tension_reading=2.0)
    expected = np.hypot(0.002 / 2.5, slope * 2.0)
    assert _reading_spread(located(), [model], [errors], phase=phase) == pytest.approx([expected])


@pytest.mark.parametrize(
    ("model", "errors"),
    [
        (MODEL, InstrumentErrors("rope")),
        (StrainModel("rope", "extensometer"), InstrumentErrors("rope", position_reading=0.1)),
    ],
)
def test_a_reading_of_which_nothing_is_known_is_not_exact(model, errors):
    assert np.isnan(_reading_spread(located(), [model], [errors], phase=PHASE)).all()


def test_shared_errors_of_strain_are_root_mean_squares_over_the_cycles_with_their_sign():
    found = contributions(InstrumentErrors("rope", position_gain=0.02, strain_gain=0.05))["strain"]
    assert found["strain_calibration"] == pytest.approx(-0.01 * RMS, rel=1e-6)
    assert found["position_gain"] == pytest.approx(0.02 * RMS, rel=1e-6)
    assert found["strain_gain"] == pytest.approx(0.05 * RMS, rel=1e-6)


def test_a_test_without_cycles_takes_all_but_the_rests():
    phase = np.array([REST, HOLD, HOLD, HOLD, REST], dtype=np.int8)
    found = contributions(InstrumentErrors("rope"), phase=phase)["strain"]
    expected = 0.01 * np.sqrt((0.1**2 + 0.3**2 + 0.4**2) / 3)
    assert found["strain_calibration"] == pytest.approx(-expected, rel=1e-6)


def test_channels_have_gain_and_zero_and_stress_the_diameter_besides():
    found = contributions(
        InstrumentErrors(
            "rope", tension_gain=0.01, tension_offset=5.0, position_gain=0.02,
            position_offset=0.003, diameter=1e-4, stiffness=0.04, lag=0.1,
        ),
        BARE,
    )  # fmt: skip
    tension = {one: row for one, row in found["tension"].items() if row}
    assert tension == pytest.approx({"tension_gain": 10.0 * RMS, "tension_offset": 5.0})
    position = {one: row for one, row in found["crosshead_position"].items() if row}
    assert position == pytest.approx({"position_gain": 0.02 * RMS, "position_offset": 0.003})
    stress = {one: row for one, row in found["nominal_stress"].items() if row}
    assert stress == pytest.approx(
        {
            "tension_gain": 10.0 * RMS / AREA,
            "tension_offset": 5.0 / AREA,
            "diameter": -2 * 1e-4 / 0.02 * 1000.0 * RMS / AREA,
        }
    )


def test_nothing_stated_is_no_contribution():
    assert (
        _channel_contributions(located(), POSITION[None], [BARE], [ROPE], (), phase=PHASE).component
        == ()
    )
    assert contributions(InstrumentErrors("rope"), BARE)["strain"] == {}

"""Tape readings against the crosshead, and strain that no specimen has."""

import numpy as np
import pytest
from refusals import refusals

from reduction.record.errors import DataError
from reduction.record.measurement import MarkPlace, SpliceMarks
from reduction.stages.standstills import Standstills
from reduction.stages.strain.tape_and_crosshead import UNITS, check_tape_against_crosshead
from reduction.stages.strain.zero_strain import zero_at_tension

SLACK, HOLDS = 3.74, np.array([5.90, 6.63, 7.35])


def check(tape, *, unit="m", holds=HOLDS, rest=SLACK, reach=(3.74, 7.36), slack=SLACK, u=0.0):
    """Marks at slack and at three holds, by a tape; all in metres."""
    places = np.append(rest, holds)
    n = places.size
    stands = Standstills(
        first=np.arange(n), last=np.arange(n), start_time=np.arange(n) * 1.0,
        end_time=np.arange(n) * 1.0, mean_position=places, mean_tension=np.zeros((1, n)),
        is_rest=np.arange(n) == 0, position_tolerance=0.01, slack_tension=5.0,
    )  # fmt: skip
    far = np.append(slack, tape)
    marks = SpliceMarks(
        "new", ("T-1",) * far.size, ("slack", "min", "centre", "max")[: far.size],
        near_toe=0.1 * far, far_toe=0.9 * far, far_thimble=far, reading_uncertainty=0.001,
        place=tuple(
            MarkPlace("marks.csv", row, f"far_thimble_{unit}") for row in range(2, 2 + far.size)
        ),
    )  # fmt: skip
    position = np.concatenate([[np.nan], holds, reach])
    return check_tape_against_crosshead(
        marks, test_id="T-1", standstills=stands, position=position, position_uncertainty=u
    )


def test_a_tape_that_agrees_says_nothing():
    assert check(HOLDS + np.array([0.003, -0.002, 0.001])) == ()


@pytest.mark.parametrize("meant", UNITS)
@pytest.mark.parametrize("written", UNITS)
def test_every_unit_that_was_meant_is_named(meant, written):
    if meant == written:
        return
    factor = UNITS[written] / UNITS[meant]
    with pytest.raises(DataError, match=f"is the header far_thimble_{meant}\\?") as raised:
        check(factor * HOLDS, unit=written, slack=factor * SLACK)
    assert str(raised.value).startswith(f"marks.csv:3 [far_thimble_{written}]: ")
    assert "the crosshead at 5.9 m" in str(raised.value)


@pytest.mark.parametrize(("of_log", "stated"), [("ft", "m"), ("mm", "m"), ("in", "ft")])
def test_a_crosshead_in_another_unit_than_stated_is_named(of_log, stated):
    factor = UNITS[stated] / UNITS[of_log]
    with pytest.raises(DataError, match=f"as {of_log} stated as {stated} would be") as raised:
        check(HOLDS, holds=factor * HOLDS, rest=factor * SLACK, reach=(factor * 3.7, factor * 7.4))
    assert f"the crosshead at {factor * HOLDS[0]:.4g} m" in str(raised.value)


def test_readings_that_would_be_shorter_than_the_allowance_fit_no_unit():
    """A load of 0 to 130 lbf stands in the column of the position: 5.9 mm is near its zero."""
    with pytest.raises(DataError) as raised:
        check(HOLDS, holds=np.array([0.04, 26.0, 33.0]), rest=0.0, reach=(8.0, 40.0))
    assert "far_thimble_mm" not in str(raised.value)
    assert "column, unit and zero of crosshead_position" in str(raised.value)


def test_marks_that_were_read_before_the_log_began_contradict_nothing():
    # cycles between 5 and 6.5 m: the set-up is not in the log
    assert check(HOLDS, holds=np.empty(0), reach=(5.0, 6.5)) == ()
    assert check(HOLDS, holds=np.array([5.0]), reach=(5.0, 6.5)) == ()


def test_a_small_shift_is_said_unless_the_crosshead_is_stated_to_be_so_uncertain():
    (found,) = check(HOLDS - 0.03, slack=SLACK - 0.03)
    assert (found.code, found.severity) == ("tape-off-crosshead", "warning")
    assert found.numbers["apart"] == pytest.approx(0.03)
    assert check(HOLDS - 0.03, slack=SLACK - 0.03, u=0.01) == ()


@pytest.mark.parametrize(
    ("moment", "is_off"), [(0.0, False), (0.6, False), (1.0, False), (1.5, True)]
)
def test_a_tape_that_was_read_while_the_specimen_crept_at_a_held_load_is_not_off(moment, is_off):
    """Each hold creeps by 40 mm, as a tether does at a held load."""
    n, creep = 101, 0.04
    of_hold = creep * np.linspace(-0.5, 0.5, n)
    stands = Standstills(
        first=np.arange(3) * n, last=np.arange(1, 4) * n - 1, start_time=np.arange(3) * 30.0,
        end_time=np.arange(3) * 30.0 + 29, mean_position=HOLDS, mean_tension=np.ones((1, 3)),
        is_rest=np.zeros(3, dtype=bool), position_tolerance=creep, slack_tension=0.5,
    )  # fmt: skip
    far = np.append(SLACK, HOLDS + creep * (moment - 0.5))
    marks = SpliceMarks(
        "new", ("T-1",) * 4, ("slack", "min", "centre", "max"),
        near_toe=0.1 * far, far_toe=0.9 * far, far_thimble=far, reading_uncertainty=0.001,
    )  # fmt: skip
    found = check_tape_against_crosshead(
        marks, test_id="T-1", standstills=stands, position=(HOLDS[:, None] + of_hold).ravel()
    )
    assert bool(found) is is_off


def test_a_slack_specimen_hangs_but_does_not_reach_farther_than_it_is_long():
    assert check(HOLDS, rest=3.5) == ()
    with pytest.raises(DataError, match=r"hold slack; .*the crosshead at 4 m without tension"):
        check(HOLDS, rest=4.0)


class TestZeroAtTension:
    PLACE = np.concatenate([np.linspace(0, 1, 1001), np.linspace(1, 0.2, 801)])

    def test_the_first_rise_counts_and_not_what_a_later_cycle_has(self):
        load = 2e4 * np.maximum(self.PLACE - 0.1, 0)
        load[1001:] = 2e4 * np.maximum(self.PLACE[1001:] - 0.19, 0)  # lengthened since
        zero = zero_at_tension(self.PLACE, load, reference_tension=400.0)
        assert zero.position == pytest.approx(0.12, abs=1e-9)
        assert zero.compliance == pytest.approx(5e-5)

    def test_noise_is_in_its_uncertainty(self):
        generator, found = np.random.default_rng(2), []
        load = 2e4 * np.maximum(self.PLACE - 0.1, 0)
        for _ in range(200):
            noisy = load + generator.normal(0, 20, load.size)
            zero = zero_at_tension(self.PLACE, noisy, reference_tension=1000.0)
            found.append((zero.position - 0.15) / zero.standard_uncertainty)
        assert abs(np.mean(found)) < 0.5
        assert np.std(found) == pytest.approx(1.0, abs=0.25)

    @pytest.mark.parametrize("noise", [2.0, 20.0, 100.0])
    def test_a_slow_rise_places_it_within_its_noise(self, noise):
        """Four readings in the band, or noise that reaches slack: 1 mm or 20 N to a reading."""
        generator, off = np.random.default_rng(3), []
        load = 2e4 * np.maximum(self.PLACE - 0.1, 0)
        for _ in range(200):
            noisy = load + generator.normal(0, noise, load.size)
            place = self.PLACE + generator.normal(0, 5e-5, load.size)
            zero = zero_at_tension(place, noisy, reference_tension=250.0)
            off.append((zero.position - 0.1125) / zero.standard_uncertainty)
        # 10 u before, always too short, at 100 N
        assert np.sqrt(np.mean(np.square(off))) < 1.5

    def test_a_log_that_begins_at_the_tension_begins_at_zero_strain(self):
        place = np.concatenate([np.full(100, 0.3), np.linspace(0.3, 1, 701)])
        zero = zero_at_tension(place, 1e4 * (place - 0.2), reference_tension=1000.0)
        assert zero.position == pytest.approx(0.3, abs=1e-9)

    def test_above_it_the_layout_counts_or_nothing(self):
        load = 2e4 * (self.PLACE + 0.5)
        assert zero_at_tension(self.PLACE, load, reference_tension=400.0).position is None
        zero = zero_at_tension(self.PLACE, load, reference_tension=400.0, stated_position=-0.4)
        assert (zero.position, zero.is_logged) == (-0.4, False)

    def test_a_ramp_of_few_samples_is_interpolated(self):
        place = np.concatenate([np.zeros(20), [0.5], np.ones(20)])
        zero = zero_at_tension(place, 1000 * place, reference_tension=250.0)
        assert zero.position == pytest.approx(0.25)
        assert zero.standard_uncertainty == pytest.approx(0.5 / 12**0.5)


REFUSED = {
    "without a hold in the log its range names the unit": (
        lambda: check(HOLDS / 0.3048, holds=np.empty(0), slack=SLACK / 0.3048),
        DataError,
        r"is the header far_thimble_ft\?",
    ),
    "one row out of reach among rows that agree is named": (
        lambda: check(HOLDS * [1, 1, 10]),
        DataError,
        r"marks.csv:5 .*hold max; found far_thimble 73.5 m",
    ),
    "one shift of all rows is the zero of the crosshead": (
        lambda: check(HOLDS - 0.3, slack=SLACK - 0.3),
        DataError,
        r"are off by \+0.3 m: the zero of crosshead_position",
    ),
}


test_refusals = refusals(REFUSED)


@pytest.mark.parametrize("readings", [7, 12])
def test_few_readings_per_cycle_are_no_noise_of_the_reference_tension(readings):
    """Synthetic: a hold at 200 N, then cycles whose shape the readings hardly show."""
    random = np.random.default_rng(1)
    step = 10 / readings
    hold, cycles = np.arange(0, 80, step), np.arange(0, 400, step)
    at_hold, low, high = (0.5 * (load / 2e4) ** 0.6 for load in (200, 1000, 2e4))
    place = np.r_[
        np.interp(hold, [0, 40, 80], [at_hold, at_hold, low]),
        low + (high - low) / 2 * (1 - np.cos(2 * np.pi * cycles / 10)),
    ]
    load = 2e4 * (place / 0.5) ** (1 / 0.6) + random.normal(0, 2, place.size)
    place += random.normal(0, 1e-4, place.size)
    found = zero_at_tension(place, load, reference_tension=200.0)
    assert found.is_logged
    assert abs(found.position - at_hold) < 2.5 * found.standard_uncertainty < 0.07

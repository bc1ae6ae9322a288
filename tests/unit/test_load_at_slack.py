"""What a load cell reads at slack, and whether its zero or its sign is wrong."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.batch.survey import survey_campaign
from reduction.campaign.load import load_campaign
from reduction.stages.load_at_slack import (
    LoadAtSlack,
    load_at_slack,
    notes_on_zero,
    pulls_as_at_reference,
    stands_at_slack_length,
)
from reduction.stages.standstills import Standstills

PLACE = np.linspace(0, 1, 500)


def rests(*rows):
    """Standstills of the samples from one to the other, both inside."""
    first, last = np.array(rows).T
    return Standstills(
        first=first, last=last, start_time=0.1 * first, end_time=0.1 * last,
        mean_position=np.zeros(first.size), mean_tension=np.zeros((1, first.size)),
        is_rest=np.ones(first.size, dtype=bool), position_tolerance=0.01, slack_tension=5.0,
    )  # fmt: skip


def notes(load, rest, zero="-14.4 N", offset=0.0):
    found = notes_on_zero(
        ["new"], PLACE, np.array([load]), [rest], [zero], offset_uncertainty=offset
    )
    return [one.code for one in found]


def test_the_mean_over_rests_has_the_noise_of_all_their_samples():
    load = np.random.default_rng(4).normal(-14.4, 0.5, 1000)
    found = load_at_slack(load, rests((0, 299), (900, 999)), np.array([True, True]))
    assert found.n_rests == 2
    # 0.5 N over the root of 400
    assert found.standard_uncertainty == pytest.approx(0.025, rel=0.1)
    assert found.load == pytest.approx(-14.4, abs=4 * 0.025)
    assert load_at_slack(load, rests((0, 9)), np.array([False])) is None


def test_steps_of_a_converter_do_not_average_out():
    # noise of a fifth of a step of 1 N about 0.5: flickers between two codes
    raw = np.random.default_rng(4).normal(0.5, 0.2, 1000)
    found = load_at_slack(np.round(raw), rests((0, 999)), np.array([True]))
    assert found.standard_uncertainty > 1 / 12**0.5 / 2


@pytest.mark.parametrize(
    ("slope", "zero", "said"),
    [
        (400.0, -14.4, ["load-zero-wrong"]),
        (400.0, 14.4, ["load-zero-wrong"]),
        (400.0, -1000.0, ["load-zero-wrong"]),
        (400.0, -2.0, ["load-zero-off"]),  # half a hundredth of 400 N
        (400.0, 0.1, []),  # three standard errors
        (-400.0, 0.0, ["load-falls-with-stretch"]),
        (-400.0, -14.4, ["load-falls-with-stretch"]),
    ],
)
def test_zero_and_sign_are_told_apart_by_the_way_the_load_goes(slope, zero, said):
    rest = LoadAtSlack(zero, 0.035, 1, zero, zero)
    assert notes(slope * PLACE + zero, rest) == said


def test_what_is_stated_of_the_zero_is_no_warning():
    rest = LoadAtSlack(-14.4, 0.035, 1, -14.4, -14.4)
    assert notes(400 * PLACE - 14.4, rest, offset=8.0) == ["load-zero-off"]
    assert notes(400 * PLACE - 14.4, rest, offset=7.0) == ["load-zero-wrong"]


@pytest.mark.parametrize("load", [-14.4, 14.4])
def test_a_load_above_zero_may_be_a_pretension(load):
    rest = LoadAtSlack(load, 0.035, 1, load, load)
    (found,) = notes_on_zero(["A"], PLACE, 400 * PLACE[None] + load, [rest], [f"{load} N"])
    assert ("or the specimen pulls there" in str(found)) == (load > 0)
    assert ("phases.slack_tension below that load" in str(found)) == (load > 0)


def test_without_a_rest_the_zero_is_not_known():
    assert notes(400 * PLACE - 300, None, "") == ["load-negative"]
    assert notes(400 * PLACE + 300, None, "") == []


@pytest.mark.parametrize(
    ("earlier", "later", "words"),
    [
        (0.5, 30.0, "its zero drifts (a specimen could pull there only if it had become shorter)"),
        (0.5, -30.0, "its zero drifts, since a line cannot push"),
        (6.0, 0.2, "or the specimen was still taut at the first"),
        (0.0, 3.9, None),  # below a hundredth of 400 N
    ],
)
def test_a_zero_that_drifts_between_the_rests_is_said_with_its_size(earlier, later, words):
    drift = 0.0 if 0 < later < earlier else later - earlier
    rest = LoadAtSlack((earlier + later) / 2, 0.035, 2, earlier, later, drift)
    found = notes_on_zero(["new"], PLACE, np.array([400 * PLACE]), [rest], ["0 N"])
    drifts = [one for one in found if one.code == "load-zero-drifts"]
    assert len(drifts) == (words is not None)
    if words:
        assert words in str(drifts[0])
        assert f"reads {earlier:.3g} N at slack and later {later:.3g} N" in str(drifts[0])
        # the one value of zero that would be told is wrong at both
        assert not any(one.code.startswith("load-zero-wrong") for one in found)


def test_a_rise_that_the_stretch_of_the_later_rest_explains_is_not_told():
    # 8 N at 0.008 of a stroke of 1 m that ends at 400 N: less than three times the mean stiffness
    load, stands = log_with_drift(0.0, last_place=0.008)
    load[600:] += 8.0
    found = load_at_slack(load, stands, np.array([True, True]), stroke=1.0)
    # there the specimen pulls, and nothing of the zero is read
    assert found.n_rests == 1
    assert found.load == pytest.approx(0.0, abs=0.2)
    assert not any("drift" in one for one in notes(load, found))


def test_a_hold_of_a_hose_that_pulls_little_is_no_reading_at_slack():
    """Slack, 6 N of 400 N at a twentieth of the stroke, slack again: a soft hose that stiffens."""
    noise = np.random.default_rng(6).normal(0, 0.1, 900)
    load = np.repeat([0.0, 6.0, 400.0, -0.5], [300, 200, 200, 200]) + noise
    stands = rests((0, 299), (300, 499), (700, 899))
    stands = replace(stands, mean_position=np.array([0.0, 0.05, 0.0]))
    found = load_at_slack(load, stands, np.ones(3, dtype=bool), stroke=1.0)
    assert found.n_rests == 2
    assert found.drift == pytest.approx(-0.5, abs=0.05)
    assert "load-zero-drifts" not in notes(load, found)


def test_the_begin_of_a_pull_that_coarse_steps_hide_is_no_reading_at_slack():
    """A sixth of the rest is of the pull already, up to 12 N of 400 N."""
    pull = np.concatenate([np.zeros(250), np.linspace(0, 12, 50), np.linspace(12, 400, 300)])
    load = np.concatenate([pull, np.zeros(300)]) + np.random.default_rng(7).normal(0, 0.1, 900)
    found = load_at_slack(load, rests((0, 299), (600, 899)), np.array([True, True]), stroke=1.0)
    assert found.load == pytest.approx(0.0, abs=0.02)
    assert (found.earlier, found.later) == pytest.approx((0.0, 0.0), abs=0.1)


def test_a_load_that_falls_towards_zero_is_told_and_not_carried():
    load = np.concatenate([np.full(300, 6.0), np.full(300, 400.0), np.full(300, 0.2)])
    found = load_at_slack(load, rests((0, 299), (600, 899)), np.array([True, True]), stroke=1.0)
    assert (found.earlier, found.later) == pytest.approx((6.0, 0.2))
    assert found.drift == 0.0


def test_the_drift_is_that_of_the_readings_at_the_ends_of_the_rests():
    """A line of 30 N over the log: the last 25 of each 100 samples are 87/2000 and 1987/2000."""
    load = 30 * np.linspace(0, 1, 2000)
    found = load_at_slack(load, rests((0, 99), (1900, 1999)), np.array([True, True]))
    assert (found.earlier, found.later) == pytest.approx((30 * 0.0435, 30 * 0.9935), abs=0.02)


def test_a_load_that_comes_late_to_a_rest_is_no_drift():
    load = np.zeros(2000)
    load[1900:1960] = 300
    found = load_at_slack(load, rests((0, 99), (1900, 1999)), np.array([True, True]))
    assert (found.earlier, found.later) == (0, 0)


def test_what_was_slack_at_a_length_is_slack_there_whatever_is_read():
    """Not at a length at which it was not slack before: there it may pull."""
    place = np.array([1.0, 2.0, 1.0, 0.9, 1.2])
    stands = replace(
        rests(*((100 * k, 100 * k + 9) for k in range(5))),
        mean_position=place,
        is_rest=place == 5,
    )
    slack = np.array([True, False, False, False, False])
    assert stands_at_slack_length(stands, slack).tolist() == [True, False, True, True, False]
    assert not stands_at_slack_length(stands, np.zeros(5, dtype=bool)).any()
    later = np.array([False, False, True, False, False])
    assert stands_at_slack_length(stands, later).tolist() == [False, False, True, True, False]


def log_with_drift(drift, *, last_place=0.0, gain=400.0):
    """A rest, a stretch and a rest; the zero moves evenly by the drift over the log."""
    place = np.interp(np.arange(900), [0, 300, 450, 600, 899], [0, 0, 1, last_place, last_place])
    share = np.arange(900) / 899
    noise = np.random.default_rng(5).normal(0, 0.5, 900)
    load = np.maximum(gain * (place - 0.05), 0.0) + drift * share + noise
    stands = rests((0, 299), (600, 899))
    return load, Standstills(**vars(stands) | {"mean_position": np.array([0.0, last_place])})


@pytest.mark.parametrize("drift", [9.0, -9.0])
def test_a_zero_that_moves_is_told_by_the_rests_at_one_length(drift):
    load, stands = log_with_drift(drift)
    found = load_at_slack(load, stands, np.array([True, True]), stroke=1.0)
    # from the last quarter of the first third to that of the last: two thirds of it
    assert found.drift == pytest.approx(drift * 2 / 3, abs=abs(drift) / 6 + 0.2)
    assert found.apart == stands.end_time[1] - stands.end_time[0]
    peak = notes(load, found, offset=1.0)
    assert "load-zero-drifts" in peak
    # what is stated of the zero holds it
    assert not any("drift" in one for one in notes(load, found, offset=20.0))
    # an error of none to all of it, evenly spread
    assert found.zero_uncertainty(1.0) == pytest.approx(abs(found.drift) / 3**0.5)


def test_a_rest_that_is_stretched_or_noisy_is_no_drift():
    # at 0.009 of the stroke further out a specimen that bears there reads 3.6 N
    load, stands = log_with_drift(0.0, last_place=0.009)
    load[600:] += 3.6
    assert load_at_slack(load, stands, np.array([True, True]), stroke=1.0).drift == 0.0
    load, stands = log_with_drift(0.0)
    assert load_at_slack(load, stands, np.array([True, True]), stroke=1.0).drift == 0.0
    # without a rest before the first stretch nothing is known
    load, stands = log_with_drift(9.0)
    assert load_at_slack(load, stands, np.array([False, True])).drift == 0.0


@pytest.mark.parametrize(("after", "is_drift"), [(9.0, False), (60.0, True)])
def test_a_hose_that_was_pushed_pulls_at_its_own_length(after, is_drift):
    # 50 N of push in between: it pulls back by less, and 60 N are of the load cell
    load = np.r_[np.zeros(300), np.linspace(0, -50, 100), np.linspace(-50, 100, 200),
                 np.full(300, after)]  # fmt: skip
    load += np.random.default_rng(8).normal(0, 0.1, load.size)
    stands = Standstills(**vars(rests((0, 299), (600, 899))) | {"mean_position": np.zeros(2)})
    found = load_at_slack(load, stands, np.array([True, True]), stroke=0.3)
    assert (found.drift != 0) is is_drift
    # a rest at which it pulls says nothing of the zero
    assert found.load == pytest.approx(after / 2 if is_drift else 0.0, abs=0.1)


def hose_log(folder, *, mounted, stated, zero=0.0, creep=0.0):
    """A hose that is mounted at a tension, stretched three times, and back; its load at slack."""
    begin = mounted / 4000
    stroke = np.concatenate([np.linspace(begin, 1.2, 500), np.linspace(1.2, begin, 500)])
    stretch = np.concatenate([np.full(100, begin), np.tile(stroke, 3), np.full(100, begin)])
    own = np.maximum(stretch - creep * (np.arange(stretch.size) > 600), 0)
    load = 4000 * own + 9000 * np.maximum(own - 0.5, 0) ** 2 + zero
    load = load + np.random.default_rng(1).normal(0, 2, load.size)
    length = 2000 * (1 + stretch) / (1 + begin)
    rows = zip(0.2 * np.arange(load.size), length, load, strict=True)
    text = "\n".join(f"{time:.1f},{place:.3f},{pull:.2f}" for time, place, pull in rows)
    (folder / "A.csv").write_text(f"t,L,F\n{text}\n")
    (folder / "campaign.toml").write_text(f"""
[campaign]
id = "hose"
title = "hose"
institution = "none"
source = "synthetic"
synthetic = true
[specimens.h]
kind = "stretch hose"
material = "rubber"
diameter = ["100 mm"]
gauge_length = "2000 mm"
{f'reference_tension = "{stated} N"' if stated else ""}
[layouts.b]
format = "delimited"
delimiter = ","
[layouts.b.channels]
time = {{ column = "t", unit = "s" }}
crosshead_position = {{ column = "L", unit = "mm", datum = "pin-to-pin" }}
tension.1 = {{ column = "F", unit = "N" }}
[tests.A]
file = "A.csv"
layout = "b"
specimens = ["h"]
kind = "cyclic"
control = "position"
waveform = "triangular"
strain = {{ method = "gauge-length" }}
""")
    (survey,) = survey_campaign(load_campaign(folder / "campaign.toml")).kept["A"]
    return [one for one in survey.located.record.notes if one.code.startswith("load-zero")]


@pytest.mark.parametrize("creep", [0.0, 0.01])
def test_a_preload_at_which_strain_is_zero_is_no_zero_of_the_load_cell(tmp_path, creep):
    assert hose_log(tmp_path, mounted=150, stated=150, creep=creep) == []


@pytest.mark.parametrize(("mounted", "stated", "zero"), [(150, 0, 0), (0, 0, 150), (150, 40, 0)])
def test_a_load_at_rest_that_no_reference_tension_explains_is_told(tmp_path, mounted, stated, zero):
    (found,) = hose_log(tmp_path, mounted=mounted, stated=stated, zero=zero)
    assert found.code == "load-zero-wrong" and found.numbers["load"] == pytest.approx(150, abs=1)


def test_a_load_cell_that_pushes_at_the_length_of_the_reference_is_at_slack():
    stands = replace(rests((0, 9), (20, 29)), mean_position=np.array([1.0, 1.0]))
    load = np.array([20.0, -3.0])
    assert pulls_as_at_reference(stands, load, reference_tension=20.0, half=4.0).tolist() == [
        True, False,
    ]  # fmt: skip


@pytest.mark.parametrize(("later", "drift"), [(-8.0, -14.0), (-0.5, 0.0), (0.2, 0.0)])
def test_a_load_that_falls_below_zero_has_drifted_by_its_whole_fall(later, drift):
    """A line cannot push; up to a tenth of the first reading below zero counts as falling to it."""
    noise = np.random.default_rng(8).normal(0, 0.1, 900)
    load = np.repeat([6.0, 400.0, later], 300) + noise
    found = load_at_slack(load, rests((0, 299), (600, 899)), np.array([True, True]), stroke=1.0)
    assert found.drift == pytest.approx(drift, abs=0.05)

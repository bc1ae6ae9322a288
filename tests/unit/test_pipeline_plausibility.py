from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reduction.pipeline.reduce_test import _drift, _plausibility_notes, _slack_in_cycles, _tones
from reduction.record.measurement import Specimen
from reduction.record.settings import ModulusSettings, PhaseSettings, ReductionSettings
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.loops import close_loops
from reduction.stages.load_at_slack import LoadAtSlack
from reduction.stages.moduli.tangent_modulus import tangent_curves

AREA = np.array([3e-4])


@pytest.fixture
def notes_of(triangle):
    strain, cycles = triangle(low=0.5, high=1.5)

    def notes(
        tension=1000 * strain, *, stretch=strain, waveform="triangular", share=None, snap=False,
    ):  # fmt: skip
        one = cycles
        if share is not None:
            within = np.arange(strain.size) % 50 < 50 * share  # a branch has 51 samples
            one = replace(cycles, is_in_trimmed_branch=within)
        load, stretch = np.atleast_2d(tension), np.atleast_2d(stretch)
        curves = tangent_curves(
            stretch, load, area=AREA, cycles=one, settings=ModulusSettings(), break_in_cycles=0
        )
        return tuple(map(str, _plausibility_notes(
            stretch, specimens=(Specimen("new"),), slack_tensions=[20.0], waveform=waveform,
            cycles=one,
            loops=close_loops(
                0.1 * np.arange(strain.size), load, stretch, one, waveform=waveform
            ), curves=curves,
            is_snap=snap,
        )))  # fmt: skip

    notes.strain = strain
    return notes


def test_a_test_as_tests_are_gets_no_note(notes_of):
    assert tuple(map(str, notes_of())) == ()


def test_of_a_negative_tension_the_cycles_say_nothing(notes_of):
    # the whole log says whether sign or zero is wrong: tests/unit/test_load_at_slack.py
    assert not any("sign" in str(note) for note in notes_of(-1000 * notes_of.strain))


def test_tension_that_falls_with_stretch_and_is_positive_blames_no_load_channel(notes_of):
    # which channel runs backward the loops say (`reduction.stages.cycles.loop_sense`)
    assert notes_of(3000 - 1000 * notes_of.strain) == ()


def test_a_strain_no_specimen_reaches_asks_for_the_unit_of_position(notes_of):
    (note,) = map(str, notes_of(stretch=1000 * notes_of.strain))
    assert note.startswith("new: strain reaches 1500, which is impossible")


def test_cycles_that_are_mostly_drift_are_counted(notes_of):
    samples = np.arange(notes_of.strain.size)
    # 500 N a cycle beside a range of 1000 N
    (note,) = map(str, notes_of(1000 * notes_of.strain + 5.0 * samples))
    assert note.startswith("new: 10 of 10 cycles drift by more than 20 % of their range")
    # a jump to a tenth: beside it the drift is more than what is left of the range
    jump = np.where(samples < 410, 1.0, 0.1)
    (note,) = map(str, notes_of(1000 * notes_of.strain * jump))
    assert "cycles drift by more than" in note


@pytest.mark.parametrize(
    ("far", "gap", "severity"),
    [
        ([0], None, "note"),
        ([0, 5], 5, "note"),
        ([4], None, "warning"),
        ([0, 1, 2], None, "warning"),
    ],
)
def test_the_drift_of_a_first_cycle_is_that_of_the_ramp_before_it(far, gap, severity):
    first = 50 * np.arange(10)
    if gap is not None:
        first[gap:] += 200  # a pause: the next cycle is the first of a run again
    cycles = SimpleNamespace(first=first, last=first + 50)
    half = np.full((1, 10), 100.0)
    amplitude = half.copy()
    amplitude[0, far] = 70.0  # 60 of a range of 200 are drift
    loops = SimpleNamespace(
        peak_tension=half, valley_tension=-half, tension_amplitude=half, strain_amplitude=amplitude
    )
    (note,) = _drift("new", loops, 0, half[0], cycles)
    assert note.severity == severity
    assert note.numbers["n_far"] == len(far)


@pytest.mark.parametrize(
    ("hum", "waveform", "is_told"),
    [(2.0, "triangular", True), (0.0, "triangular", False), (0.1, "triangular", False),
     (2.0, "sinusoidal", False)],
)  # fmt: skip
def test_hum_is_in_the_extremes_of_ramps_and_not_in_a_fundamental(hum, waveform, is_told):
    per = 500
    time = np.arange(10 * per + 1) / 200
    wave = 100 * (1 - np.abs(2 * (time * 200 / per % 1) - 1))
    load = wave + hum * np.sin(2 * np.pi * 50.02 * time)
    load += np.random.default_rng(1).normal(0, 0.1, time.size)
    first = per * np.arange(10)
    cycles = SimpleNamespace(first=first, last=first + per, n_cycles=10)
    loops = SimpleNamespace(
        tension_amplitude=np.full((1, 10), 50.0),
        uncertainty={"tension_amplitude": np.full((1, 10), 0.1)},
    )
    record = SimpleNamespace(time=time, specimens=("new",))
    told = [str(one) for one in _tones(record, load[None], cycles, loops, waveform)]
    assert len(told) == is_told
    if is_told:
        assert told[0].startswith("new: tension oscillates at 50 Hz by 2 N")
        assert "4.0 % of the tension amplitude" in told[0]


def test_snap_loads_go_slack_and_a_line_that_stays_taut_is_named(notes_of):
    assert tuple(map(str, notes_of(np.maximum(1000 * (notes_of.strain - 0.7), 0), snap=True))) == ()
    (note,) = map(str, notes_of(snap=True))
    assert "are not snap loads: tension stays above 20 N" in note


def test_cycles_that_go_slack_are_counted(notes_of):
    (note,) = map(str, notes_of(np.maximum(1000 * (notes_of.strain - 0.7), 0)))
    assert note.startswith(
        "new: the specimen goes slack in 10 of 10 cycles (tension at or below 20 N)"
    )


def test_a_specimen_that_is_pushed_in_its_cycles_is_not_called_slack(notes_of):
    # from -500 to 500 N, of which a fiftieth is slack
    (note,) = map(str, notes_of(1000 * (notes_of.strain - 1.0)))
    assert note.startswith(
        "new: tension is negative in part of the cycles (down to -500 N, median)"
    )


def test_what_the_cell_reads_at_slack_says_what_is_slack_in_the_cycles():
    """430 N is a fiftieth of the peak; a hose that reads 12 N at rest pulls 300 N at its valleys."""
    rest = LoadAtSlack(8.0, 1.0, 2, 4.0, 12.0)
    located = SimpleNamespace(
        record=SimpleNamespace(specimens=("new", "no rest", "wrong zero")),
        standstills=SimpleNamespace(slack_tension=430.0),
        load_at_slack=(rest, None, replace(rest, later=700.0)),
        cycles=None,
    )
    assert _slack_in_cycles(located, ReductionSettings()) == [119.5, 430.0, 430.0]
    stated = replace(ReductionSettings(), phases=PhaseSettings(slack_tension=430.0))
    assert _slack_in_cycles(located, stated) == [430.0] * 3


TRAVEL = 1 - np.abs(np.arange(2001) % 400 / 200 - 1)  # five cycles from 0 to 1


def slack_of(position, tension):
    """Slack tensions of five cycles of 400 readings; a fiftieth of the peak is 20 N."""
    at = np.arange(0, 2000, 400)
    ends = np.column_stack([at, at + 200])
    cycles = Cycles(
        at, at + 400, ends, ends + 200, np.ones((5, 2)), np.zeros(2001, np.int32),
        np.zeros(2001, np.int8), np.zeros(2001, bool), 0.1,
    )  # fmt: skip
    located = SimpleNamespace(
        record=SimpleNamespace(specimens=("new",)), standstills=SimpleNamespace(slack_tension=20.0),
        load_at_slack=(), cycles=cycles, position=position, tension=tension[None],
    )  # fmt: skip
    return _slack_in_cycles(located, ReductionSettings())


@pytest.mark.parametrize(("valley", "level"), [(19.0, 10.0), (5.0, 20.0), (0.0, 20.0)])
def test_a_line_that_turns_at_a_low_load_is_not_slack(valley, level):
    """Load up to 1000 N over the travel."""
    assert slack_of(TRAVEL, valley + (1000 - valley) * TRAVEL) == [level]


@pytest.mark.parametrize(("hangs", "level"), [(0.0, 10.0), (0.05, 20.0)])
def test_a_rope_that_turns_at_a_hundredth_of_its_peak_is_not_slack(hangs, level):
    """x = T^(3/4) from 12 to 1000 N: 1.8 % of the stroke below 20 N, 3.2 % at a quarter stiffness.

    One that hangs gives way by a share of the stroke at its lowest load.
    """
    load = 12 + 988 * TRAVEL
    assert slack_of(load**0.75 / 1000**0.75 - hangs * (load < 15), load) == [level]


@pytest.mark.parametrize(("share", "n_notes"), [(0.5, 1), (0.7, 0)])
def test_little_at_a_constant_rate_asks_for_the_waveform(notes_of, share, n_notes):
    notes = tuple(map(str, notes_of(share=share)))
    assert len(notes) == n_notes
    assert all("only 49 % of the branches run at a constant rate" in note for note in notes)
    assert tuple(map(str, notes_of(share=share, waveform="other"))) == ()


def test_a_test_without_cycles_is_judged_by_its_strain_alone():
    notes = tuple(map(str, _plausibility_notes(
        np.array([[0.0, np.nan, 12.0], [0.0, 1.0, 2.0]]), specimens=(Specimen("new"), Specimen("used")),
        slack_tensions=[20.0], waveform="triangular", cycles=None, loops=None, curves=None,
    )))  # fmt: skip
    assert [note.split(":")[0] for note in notes] == ["new"]

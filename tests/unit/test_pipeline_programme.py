"""Which step of a programme a test is, and what is said of it."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.pipeline.located_test import locate, slips_of
from reduction.pipeline.rope_test import rope_step
from reduction.record.measurement import LoadTrain, Record, Specimen
from reduction.record.settings import CycleSettings, ReductionSettings, RopeSettings
from reduction.stages.cycles.loops import close_loops
from reduction.stages.three_parameter_line.rope_programme import DynamicStiffness

ROPE = Specimen("line", kind="rope", rated_break_strength=1000.0)
TETHER = Specimen("tether", rated_break_strength=1000.0)


def record(load, *, name="line", counter=None, position=None):
    """Half a second a reading; a line of 2,000 N a unit of strain, ten metres long."""
    load = np.asarray(load, dtype=float)
    noise = np.random.default_rng(4)
    position = 10 + load / 200 if position is None else position
    flags = np.zeros(load.size, dtype=np.uint16)
    return Record(
        test_id="A",
        specimens=(name,),
        time=0.5 * np.arange(load.size),
        crosshead_position=position + noise.normal(0, 1e-5, load.size),
        tension=(load + noise.normal(0, 0.02, load.size))[None],
        quality_flag=flags[None],
        crosshead_position_quality_flag=flags,
        cycle_counter=counter,
    )


def cycles(n, *, start=100.0, low=100.0, high=300.0):
    """A stand at the start, and cycles of twenty readings."""
    turns = [start, *[high, low] * n]
    return np.concatenate(
        [np.full(20, start), np.interp(np.arange(20 * n + 1), 10 * np.arange(2 * n + 1), turns)]
    )


def step_of(one, kind, *, specimen=ROPE, failed=None, control="load", **numbers):
    settings = ReductionSettings(
        cycles=CycleSettings(control=control), rope=RopeSettings(**numbers)
    )
    located = locate(one, kind=kind, settings=settings)
    strain = (located.position[None] - 10) / 10
    loops = (
        None
        if located.cycles is None
        else close_loops(one.time, located.tension, strain, located.cycles)
    )
    return rope_step(
        located, strain, located.tension, kind=kind, specimens=(specimen,), loops=loops, holds=(),
        failed=failed, settings=settings.rope,
    )  # fmt: skip


def test_the_kind_says_which_step_it_is():
    one = record(cycles(12))
    assert isinstance(step_of(one, "cyclic").dynamic, DynamicStiffness)
    bedding = step_of(one, "bedding-in")
    assert bedding.bedding_in.n_cycles == 12 and bedding.dynamic is not None
    life = step_of(one, "fatigue")
    assert life.lasted.cycles == 12 and life.dynamic is None
    assert step_of(one, "relaxation") is None
    # a quasi-static test without holds is a slow pull alone, which has a peak
    pulled = step_of(one, "quasi-static")
    assert pulled.held == () and pulled.tensile.peak_tension == np.nanmax(one.tension)


def test_cycles_of_a_tether_are_no_programme_but_its_life_is():
    one = record(cycles(12), name="tether")
    assert step_of(one, "cyclic", specimen=TETHER) is None
    assert step_of(one, "fatigue", specimen=TETHER).lasted.cycles == 12


def test_fewer_cycles_than_asked_for_are_named():
    assert tuple(map(str, step_of(record(cycles(12)), "cyclic").notes)) == ()
    (note,) = map(str, step_of(record(cycles(12)), "cyclic", last_cycles=50).notes)
    assert note == "line: dynamic stiffness is from 12 cycles; rope.last_cycles is 50"


def test_a_step_of_two_levels_is_named():
    load = np.concatenate([cycles(12), cycles(12, start=200.0, low=200.0, high=600.0)])
    (note,) = map(str, step_of(record(load), "cyclic").notes)
    assert note.startswith("line: 12 of 24 cycles are at another level than the last ones")


def test_a_first_cycle_that_begins_lower_is_named():
    load = cycles(12)
    load[:31] = np.concatenate([np.full(20, 60.0), np.linspace(60, 300, 11)])
    # found by its turns it is cut where it passes the other valleys
    counter = np.clip((np.arange(load.size) - 20) // 20 + 1, 0, 12)
    for count in (None, counter):
        assert tuple(map(str, step_of(record(load, counter=count), "bedding-in").notes)) == ()
    # not so where the machine stored it alone, before the third
    counter = counter + (counter > 1)
    (note,) = map(str, step_of(record(load, counter=counter), "bedding-in").notes)
    start = float(note.removeprefix("line: the first cycle starts at ").split()[0])
    assert start == pytest.approx(60, abs=0.1)


def test_bedding_in_of_one_cycle_is_refused():
    load = np.concatenate([cycles(1), np.full(30, 100.0)])
    found = step_of(record(load), "bedding-in", last_cycles=1)
    assert found.bedding_in is None
    assert "bedding-in not given: only one cycle; two are needed" in tuple(map(str, found.notes))


def test_cycles_are_those_of_the_machine_where_it_counts():
    load = cycles(12)[20:]
    counter = 1000 + np.minimum(np.arange(load.size) // 20, 11)
    assert step_of(record(load, counter=counter), "fatigue").lasted.cycles == 1011


def test_a_life_counts_the_cycles_that_the_gaps_of_its_log_hold_and_says_so():
    # twelve cycles of ten seconds; the logger was off for fifty after the sixth
    step = step_of(with_gap(12, 50), "fatigue")
    assert step.lasted.cycles == 12 + 50
    (said,) = [one for one in step.notes if one.code == "life-across-gaps"]
    assert said.severity == "warning"
    # the cycle next to the gap ends in it
    assert said.numbers == {"n_hidden": 51, "n_cycles": 11}
    (said,) = [one for one in step_of(with_gap(200, 2), "fatigue").notes if one.code == said.code]
    assert said.severity == "note"


def with_gap(n_cycles, n_hidden):
    one = record(cycles(n_cycles))
    late = np.arange(one.time.size) > 20 + 6 * 20
    return replace(one, time=one.time + 10.0 * n_hidden * late)


@pytest.mark.parametrize(
    ("back", "failed"), [(False, True), (True, False)], ids=["parted", "unloaded"]
)
def test_slack_at_a_position_at_which_it_was_taut_is_a_failure(back, failed):
    load = np.concatenate([cycles(12), np.linspace(100, 250, 8), np.zeros(40)])
    position = 10 + load / 200
    if not back:
        position[-40:] = 10 + 250 / 200 + 0.01 * np.arange(40)
    found = step_of(record(load, position=position), "fatigue").lasted
    assert found.failed.tolist() == [failed]
    assert found.cycles[0] == 12 or back


@pytest.mark.parametrize("lost", [slice(None), slice(222, 239)], ids=["all", "a peak"])
def test_a_tension_that_is_not_known_tells_of_no_failure(lost):
    one = record(cycles(12))
    located = locate(
        one, kind="fatigue", settings=ReductionSettings(cycles=CycleSettings(control="load"))
    )
    tension = located.tension.copy()
    loops = close_loops(one.time, tension, (located.position[None] - 10) / 10, located.cycles)
    tension[:, lost] = np.nan
    if lost == slice(None):
        loops = replace(loops, peak_tension=np.full(loops.peak_tension.shape, np.nan))
    found = rope_step(
        located, tension, tension, kind="fatigue", specimens=(ROPE,), loops=loops, holds=(),
        failed=None, settings=RopeSettings(),
    )  # fmt: skip
    assert found.lasted.failed.tolist() == [False]


def test_the_word_of_the_laboratory_goes_before_the_record():
    found = step_of(record(cycles(12)), "fatigue", failed=True).lasted
    assert found.failed.tolist() == [True]


def test_without_a_strength_nothing_is_divided_and_a_note_says_so():
    bare = step_of(record(cycles(12)), "cyclic", specimen=Specimen("line", kind="rope"))
    assert np.isnan(bare.dynamic.dynamic_stiffness_over_strength).all()
    assert tuple(map(str, bare.notes)) == (
        "line: no rated break strength is stated: results relative to it are not given",
    )


def test_a_pull_without_strain_has_a_strength_alone():
    load = np.concatenate([np.linspace(0, 900, 200), np.zeros(20)])
    position = 10 + np.arange(220) / 20
    one = record(load, position=position)
    located = locate(one, kind="tensile", settings=ReductionSettings())
    found = rope_step(
        located, located.tension * np.nan, located.tension, kind="tensile", specimens=(ROPE,),
        loops=None, holds=(), failed=None, settings=RopeSettings(),
    )  # fmt: skip
    assert found.tensile.is_break.tolist() == [True]
    assert tuple(map(str, found.notes)) == (
        "line: strain at the greatest load not given: it is not known, or did not grow while the"
        " load rose to it: an extensometer was taken off, or the position counts the other way"
        " (sign = -1)",
    )


@pytest.mark.parametrize("kind", ["tensile", "quasi-static"])
def test_a_pull_whose_extensometer_comes_off_has_no_strain_and_says_so(kind):
    # 1 % at 500 N, where the extensometer falls off; the pull is stopped at 900 N
    load = np.linspace(0, 900, 200)
    strain = np.where(load < 500, load / 5e4, -0.03)
    one = record(load, position=10 + np.arange(200) / 100)
    located = locate(one, kind=kind, settings=ReductionSettings())
    found = rope_step(
        located, strain[None], located.tension, kind=kind, specimens=(ROPE,),
        loops=None, holds=(), failed=None, settings=RopeSettings(),
    )  # fmt: skip
    assert np.isnan(found.tensile.strain_at_peak).all()
    assert [one.code for one in found.notes].count("no-strain-at-failure") == 1


def test_a_test_in_compression_is_told_that_it_is_no_pull():
    # a block that crushes at 2779 N; it pulls 1 N as the platen touches it
    push = np.concatenate([np.linspace(1, -2779, 60), np.linspace(-2779, -20, 60)])
    one = record(push, position=6.0 - np.arange(120) / 100)
    located = locate(one, kind="tensile", settings=ReductionSettings())
    found = rope_step(
        located, located.tension * 0, located.tension, kind="tensile", specimens=(ROPE,),
        loops=None, holds=(), failed=None, settings=RopeSettings(),
    )  # fmt: skip
    (told,) = (one for one in found.notes if one.code == "pushed-in-pull")
    assert "falls to -2779 N and rises to 1.03" in str(told)


def of_two(first, second, position):
    """Two lines side by side, each with its own load cell."""
    one, other = (record(load, position=position) for load in (first, second))
    return replace(
        one,
        specimens=("line", "other"),
        tension=np.concatenate([one.tension, other.tension]),
        quality_flag=np.concatenate([one.quality_flag, other.quality_flag]),
    )


@pytest.mark.parametrize("kind", ["fatigue", "cyclic"])
def test_what_follows_a_break_is_left_out_and_its_rest_is_no_slack_length(kind):
    whole = cycles(12)
    load = whole.copy()
    place = 10 + whole / 200
    broke = 20 + 8 * 20 + 7  # on the way up in the ninth cycle, and the ram runs on to its stop
    load[broke:], place[broke:] = 0.0, 12.5
    located = locate(
        record(load, position=place), kind=kind,
        settings=ReductionSettings(cycles=CycleSettings(control="load")),
    )  # fmt: skip
    assert located.parted == (broke,)
    assert np.isnan(located.tension[0, broke:]).all()
    assert np.isfinite(located.tension[0, :broke]).all()
    assert not (located.standstills.first > broke).any()
    (said,) = [one for one in located.record.notes if one.code.startswith("specimen-parted")]
    assert said.numbers["time"] == pytest.approx(broke / 2)
    assert said.severity == ("note" if kind == "fatigue" else "warning")


def test_one_that_comes_loose_beside_another_leaves_the_other_as_it_is():
    whole = cycles(12)
    load = whole.copy()
    load[100:] = 0.0
    located = locate(
        of_two(load, whole, 10 + whole / 200), kind="cyclic", settings=ReductionSettings()
    )
    assert located.parted == (100, -1)
    assert np.isfinite(located.tension[1]).all()


def test_a_break_under_a_stated_compliance_leaves_the_position_to_the_other():
    # X = x + c (T_1 + T_2): the frame that one has left is stretched by the other alone
    whole = cycles(12)
    load = whole.copy()
    load[100:] = 0.0
    given = 2e-5 * (whole + load)
    one = replace(
        of_two(load, whole, 10 + whole / 200 + given), load_train=LoadTrain(machine_compliance=2e-5)
    )
    located = locate(one, kind="cyclic", settings=ReductionSettings(), specimens=(ROPE, TETHER))
    assert located.parted == (100, -1)
    assert located.position == pytest.approx(10 + whole / 200, abs=2e-4)


def test_a_rope_that_parts_while_the_logger_is_off_has_a_lower_bound_of_its_life():
    # blocks of 60 cycles each, the second 1000 cycles later; its peaks have fallen to 60 % before,
    # so that the valley of the last sound cycle is below a quarter of the greatest load
    whole = cycles(120, low=60.0, start=60.0)
    sound = whole * np.where(np.arange(whole.size) < 20 + 10 * 20, 1.0, 0.6)
    load = sound.copy()
    broke = 20 + 60 * 20 + 1
    load[broke:] = 0.0
    number = np.clip((np.arange(whole.size) - 20) // 20 + 1, 1, 120)
    one = record(load, position=10 + whole / 200, counter=number + 1000 * (number > 60))
    one = replace(one, time=one.time + 10_000.0 * (number > 60))
    located = locate(one, kind="fatigue", settings=ReductionSettings())
    assert located.parted == (broke,)
    slips = slips_of(located, ReductionSettings())
    assert slips is not None
    assert slips.slip_cycle.size == 0 or slips.slip_cycle.max() < 20
    step = step_of(one, "fatigue", control="position")
    assert step.lasted.failed
    (said,) = [one for one in step.notes if one.code == "failed-in-gap"]
    assert said.numbers["last"] == step.lasted.cycles[0] in (59, 60)
    assert said.numbers["following"] > 1060


@pytest.mark.parametrize("low", [0.0, 100.0])
def test_a_line_that_is_let_slack_at_the_end_has_not_parted(low):
    whole = cycles(12, low=low, start=low)
    home = np.concatenate([whole, np.linspace(low, -60.0, 40), np.full(40, -60.0)])
    load = np.maximum(home, 0.0)
    # a rubber that stays longer is slack earlier on the way back than it was on the way out
    load[-80:] = np.maximum(load[-80:] - 20.0, 0.0)
    located = locate(
        record(load, position=10 + home / 200), kind="cyclic", settings=ReductionSettings()
    )
    assert located.parted == (-1,)


def test_a_rope_that_stays_longer_than_the_first_pull_has_not_parted_when_it_is_unloaded():
    # the first pull passes the length that is left with two thirds of the load, the cycles never
    # come below it, and the ram goes back to the reference tension at the end
    first = np.linspace(4.0, 100.0, 40)
    worked = np.concatenate([np.interp(np.arange(241), 10 * np.arange(25), [100, 60] * 12 + [100])])
    back = np.linspace(100.0, 4.0, 40)
    load = np.concatenate([np.full(10, 4.0), first, worked, back, np.full(60, 4.0)])
    place = np.concatenate(
        [np.full(10, 10.0), 10 + 0.01 * first, 10.8 + 0.002 * worked, 10.8 + 0.002 * back,
         np.full(60, 10.808)]
    )  # fmt: skip
    located = locate(
        record(load, position=place), kind="bedding-in",
        settings=ReductionSettings(cycles=CycleSettings(control="load")),
    )  # fmt: skip
    assert located.parted == (-1,)


def test_the_stop_after_a_creep_rupture_is_no_slack_length():
    load = np.concatenate([np.linspace(50.0, 300.0, 40), np.full(400, 300.0), np.zeros(80)])
    place = 10 + load / 200 + 0.02 * np.log1p(np.arange(load.size) / 40)
    place[440:] = 13.0
    located = locate(record(load, position=place), kind="creep", settings=ReductionSettings())
    assert located.parted == (440,)
    assert not located.standstills.is_rest.any()
    assert located.standstills.n_standstills == 1


def test_a_stated_load_train_does_not_bring_the_rest_after_a_break_back():
    whole = cycles(12)
    load, place = whole.copy(), 10 + whole / 200
    load[187:], place[187:] = 0.0, 12.5
    one = replace(
        record(load, position=place),
        load_train=LoadTrain(load_cell_at="fixed", attached_mass=None, machine_compliance=1e-7),
    )
    located = locate(one, kind="cyclic", settings=ReductionSettings(), specimens=(ROPE,))
    assert located.parted == (187,)
    assert not (located.standstills.first >= 187).any()

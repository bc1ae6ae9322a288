"""What a specimen had seen before a test: cycles in logs, between them, and of a wagger."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reduction.batch.reuse import _settings_json
from reduction.batch.survey import SpliceSlip, Survey, _splice_slips
from reduction.batch.test_history import (
    _across_slip,
    earlier_tests_of,
    history_of,
    history_remarks,
    instruments_of,
)
from reduction.campaign.plan import TestPlan
from reduction.pipeline.located_test import locate
from reduction.pipeline.reduce_test import reduce_test
from reduction.record.contributions import InstrumentErrors, StatedErrors
from reduction.record.errors import DataError
from reduction.record.measurement import Record, Specimen, SpliceMarks
from reduction.record.settings import CycleSettings, ReductionSettings, StrainSettings
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.reduced_test import TestDescription
from reduction.stages.strain.strain_fit import fit_strain_model
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.strain.zero_strain import ZeroStrain
from reduction.uncertainty.errors_of_cycles import PullOrigin


def survey(
    name,
    order,
    *,
    n_cycles=0,
    n_between=0,
    log="",
    place=0,
    error=None,
    specimens=("hose",),
    **told,
):
    plan = TestPlan(
        id=name, kind="cyclic", files=((f"{name}.csv", "ram"),), specimens=specimens, order=order,
        control="position", waveform="triangular", target_strain=(), attributes={},
        settings=ReductionSettings(), log=log or name, step_place=place, **told,
    )  # fmt: skip
    return Survey(plan, n_cycles=n_cycles, n_cycles_between=n_between, error=error)


def past(surveys, *specimens):
    """Earlier cycles and earlier flex cycles of the first specimen, by test."""
    campaign = SimpleNamespace(specimens={one.name: one for one in specimens}, marks={})
    found = {}
    for entry in surveys:
        history = history_of(entry, earlier_tests_of(surveys, {}), campaign)
        flex = history.earlier_flex_cycles
        found[entry.plan.id] = (history.earlier_cycles[0], None if flex is None else flex[0])
    return found


def counted(*count):
    """Cycles of a log of which a machine numbers each."""
    none, number = np.zeros(0), np.array(count)
    rows = np.arange(number.size)
    pairs = np.column_stack([rows, rows])
    return Cycles(rows, rows, pairs, pairs, pairs, none, none, none, 0.1, count=number)


def test_cycles_that_a_machine_counted_and_did_not_log_are_in_the_history():
    # each tenth of 31 is logged; the counter starts again in the second log, and once within it
    logs = counted(1, 11, 21, 31), counted(1, 11, 1, 2)
    surveys = [
        survey(name, order, n_cycles=log.n_cycles, n_between=log.n_between)
        for order, (name, log) in enumerate(zip("AB", logs, strict=True), start=1)
    ]
    found = past([*surveys, survey("C", 3)], Specimen("hose"))
    assert [found[name][0] for name in "ABC"] == [0, 31, 31 + 11 + 2]
    # without a counter a gap may hold cycles, or none
    assert replace(logs[0], is_count_sure=False).n_between == 0


def test_cycles_before_the_campaign_and_between_its_logs_are_counted_with_the_logged_ones():
    surveys = [
        survey("A", 1, n_cycles=3),
        survey("B", 2, n_cycles=12, unlogged_cycles=114_997),
        survey("C", 3),
    ]
    hose = Specimen("hose", kind="stretch hose", earlier_cycles=500)
    assert past(surveys, hose) == {
        "A": (500, None), "B": (500 + 3 + 114_997, None), "C": (500 + 3 + 114_997 + 12, None),
    }  # fmt: skip


def test_flexing_is_counted_where_the_campaign_says_something_of_it():
    # WHOI-2004-06, sec. 3.0: flexed 1,000,000 times
    surveys = [
        survey("A", 1, n_cycles=3), survey("B", 2, n_flex_cycles=1_000_000), survey("C", 3),
    ]  # fmt: skip
    assert [flex for _, flex in past(surveys, Specimen("hose")).values()] == [0, 0, 1_000_000]
    before = Specimen("hose", earlier_flex_cycles=200)
    assert [flex for _, flex in past(surveys, before).values()] == [200, 200, 1_000_200]


def test_one_specimen_of_two_that_was_never_said_to_be_flexed_has_no_number():
    both = survey("A", 1, specimens=("hose", "other"))
    campaign = SimpleNamespace(
        specimens={"hose": Specimen("hose", earlier_flex_cycles=0), "other": Specimen("other")},
        marks={},
    )
    flex = history_of(both, earlier_tests_of([both], {}), campaign).earlier_flex_cycles
    assert flex[0] == 0 and np.isnan(flex[1])


def test_the_steps_of_a_log_share_what_came_before_it():
    told = {"log": "L", "unlogged_cycles": 100, "n_flex_cycles": 40}
    surveys = [
        survey("L.a", 1, n_cycles=5, place=1, **told),
        survey("L.b", 1, n_cycles=6, place=2, **told),
        survey("M", 2),
    ]
    found = past(surveys, Specimen("hose"))
    assert found["L.a"] == (100, 0)
    # some of the flexing of the log came before its second step: how much is not known
    assert found["L.b"] == (105, None)
    assert found["M"] == (111, 40)


def test_a_part_of_a_test_has_what_came_before_the_whole():
    surveys = [
        survey("A", 1, n_cycles=5, unlogged_cycles=100),
        survey("burst", None, n_cycles=2, part_of="A"),
    ]
    assert past(surveys, Specimen("hose"))["burst"] == (100, None)


def test_a_failed_test_leaves_its_cycles_unknown_but_not_the_stated_flexing():
    surveys = [survey("A", 1, n_flex_cycles=7, error=DataError("lost")), survey("B", 2)]
    cycles, flex = past(surveys, Specimen("hose"))["B"]
    assert np.isnan(cycles) and flex == 7


@pytest.mark.parametrize(
    ("before", "between", "count"), [(None, None, None), (0, 0, None), (500, None, 500), (5, 7, 12)]
)
def test_cycles_in_no_log_are_named_since_no_strain_of_them_is_known(before, between, count):
    surveys = [survey("A", 1, unlogged_cycles=between)]
    campaign = SimpleNamespace(
        specimens={"hose": Specimen("hose", earlier_cycles=before)}, marks={}
    )
    remarks = tuple(map(str, history_remarks(surveys[0], earlier_tests_of(surveys, {}), campaign)))
    expected = f"hose: {count} earlier cycles were not logged: earlier_maximum_strain and "
    assert [text.startswith(expected) for text in remarks] == ([] if count is None else [True])


def test_a_test_without_a_place_has_no_history():
    alone = survey("A", None, unlogged_cycles=5)
    campaign = SimpleNamespace(specimens={"hose": Specimen("hose")}, marks={})
    assert history_of(alone, earlier_tests_of([alone], {}), campaign) is None
    assert tuple(map(str, history_remarks(alone, earlier_tests_of([alone], {}), campaign))) == ()


def test_specimens_that_share_tests_without_an_order_are_asked_for_one():
    surveys = [survey("A", None), survey("B", None)]
    campaign = SimpleNamespace(specimens={"hose": Specimen("hose")}, marks={})
    (remark,) = map(str, history_remarks(surveys[0], earlier_tests_of(surveys, {}), campaign))
    assert remark.endswith("the effect of earlier tests is not known. Set order")


def loaded(*loads, **told):
    """Tests A, B, ... of one specimen in order, each up to a load [N]; nothing of it where None."""
    surveys = [survey(name, place, **told) for place, name in enumerate("ABCDEF"[: len(loads)])]
    return [
        one if load is None
        else replace(one, extremes=replace(one.extremes, greatest_tension={"hose": load}))
        for one, load in zip(surveys, loads, strict=True)
    ]  # fmt: skip


def after_greater(surveys):
    campaign = SimpleNamespace(specimens={"hose": Specimen("hose")}, marks={})
    past = earlier_tests_of(surveys, {})
    remarks = [one for entry in surveys for one in history_remarks(entry, past, campaign)]
    assert {one.severity for one in remarks} <= {"note"}
    return [
        (one.numbers["test"], one.numbers["earlier"], one.numbers["tension"])
        for one in remarks
        if one.code == "after-a-greater-load"
    ]


def test_a_test_after_a_greater_load_than_its_own_says_which_and_how_great():
    # CG-D-39-80, App. D: K_0 "is affected by rate of loading, the maximum loading" and the rest
    assert after_greater(loaded(300.0, 900.0, 600.0, 950.0, 890.0)) == [
        ("B", 900.0, 600.0), ("D", 950.0, 890.0),
    ]  # fmt: skip
    # 2 % apart is the same load, and the first test and ever greater ones have none before
    assert after_greater(loaded(900.0, 885.0, 1000.0)) == []


def test_no_load_is_called_the_greatest_where_one_is_not_known():
    assert after_greater(loaded(900.0, None, 600.0)) == []


def slipped(surveys, *tests_of_marks):
    campaign = SimpleNamespace(
        specimens={"hose": Specimen("hose")},
        marks={"hose": SimpleNamespace(test=tests_of_marks)} if tests_of_marks else {},
    )
    past = earlier_tests_of(surveys, {})
    return [history_of(entry, past, campaign).splices_slipped_by[0] for entry in surveys]


def test_slips_count_for_every_later_test_but_those_with_marks_of_their_own():
    surveys = [survey(name, place) for place, name in enumerate("ABCD", 1)]
    surveys[1].slips = {"hose": [SpliceSlip(60.0, 0.03), SpliceSlip(90.0, 0.02)], "other": []}
    assert slipped(surveys) == pytest.approx([0, 0, 0.05, 0.05])
    # its own marks were read with the splices as they are
    assert slipped(surveys, "A", "C") == pytest.approx([0, 0, 0, 0.05])


def test_a_part_of_a_log_comes_after_the_slips_before_its_first_row():
    whole, early, late = survey("A", 1), survey("A1", None), survey("A2", None)
    whole.slips = {"hose": [SpliceSlip(60.0, 0.03), SpliceSlip(90.0, 0.02)]}
    for part, begin in ((early, 0.0), (late, 70.0)):
        part.plan, part.first_time = replace(part.plan, part_of="A"), begin
    assert slipped([whole, early, late]) == pytest.approx([0, 0, 0.03])


def test_a_later_test_is_told_the_slip_that_the_test_itself_found():
    # few readings of sharp turns: the highest one is not the peak
    cycle = np.arange(80 * 20) / 20.3
    position = 6 + 3 * (1 - np.abs(1 - 2 * (cycle % 1)))
    slipped = 0.1 * np.clip(cycle - 40, 0, 1)
    stretch = position - slipped - 5
    tension = 600 * stretch + 50 * stretch**2 + 50 * np.sin(2 * np.pi * cycle)
    tension += np.random.default_rng(2).normal(0, 5, cycle.size)
    record = Record(
        "T-1", ("hose",), 10 * cycle, position, tension[None],
        np.zeros((1, cycle.size), np.uint16), np.zeros(cycle.size, np.uint16),
    )  # fmt: skip
    settings = ReductionSettings(cycles=CycleSettings(waveform="triangular"))
    located = locate(record, kind="cyclic", settings=settings)
    told = _splice_slips(located, SimpleNamespace(settings=settings))["hose"]
    model = StrainModel("hose", "gauge-length", {"gauge_length": 5.0, "reference_position": 5.0})
    own = reduce_test(
        located, description=TestDescription("c", "T-1", "cyclic", "position", "triangular", 1, {}),
        specimens=(Specimen("hose", "rope", diameter=(0.02,)),), models=(model,), history=None,
        sources=(), settings=settings, settings_json="{}",
    ).slips  # fmt: skip
    assert [one.length for one in told] == own.slip_length.tolist()
    assert own.slip_length == pytest.approx([0.1], rel=0.1)


@pytest.mark.parametrize(("let_go", "spliced"), [(0.3, True), (0.0, True), (0.3, False)])
def test_a_slip_within_a_few_cycles_is_the_fall_of_their_mean_tension(let_go, spliced):
    cycle = np.arange(12 * 40 + 10) / 40.3
    position = 6 + 3 * (1 - np.abs(1 - 2 * (cycle % 1)))
    stretch = position - let_go * (cycle > 6.4) - 5
    tension = 600 * stretch + 50 * stretch**2 + np.random.default_rng(2).normal(0, 2, cycle.size)
    record = Record(
        "T-1", ("hose",), 10 * cycle, position, tension[None],
        np.zeros((1, cycle.size), np.uint16), np.zeros(cycle.size, np.uint16),
    )  # fmt: skip
    plan = survey("T-1", 1).plan
    located = locate(record, kind="cyclic", settings=plan.settings)
    told = _splice_slips(located, plan, ("hose",) if spliced else ())
    lengths = [slip.length for slip in told.get("hose", ())]
    # of a curve that stiffens, the slope of the whole stroke is not that of its middle
    assert lengths == (pytest.approx([let_go], rel=0.3) if let_go and spliced else [])


def test_marks_before_and_after_a_slip_that_are_used_together_are_told():
    surveys = [survey(name, place) for place, name in enumerate("ABC", 1)]
    surveys[1].slips = {"hose": [SpliceSlip(60.0, 0.05)]}

    def told(*tests):
        near, free = np.full(1 + len(tests), 0.6), np.linspace(2.5, 4.0, 1 + len(tests))
        marks = SpliceMarks(
            "hose", ("A", *tests), ("slack", *("min",) * len(tests)), near, near + free,
            near + free + 0.6,
        )  # fmt: skip
        return [(one.code, one.numbers["test"]) for one in _across_slip(marks, surveys)]

    assert told("A", "C") == [("marks-across-slip", "B")]
    # those of a test are read before its cycles
    assert told("A", "B") == told("C") == []


# what the settings of a product hold: all that it rests on beside its own log

TAPE = SpliceMarks(
    "new", ("P", "P"), ("slack", "min"), near_toe=np.array([0.6, 0.7]),
    far_toe=np.array([3.2, 5.2]), far_thimble=np.array([3.7, 5.9]), reading_uncertainty=0.001,
)  # fmt: skip
MODEL = StrainModel(
    "new", "tension-driven", {"relaxed_free_length": 2.6}, mark_test=("P", "P"),
    mark_hold=("slack", "min"), mark_position=TAPE.far_thimble,
    mark_tension=np.array([np.nan, 380.0]), mark_load_cell=("A", "A"),
)  # fmt: skip


def settings(*, tape=TAPE, model=MODEL, of_pull=MODEL, load_cell="A"):
    plan = TestPlan(
        id="R", kind="cyclic", files=(("R.csv", "logger"),), specimens=("new",), order=None,
        control="position", waveform="triangular", target_strain=(),
        attributes={"load_cell": load_cell}, settings=ReductionSettings(), log="R", step_place=0,
    )  # fmt: skip
    campaign = SimpleNamespace(
        id="c", attributes={}, uncertainty=StatedErrors(tension_gain=0.01), marks={"new": tape},
        layouts={"logger": SimpleNamespace(model_dump=lambda **_: {})},
        specimens={"new": Specimen("new")},
        experiments={"e": SimpleNamespace(runs={"R": ()}, quasi_static={"new": "P"})},
    )  # fmt: skip
    pull = SimpleNamespace(
        curve_coefficient=np.zeros(4),
        strain_coefficient=np.zeros(4),
        tension_low=1.0,
        tension_high=2.0,
    )
    origin = PullOrigin(InstrumentErrors("new"), of_pull)
    return _settings_json(campaign, Survey(plan), [model], None, [pull], [origin])


CELLS = replace(MODEL, mark_load_cell=("A", "B"))


@pytest.mark.parametrize(
    "change",
    [
        {"tape": replace(TAPE, reading_uncertainty=0.002)},
        {"tape": replace(TAPE, splice_creep=0.08)},
        {"tape": replace(TAPE, near_toe=np.array([0.6, 0.71]))},
        {"model": CELLS},
        {"model": replace(MODEL, by_marks=replace(MODEL, method="mixed"))},
        {"of_pull": CELLS},
        {"load_cell": "C"},
    ],
)
def test_what_moves_the_uncertainty_of_a_number_is_in_the_settings(change):
    assert settings(**change) != settings()


def test_settings_have_every_reading_as_it_was_made_and_no_digit_that_was_computed_of_them():
    found = json.loads(settings())
    strain = found["strain"]["new"]
    assert strain["tape"] == {
        "standard_uncertainty": 0.001,
        "splice_creep": 0.02,
        "readings": [["P", "slack", 0.6, 3.2, 3.7], ["P", "min", 0.7, 5.2, 5.9]],
    }
    assert strain["marks"] == [["P", "slack", 3.7, None, "A"], ["P", "min", 5.9, 380.0, "A"]]
    assert found["quasi_static"]["new"]["strain"] == strain
    assert found["instruments"] == {
        "new": {
            "splice_friction": 0.0,
            "tension": "A, channel 1",
            "crosshead_position": "crosshead",
        }
    }


def test_a_model_without_marks_rests_on_no_tape():
    length = StrainModel("new", "gauge-length", {"gauge_length": 2.6})
    assert "tape" not in json.loads(settings(model=length))["strain"]["new"]


# by what names tests share the errors of their strain models

# lengths of WHOI-2005-10, Table 3, new tether, in feet; the slack row of T-2 reads otherwise
MARKS = SpliceMarks(
    "new", ("T-1", "T-1", "T-1", "T-2"), ("slack", "min", "max", "slack"),
    near_toe=np.array([2.06, 2.42, 2.69, 2.06]), far_toe=np.array([10.44, 17.22, 21.72, 10.48]),
    far_thimble=np.array([12.26, 19.37, 24.12, 12.26]),
)  # fmt: skip
METHODS = ("tension-driven", "marks", "strain-ratio", "constant-fraction", "gauge-length")
CAMPAIGN = SimpleNamespace(
    uncertainty=StatedErrors(), specimens={"new": Specimen("new", gauge_length=8.4)}
)


def model_of(log, method):
    return fit_strain_model(
        CAMPAIGN.specimens["new"], test_id=log, marks=MARKS,
        mark_tension=np.array([0.0, 380.0, 600.0, 0.0]), settings=StrainSettings(method=method),
        zero=ZeroStrain(0.0),
    )  # fmt: skip


def instruments_by(log, model, **found):
    plan = TestPlan(
        id=log, kind="cyclic", files=((f"{log}.csv", "logger"),), specimens=("new",), order=None,
        control="position", waveform="triangular", target_strain=(), attributes={},
        settings=ReductionSettings(), log=log, step_place=0,
    )  # fmt: skip
    return instruments_of(CAMPAIGN, Survey(plan, **found), [model])[0]


def name_of(log, model):
    return instruments_by(log, model).strain_model


def test_models_of_one_name_have_the_same_coefficients():
    """Three tests: one with marks of its own, one with a slack row alone, two without any."""
    coefficients = {}
    for log in ("T-1", "T-2", "T-3", "T-4"):
        for method in METHODS:
            model = model_of(log, method)
            name = name_of(log, model)
            assert coefficients.setdefault(name, model.coefficients) == model.coefficients
            assert name.startswith(f"new, {method}")
    assert len(coefficients) > len(METHODS)


@pytest.mark.parametrize("method", METHODS)
def test_tests_without_marks_of_their_own_share_what_is_pooled(method):
    names = {name_of(log, model_of(log, method)) for log in ("T-3", "T-4")}
    assert names == {f"new, {method}"}


@pytest.mark.parametrize(
    ("log", "method", "name"),
    [
        ("T-1", "tension-driven", "new, tension-driven"),
        ("T-1", "marks", "new, marks, marks of T-1"),
        ("T-2", "marks", "new, marks"),
        ("T-2", "constant-fraction", "new, constant-fraction, marks of T-2"),
    ],
)
def test_a_name_says_specimen_method_and_the_test_whose_marks_they_are(log, method, name):
    assert name_of(log, model_of(log, method)) == name


@pytest.mark.parametrize(("length", "zero"), [(None, 0.0), (3.7, 3.7)])
def test_the_scale_of_a_displacement_reads_zero_at_its_reference_length(length, zero):
    errors = instruments_by("T-1", model_of("T-1", "gauge-length"), reference_length=length)
    assert errors.position_of_scale_zero == zero


@pytest.mark.parametrize(("diameter", "error"), [((), 0.0), ((0.026,), 5e-5)])
def test_a_stated_error_of_diameters_is_one_of_specimens_that_have_a_diameter(
    monkeypatch, diameter, error
):
    """A rope without one, in a campaign with tethers, has no stress for it to change."""
    new = Specimen("new", gauge_length=8.4, diameter=diameter)
    monkeypatch.setattr(CAMPAIGN, "specimens", {"new": new})
    monkeypatch.setattr(CAMPAIGN, "uncertainty", StatedErrors(diameter=5e-5))
    assert instruments_by("T-1", model_of("T-1", "gauge-length")).diameter == error

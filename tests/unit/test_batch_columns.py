"""Warnings of columns, files and marks that are named twice, or of another specimen."""

from types import SimpleNamespace

import numpy as np
import pytest

from reduction.batch.plausibility import (
    _copied_marks,
    _of_absent,
    _of_columns,
    _of_dates,
    _of_pairs,
    _of_swapped,
    _off_other_specimens,
)
from reduction.pipeline.extremes import Extremes
from reduction.readers.layout import Layout
from reduction.record.measurement import Specimen, SpliceMarks


def layout(load, *, position="Position", time="Time", sheet=1):
    channels = {
        "time": {"column": time, "unit": "s"},
        "crosshead_position": {"column": position, "unit": "mm", "datum": "pin-to-pin"},
        "tension.1": {"column": load, "unit": "kN"},
    }
    return Layout.model_validate({"format": "spreadsheet", "sheet": sheet, "channels": channels})


def survey(name, layout="log", specimen="b", digest="0" * 64):
    plan = SimpleNamespace(
        id=name, log=name, files=((None, layout),), specimens=(specimen,), failed=False,
        step_place=None, step_range=None,
    )  # fmt: skip
    sources = (SimpleNamespace(sha256=digest),)
    return SimpleNamespace(plan=plan, sources=sources, levels=None, extremes=Extremes())


@pytest.mark.parametrize(
    ("columns", "n_notes"),
    [
        # every column of a machine begins with the number of its station
        ({"load": "C_1_Force[kN]", "position": "C_1_Way[mm]", "time": "C_1_Time[s]"}, 0),
        ({"load": "Force C", "position": "Way", "time": "Time"}, 1),
    ],
)
def test_what_stands_before_every_column_is_no_name_of_a_specimen(columns, n_notes):
    campaign = SimpleNamespace(layouts={"log": layout(**columns)}, specimens={"b": None, "c": None})
    assert len(list(_of_columns(campaign, survey("T-1")))) == n_notes


def test_two_sheets_of_a_workbook_are_two_logs_and_one_sheet_twice_is_one():
    sheets = {"one": layout("Force", sheet="9 mm"), "two": layout("Force", sheet="7 mm")}
    campaign = SimpleNamespace(layouts=sheets)
    apart = [survey("T-1", "one"), survey("T-2", "two")]
    assert list(_of_pairs(campaign, apart, {})) == []
    # of two nothing tells which has the wrong file
    found = list(_of_pairs(campaign, [survey("T-1", "one"), survey("T-2", "one")], {}))
    assert [(test, one.code, one.numbers["other"]) for test, one in found] == [
        ("T-2", "log-used-twice", "T-1"), ("T-1", "log-used-twice", "T-2"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("ranges", "n_notes"),
    [([(0.0, 60.0), (60.0, 90.0)], 0), ([(0.0, 60.0), (50.0, 90.0)], 2), ([(0.0, 60.0), None], 2)],
)
def test_steps_of_one_file_in_two_tests_are_told_only_where_they_overlap(ranges, n_notes):
    tests = [survey("T-1"), survey("T-2")]
    for one, own in zip(tests, ranges, strict=True):
        one.plan.step_range = own
    campaign = SimpleNamespace(layouts={"log": layout("Force")})
    assert len(list(_of_pairs(campaign, tests, {}))) == n_notes


def test_a_log_that_was_exported_twice_is_told():
    campaign = SimpleNamespace(layouts={"log": layout("Force")})
    tests = [survey(f"T-{place}", digest=str(place) * 64) for place in range(3)]
    position = np.linspace(3.7, 7.4, 50)
    for one, slope in zip(tests, (100.0, 100.0, 100.1), strict=True):
        samples = SimpleNamespace(position=position, tension=slope * (position - 3.7))
        one.extremes = SimpleNamespace(all_over={"b": samples})
    found = list(_of_pairs(campaign, tests, {}))
    assert {one.code for _, one in found} == {"readings-used-twice"}
    assert [(test, one.numbers["other"]) for test, one in found] == [("T-1", "T-0"), ("T-0", "T-1")]


def pulled(order, strain, tension, kind="cyclic"):
    """A test of one specimen that went so far; rubber by no law, numbers that are written down."""
    one = survey(f"T-{order}", digest=f"{order:064d}")
    one.plan.kind, one.plan.order, one.plan.control = kind, order, "position"
    one.levels = SimpleNamespace(frequency=0.1)
    one.extremes = Extremes(
        is_stepwise=True, greatest_measured_strain={"b": strain}, greatest_tension={"b": tension}
    )
    return one


@pytest.mark.parametrize(
    ("kind", "last", "told"),
    [
        # half, as WHOI-2005-10 found
        ("rubber tether", (2.0, 500.0), [("T-6", "softer-by-stretch")]),
        # newtons for pounds
        ("rubber tether", (2.0, 220.0), [("T-6", "stiffness-jumps")]),
        # grows stiffer with the load that it has seen
        ("rope", (2.0, 500.0), [("T-6", "stiffness-jumps")]),
        # not stretched further before
        ("rubber tether", (2.7, 900.0), [("T-5", "stiffness-jumps"), ("T-6", "stiffness-jumps")]),
    ],
)
def test_rubber_that_was_stretched_further_before_may_be_softer(kind, last, told):
    campaign = SimpleNamespace(
        layouts={"log": layout("Force")}, specimens={"b": Specimen(name="b", kind=kind)}
    )
    virgin = [(1.25, 550.0), (1.5, 700.0), (1.75, 850.0), (2.0, 1050.0), (2.75, 2000.0)]
    tests = [pulled(order, *one) for order, one in enumerate([*virgin, last], start=1)]
    found = list(_of_pairs(campaign, tests, {}))
    assert [(test, one.code) for test, one in found] == told


def tape(specimen, *readings, holds=("slack", "slack", "min", "max")):
    near, far, thimble = np.array(readings, dtype=float).T
    return SpliceMarks(specimen, ("T",) * near.size, holds[-near.size :], near, far, thimble)


_READ = [(0.63, 3.18, 3.74), (0.63, 3.19, 3.74), (0.75, 5.24, 5.90), (0.81, 6.63, 7.35)]


@pytest.mark.parametrize(
    ("readings", "strain", "n_notes"),
    [
        (_READ, 0.0, 1),
        (_READ, 0.03, 0),  # what the specimens differ by is stated
        ([(0.62, 3.20, 3.75), *_READ[1:]], 0.0, 1),  # slack read on each, the others copied
        ([*_READ[:3], (0.80, 6.64, 7.35)], 0.0, 0),
        (_READ[2:], 0.0, 0),  # two rows can be equal by chance
    ],
)
def test_marks_that_were_read_on_another_specimen_are_told(readings, strain, n_notes):
    marks = {"A": tape("A", *_READ), "B": tape("B", *readings)}
    campaign = SimpleNamespace(marks=marks, uncertainty=SimpleNamespace(strain_gain=strain))
    found = _copied_marks(campaign)
    assert list(found) == ["B"] * n_notes
    assert all(one.code == "marks-of-another" for one in found.values())
    assert all("those of A" in str(one) for one in found.values())


@pytest.mark.parametrize(("specimens", "told"), [(("A",), []), (("C", "D"), ["marks-of-absent"])])
def test_marks_that_were_read_in_a_test_of_other_specimens_are_told(specimens, told):
    survey = SimpleNamespace(plan=SimpleNamespace(log="T", specimens=specimens))
    found = list(_of_absent(SimpleNamespace(marks={"A": tape("A", *_READ)}), survey))
    assert [one.code for one in found] == told
    assert all(
        "A: 4 of its marks" in str(one) and "whose specimens are C and D" in str(one)
        for one in found
    )


@pytest.mark.parametrize(
    ("dates", "told"),
    [
        (("2026-03-15", "2026-03-15", "2026-02-01", "2026-03-16"), ["T-3"]),
        (("2026-05-15", "2026-03-15", "2026-03-15", "2026-03-16"), ["T-1"]),
        (("2026-03-15", "2026-03-15", "2026-03-16", ""), []),
        (("spring", "2026-03-15", "2026-03-15", "2026-03-16"), []),
    ],
)
def test_a_date_against_the_order_of_the_tests_is_told(dates, told):
    surveys = [
        SimpleNamespace(plan=SimpleNamespace(
            id=f"T-{order}", order=order, attributes={"date": date}, specimens=("A", "B")))
        for order, date in enumerate(dates, start=1)
    ]  # fmt: skip
    assert [test for test, _ in _of_dates(surveys)] == told


def pulled_together(*ratios):
    """Tests T-1, ... of the specimens A and B, with the peaks of B over those of A."""
    return [
        SimpleNamespace(
            plan=SimpleNamespace(id=f"T-{place}", specimens=("B", "A")),
            extremes=Extremes(greatest_tension={"A": 400.0, "B": 400.0 * ratio}),
        )
        for place, ratio in enumerate(ratios, start=1)
    ]


@pytest.mark.parametrize(
    ("ratios", "told"),
    [
        ((1.13, 0.885, 1.14, 1.16), ["T-2"]),
        ((1.13, 1.12, 1.14, 1.16), []),
        ((1.02, 0.98, 1.02, 1.02), []),  # too alike
        ((1.14, 1.09, 1.12, 0.95), []),  # a new and a worn one, at more stretch from test to test
        ((1.13, 0.885, 1.14), []),  # too few
    ],
)
def test_specimens_that_are_swapped_in_one_of_their_tests_are_told(ratios, told):
    found = list(_of_swapped(pulled_together(*ratios)))
    assert [test for test, _ in found] == told
    assert all("B: its peak is 0.885 times that of A, and 1.14 times in their 3 other" in str(one)
               for _, one in found)  # fmt: skip


def five_specimens(stiffness, *, material="rubber", kind="elastomer"):
    """Five specimens, pulled once each to a strain of 1; of the first the stiffness is given."""
    tests, specimens = {}, {}
    for place, one in enumerate((stiffness, 400.0, 450.0, 500.0, 550.0)):
        name = f"S-{place}"
        plan = SimpleNamespace(
            id=f"T-{place}", kind="cyclic", order=1, control="position", attributes={}
        )
        extremes = Extremes(
            greatest_tension={name: one}, greatest_measured_strain={name: 1.0}, is_stepwise=True
        )
        levels = SimpleNamespace(frequency=0.1)
        tests[name] = [SimpleNamespace(plan=plan, extremes=extremes, levels=levels)]
        made = material if place == 0 else "rubber"
        specimens[name] = Specimen(name=name, kind=kind, diameter=(0.025,), material=made)
    return SimpleNamespace(specimens=specimens), tests


def pulled_to(name, order, load, strain, *, is_ordered=True, **conditions):
    """A cyclic test between set loads."""
    plan = SimpleNamespace(
        id=f"{name}-{order}", log=f"{name}-{order}", kind="cyclic",
        order=order if is_ordered else None, control="load", attributes=conditions,
        specimens=(name,), failed=False, step_place=None, step_range=None, files=((None, "log"),),
    )  # fmt: skip
    extremes = Extremes(
        greatest_tension={name: load}, greatest_measured_strain={name: strain}, is_stepwise=True
    )
    return SimpleNamespace(
        plan=plan, sources=(SimpleNamespace(sha256=plan.id),), extremes=extremes,
        levels=SimpleNamespace(frequency=0.1),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("stiffness", "material", "n_notes"),
    [
        (460.0 * 4.448, "rubber", 1),
        (460.0 / 4.448, "rubber", 1),
        (460.0 * 4.448, "hard rubber", 0),
        (460.0 * 1.8, "rubber", 0),
    ],
)
def test_a_specimen_unlike_most_others_of_its_make_is_told(stiffness, material, n_notes):
    campaign, tests = five_specimens(stiffness, material=material)
    found = dict(_off_other_specimens(campaign, tests, {}))
    assert list(found) == ["T-0"][:n_notes]
    for one in found.values():
        unit = "lbf for N" if stiffness > 1000 else "N for lbf"
        assert "4 of 4 other specimens" in str(one) and unit in str(one)


@pytest.mark.parametrize(
    ("scatter", "share", "n_notes"),
    [
        (0.03, (10 / 12) ** 2, 2),  # 10 mm rope as 12 mm
        (0.03, 0.85, 0),
        (0.10, (10 / 12) ** 2, 0),  # within eight times the scatter of the others
    ],
)
def test_one_of_a_batch_is_judged_by_the_scatter_of_the_others(scatter, share, n_notes):
    sizes = np.append(share, 1 + scatter * np.array([-1, 0.3, 1, -0.5, 1.2, -1.1, 0.1]))
    specimens, surveys = {}, []
    for place, size in enumerate(sizes):
        name = f"rope-{place}"
        specimens[name] = Specimen(name=name, kind="rope", diameter=(0.012,))
        for order, load in ((1, 12e3), (2, 18e3)):
            surveys.append(pulled_to(name, order, load, 1e-5 * load / size))
    campaign = SimpleNamespace(specimens=specimens, layouts={"log": layout("Force")})
    found = list(_of_pairs(campaign, surveys, {}))
    told = [("rope-0-1", "stiffness-off-others"), ("rope-0-2", "stiffness-off-others")]
    assert [(test, one.code) for test, one in found] == told[:n_notes]


@pytest.mark.parametrize(("gain", "told"), [(1.15, ["rope-3-2"]), (1.05, [])])
def test_one_test_of_a_batch_is_judged_by_the_ratio_to_the_other_tests_of_its_specimen(gain, told):
    """The ropes scatter by 10 %, the ratio of two tests of one rope by 0.5 %."""
    generator = np.random.default_rng(1)
    specimens, surveys = {}, []
    for place, size in enumerate(np.linspace(0.85, 1.15, 9)):
        name = f"rope-{place}"
        specimens[name] = Specimen(name=name, kind="rope", diameter=(0.012,))
        for order, load in ((1, 12e3), (2, 18e3), (3, 24e3)):
            is_wrong = (place, order) == (3, 2)
            strain = 1e-5 * load / size * generator.normal(1, 0.005) * (gain if is_wrong else 1)
            surveys.append(pulled_to(name, order, load, strain))
    campaign = SimpleNamespace(specimens=specimens, layouts={"log": layout("Force")})
    found = list(_of_pairs(campaign, surveys, {}))
    assert [(test, one.code) for test, one in found] == [
        (test, "stiffness-off-own-tests") for test in told
    ]
    assert all(one.numbers["ratio"] == pytest.approx(1 / gain, rel=0.02) for _, one in found)


@pytest.mark.parametrize("is_ordered", [True, False])
@pytest.mark.parametrize("odd", ["cycles", "medium", "first test", "nothing"])
def test_what_the_history_or_the_conditions_explain_is_no_other_rope(is_ordered, odd):
    """Ten ropes that bed in by 14 % to 23 %; two are 30 % stiffer, as after many cycles, or wet."""
    specimens, surveys = {}, []
    for place, bedding in enumerate(np.linspace(1.14, 1.23, 10)):
        name, is_odd = f"rope-{place}", place in (3, 7)
        cycles = 10_000 if is_odd and odd == "cycles" else None
        specimens[name] = Specimen(name=name, kind="rope", diameter=(0.012,), earlier_cycles=cycles)
        told = {"medium": "wet"} if is_odd and odd == "medium" else {}
        for order, load in enumerate((12e3, 12e3, 24e3), 1):
            strain = 1e-5 * load / (1.3 if is_odd and odd in ("cycles", "medium") else 1.0)
            if odd == "first test" and order == 1:
                strain *= bedding
            surveys.append(pulled_to(name, order, load, strain, is_ordered=is_ordered, **told))
    campaign = SimpleNamespace(specimens=specimens, layouts={"log": layout("Force")})
    assert not list(_of_pairs(campaign, surveys, {}))


def test_hoses_of_another_angle_are_not_told():
    campaign, tests = five_specimens(460.0 * 4.448, kind="stretch hose")
    assert not list(_off_other_specimens(campaign, tests, {}))


def test_a_log_of_another_rope_is_told_at_the_load_of_the_others_and_its_neighbours_are_not():
    """Five ropes go to 12, 18 and 18 kN; one log of the last is that of a rope 2.6 times as stiff.

    It ends at the load of the others, but at a strain that none of them has.
    """
    specimens, surveys = {}, []
    for place in range(5):
        name = f"rope-{place}"
        specimens[name] = Specimen(name=name, kind="rope", diameter=(0.012,), material="nylon")
        strains = (0.122, 0.164 / (2.6 if place == 4 else 1.0), 0.167)
        for order, (load, strain) in enumerate(zip((12e3, 18e3, 18e3), strains, strict=True), 1):
            surveys.append(pulled_to(name, order, load, strain))
    campaign = SimpleNamespace(specimens=specimens, layouts={"log": layout("Force")})
    found = list(_of_pairs(campaign, surveys, {}))
    assert [(test, one.code) for test, one in found] == [("rope-4-2", "stiffness-off-others")]
    assert "4 of 4 other specimens" in str(found[0][1])
    # without the others, nothing tells which of the two at one load is wrong
    alone = list(_of_pairs(campaign, surveys[-3:], {}))
    assert [(test, one.code) for test, one in alone] == [
        ("rope-4-2", "stiffness-jumps"), ("rope-4-3", "stiffness-jumps"),
    ]  # fmt: skip

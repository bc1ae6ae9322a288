"""None"""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from assemblies import DRIVEN
from refusals import refusals

from reduction.lines.assembly import SeriesPart, _assemble, _equal_tethers, _Tether
from reduction.lines.composite import (
    LEAST_SLOPE,
    CompositeRule,
    CurvePiece,
    _composite_curve,
    mean_piece,
    piece_of_pull,
    piece_of_steps,
    pieces_of_branches,
)
from reduction.record.contributions import Component, Contributions, InstrumentErrors
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import StepReadings
from reduction.stages.moduli.stepwise_test import reduce_stepwise
from reduction.stages.strain.strain_model import StrainModel
from reduction.uncertainty.propagation import stepwise_contributions


def law(strain):
    """Tension of a rubber that softens and stiffens [N]: made up, monotone, zero at zero."""
    return 600 * strain - 150 * strain**2 + 45 * strain**3


def piece(low, high, name="T", kind="cyclic", factor=1.0, spread=0.5, n=41, of=law):
    at = np.linspace(low, high, n)
    return CurvePiece(name, kind, "mean", at, factor * of(at), np.full(n, spread))


def test_one_piece_is_returned_as_it_is():
    curve = _composite_curve([piece(0.4, 2.0)])
    at = np.linspace(0.4, 2.0, 41)
    assert curve.tension_at(at) == pytest.approx(law(at), rel=1e-12)
    assert not curve.is_moved.any()
    assert not curve.is_join.any()
    assert np.nanmax(np.abs(curve.monotone_change)) == 0
    assert np.isnan(curve.between_pieces)
    assert "no two pieces of one kind overlap" in curve.notes[-1]


def test_windows_of_one_law_give_the_law_over_the_whole_range():
    curve = _composite_curve([piece(0.3, 1.2), piece(0.8, 2.0), piece(1.9, 3.0)])
    at = np.linspace(0.3, 3.0, 200)
    assert curve.tension_at(at) == pytest.approx(law(at), rel=2e-3)
    assert not curve.is_gap[2:].any()


def test_noise_of_the_pieces_is_covered_by_the_uncertainty():
    rng = np.random.default_rng(7)
    pieces = []
    for low, high in ((0.3, 1.2), (0.8, 2.0), (1.7, 3.0)):
        at = np.linspace(low, high, 60)
        noisy = law(at) * (1 + 0.03 * rng.normal()) + rng.normal(0, 1.0, at.size)
        pieces.append(CurvePiece("T", "cyclic", "mean", at, noisy, np.ones(at.size)))
    curve = _composite_curve(pieces)
    inner = curve.piece >= 0
    z = (curve.tension - law(curve.strain))[inner] / curve.standard_uncertainty[inner]
    assert np.sqrt(np.mean(z**2)) < 1.5
    assert np.abs(curve.tension[inner] / law(curve.strain[inner]) - 1).max() < 0.08


def test_it_begins_at_zero_and_the_extension_is_a_gap_on_a_straight_line():
    curve = _composite_curve([piece(0.5, 1.0)])
    assert (curve.strain[0], curve.tension[0], curve.standard_uncertainty[0]) == (0, 0, 0)
    assert curve.is_gap.tolist()[:2] == [True, True]
    assert not curve.is_gap[2:].any()
    assert curve.tension_at(0.25) == pytest.approx(law(0.5) / 2)
    assert curve.tension_at([-0.1, 1.5]).tolist()[0] == 0
    assert np.isnan(curve.tension_at(1.5))
    assert np.isnan(curve.strain_at(-1.0))


@pytest.mark.parametrize(("power", "truth"), [(2, 25.0), (3, 12.5)])
def test_doubt_of_the_extension_is_a_third_of_the_triangle_of_chord_and_tangent(power, truth):
    # chord 100 N per strain, tangent 200 or 300, which is cut at zero: 50 N below at half the way
    curve = _composite_curve([piece(1.0, 2.0, of=lambda at: 100 * at**power, spread=0.0, n=4001)])
    assert curve.standard_uncertainty[1] == pytest.approx(50 / np.sqrt(3), rel=0.02)
    assert abs(curve.tension[1] - truth) < 1.5 * curve.standard_uncertainty[1]


def test_a_tangent_near_the_chord_leaves_little_doubt():
    curve = _composite_curve([piece(1.0, 2.0, of=lambda at: 100 * at ** (1.2), spread=0.0, n=4001)])
    assert curve.standard_uncertainty[1] == pytest.approx(10 / np.sqrt(3), rel=0.02)


def test_what_was_moved_is_in_the_uncertainty_in_full():
    # two windows that do not overlap and have no uncertainty: nothing else is in it
    curve = _composite_curve([piece(0.5, 1.0, spread=0.0), piece(1.2, 2.0, factor=0.5, spread=0.0)])
    nodes = curve.piece >= 0
    assert np.abs(curve.monotone_change[nodes]).max() > 10
    assert curve.standard_uncertainty[nodes] == pytest.approx(np.abs(curve.monotone_change[nodes]))


def test_gaps_are_flagged_interval_by_interval():
    curve = _composite_curve([piece(0.3, 1.0), piece(1.5, 2.0)])
    inside = (curve.strain[:-1] >= 1.0 - 1e-12) & (curve.strain[1:] <= 1.5 + 1e-12)
    assert inside.sum() == 2
    assert curve.is_gap[inside].all()
    assert curve.piece[curve.strain == 1.25].tolist() == [-1]
    assert any("no piece between strain 1 and 1.5" in note for note in curve.notes)


def test_joins_are_where_two_pieces_have_a_say():
    curve = _composite_curve([piece(0.3, 1.2), piece(0.8, 2.0)])
    middle = (curve.strain[1:] + curve.strain[:-1]) / 2
    joined = middle[curve.is_join]
    assert joined.min() == pytest.approx(0.8, abs=0.02)
    assert joined.max() == pytest.approx(1.2, abs=0.02)


def test_the_mean_has_no_jump_where_a_piece_that_differs_begins_or_ends():
    curve = _composite_curve([piece(0.3, 3.0), piece(1.0, 2.0, factor=1.15)])
    steps = np.diff(curve.tension) / np.diff(curve.strain)
    assert np.abs(np.diff(steps)).max() < 600  # a jump of 15 % of 500 N over a node is 11,000


def test_pieces_that_differ_count_alike_however_small_their_own_uncertainty():
    one, other = piece(0.5, 1.5, spread=0.01), piece(0.5, 1.5, factor=1.2, spread=1.0)
    curve = _composite_curve([one, other])
    assert curve.tension_at(1.0) == pytest.approx(1.1 * law(1.0), rel=1e-3)
    # half of 20 % of the mean, times the root of 2 of one deviation: 12.86 %
    assert curve.between_pieces == pytest.approx(0.2 / 1.1 / np.sqrt(2), rel=1e-3)
    spread = np.interp(1.0, curve.strain, curve.standard_uncertainty)
    assert spread == pytest.approx(0.2 / np.sqrt(2) * law(1.0), rel=0.01)


def test_a_kind_that_goes_before_is_alone_inside_its_range():
    static = piece(0.1, 2.5, kind="static", factor=0.8)
    first = piece(0.05, 3.0, kind="first-loading", factor=1.3)
    cyclic = piece(1.0, 2.0)
    curve = _composite_curve([first, static, cyclic])
    assert curve.tension_at(1.5) == pytest.approx(law(1.5), rel=1e-4)
    assert curve.tension_at(0.6) == pytest.approx(0.8 * law(0.6), rel=1e-3)
    assert curve.tension_at(2.9) == pytest.approx(1.3 * law(2.9), rel=1e-3)
    other = _composite_curve([first, static, cyclic], rule=CompositeRule(precedence=("static",)))
    assert other.tension_at(1.5) == pytest.approx(0.8 * law(1.5), rel=1e-3)
    assert other.piece_names == ("T",)


def test_windows_that_fall_at_their_join_are_made_to_rise_and_it_is_said():
    curve = _composite_curve([piece(0.5, 1.5), piece(1.45, 2.5, factor=0.7)])
    assert (np.diff(curve.tension) > 0).all()
    assert curve.is_moved.any()
    assert "the mean of the pieces falls where one ends" in curve.notes[-1]
    # the change is in the uncertainty
    moved = np.abs(np.nan_to_num(curve.monotone_change))
    assert (curve.standard_uncertainty >= moved - 1e-9).all()


def test_the_curve_is_nowhere_softer_than_the_share_of_the_softest_piece():
    pieces = [piece(0.5, 1.5), piece(1.0, 2.5, factor=0.7)]
    curve = _composite_curve(pieces)
    slope = np.diff(curve.tension) / np.diff(curve.strain)
    at = (curve.strain[1:] + curve.strain[:-1]) / 2
    softest = 0.7 * (600 - 300 * at + 135 * at**2)
    assert (slope[~curve.is_gap] >= 0.99 * LEAST_SLOPE * softest[~curve.is_gap]).all()


def test_rules_and_pieces_that_make_no_sense_are_refused():
    with pytest.raises(SettingsError, match="names no known kind of piece"):
        CompositeRule(precedence=())
    with pytest.raises(DataError, match="no piece is of a kind"):
        _composite_curve([piece(0.5, 1.0)], rule=CompositeRule(precedence=("static",)))
    with pytest.raises(DataError, match="no piece is of a kind.*found no pieces"):
        _composite_curve([])


def test_a_gap_is_never_level():
    """The window above begins below the end of the one before: half of the softer chord is kept."""
    low, high = np.linspace(0.5, 1.0, 30), np.linspace(1.1, 1.6, 30)
    pieces = [
        CurvePiece("T-1", "cyclic", "mean", low, 200 * low, 0 * low + 1),
        CurvePiece("T-2", "cyclic", "mean", high, 150 * (high - 0.1), 0 * high + 1),
    ]
    curve = _composite_curve(pieces)
    gap = (curve.strain > 1.0 + 1e-9) & (curve.strain < 1.1 + 1e-9)
    slope = np.diff(curve.tension_at([1.0, 1.1]))[0] / 0.1
    assert gap.any()
    assert slope == pytest.approx(0.5 * 150, rel=1e-6)


def test_rises_from_slack_that_differ_leave_the_cycles_as_certain_as_they_were():
    at, early = np.linspace(0.5, 1.0, 30), np.linspace(0.1, 0.6, 30)
    cycles = [
        CurvePiece(name, "cyclic", "mean", at, factor * at, 0 * at + 0.1)
        for name, factor in (("T-1", 100), ("T-2", 110))
    ]
    rises = [
        CurvePiece(name, "first-loading", "ascending", early, factor * early, 0 * early + 0.1)
        for name, factor in (("T-1", 100), ("T-2", 300))
    ]
    alone, both = _composite_curve(cycles), _composite_curve([*cycles, *rises])
    inner = [0.7, 0.8, 0.9]
    spread = [np.interp(inner, one.strain, one.standard_uncertainty) for one in (alone, both)]
    assert spread[1] == pytest.approx(spread[0], rel=1e-3)
    assert both.between_pieces == pytest.approx(alone.between_pieces, rel=1e-4)
    assert any("first-loading pieces differ by 70.7 %" in note for note in both.notes)


def test_stiff_loops_along_a_soft_pull_are_told_to_be_no_pieces_of_one_curve():
    """Loops of 500 N per unit strain about a pull of 100, each pair of loops alike to 2 %."""
    at = np.linspace(0.05, 1.0, 60)
    pull = CurvePiece("Q", "static", "ascending", at, 100 * at, 0 * at + 0.1)
    loops = []
    for centre in (0.3, 0.5, 0.7):
        over = np.linspace(centre - 0.04, centre + 0.04, 20)
        loops += [
            CurvePiece(
                f"R{centre}{name}", "cyclic", "mean", over,
                factor * (100 * centre + 500 * (over - centre)), 0 * over + 0.1,
            )
            for name, factor in (("a", 1.0), ("b", 1.02))
        ]  # fmt: skip
    told = "they do not belong to one curve"
    assert any(told in note for note in _composite_curve([*loops, pull]).notes)
    alone = _composite_curve([*loops, pull], rule=CompositeRule(precedence=("static",)))
    assert not any(told in note for note in alone.notes)
    windows = [piece(0.5, 1.2, "T-1"), piece(1.0, 2.0, "T-2", factor=1.1)]
    assert not any(told in note for note in _composite_curve(windows).notes)


def straight(slope, low, high, name="T-1", kind="cyclic"):
    at = np.linspace(low, high, 81)
    return CurvePiece(name, kind, "mean", at, slope * at, 0 * at)


def test_a_first_loading_has_no_say_where_loops_reach_and_carries_what_it_differs_by():
    """80 beside 100 N per unit strain: 20 of 90, which is 22.2 % of the 60 N at 0.75."""
    first = straight(80, 0.5, 1.5, "T-2", "first-loading")
    curve = _composite_curve([first, straight(100, 1.0, 2.0)])
    assert curve.tension_at([0.75, 0.95]) == pytest.approx([60.0, 76.0])
    assert curve.tension_at([1.0, 1.02, 1.5]) == pytest.approx([100.0, 102.0, 150.0])
    spread = np.interp(0.75, curve.strain, curve.standard_uncertainty)
    assert spread == pytest.approx(60 * 20 / 90, rel=1e-3)
    assert any(
        "first loadings differ by up to 22.2 % from the pieces" in note for note in curve.notes
    )
    words = [curve.piece_words[place] for place in curve.piece[curve.piece >= 0]]
    assert (words[0], words[-1]) == ("T-2 first loading", "T-1 cycles")
    at = curve.strain[curve.piece >= 0]
    assert {word for word, strain in zip(words, at, strict=True) if strain >= 1} == {"T-1 cycles"}


def test_a_stiffer_first_loading_gives_way_to_the_loops_that_begin_below_it():
    """It ends on 150 N where loops begin at 100: its 40 % are wide enough for the way down."""
    first = straight(150, 0.5, 1.4, "T-6", "first-loading")
    curve = _composite_curve([first, straight(100, 1.0, 2.0, "T-6")])
    off = np.abs(curve.tension_at(np.linspace(1.0, 2.0, 50)) / np.linspace(100, 200, 50) - 1)
    assert off.max() < 0.1
    before = np.flatnonzero((curve.piece >= 0) & (curve.strain < 1))
    assert (curve.standard_uncertainty[before] > 0.3 * curve.tension[before]).all()


@pytest.mark.parametrize(("others", "told"), [(3, ""), (5, "2.24 standard uncertainties")])
def test_a_curve_far_from_a_piece_for_its_uncertainty_is_doubtful(others, told):
    """One piece of n + 1 is n off their mean, whose deviation is the root of n: root of 5 is 2.24."""
    pieces = [straight(100, 0.5, 1.5, f"T-{place}") for place in range(others)]
    curve = _composite_curve([*pieces, straight(200, 0.5, 1.5, "T-9")])
    assert told in curve.doubt
    assert bool(curve.doubt) is bool(told)


def test_tests_of_one_kind_are_not_told_to_be_of_several():
    """Two first loadings alike to nothing, and a third that begins below the end of the others."""
    kind = "first-loading"
    pieces = [straight(slope, 0.5, 1.0, name, kind) for name, slope in (("a", 100), ("b", 100.1))]
    curve = _composite_curve(
        [*pieces, straight(50, 1.05, 1.5, "c", kind)], rule=CompositeRule(precedence=(kind,))
    )
    told = [note for note in curve.notes if "off the mean of its pieces" in note]
    assert len(told) == 1
    assert "the tests are of different states; name those that you want" in told[0]
    assert "kinds" not in told[0]


# errors that pieces share go through a composite by their sign, and weigh nothing between them

CELL, OTHER = Component("tension_gain", "A"), Component("tension_gain", "B")
ZERO = Component("tension_offset", "A")
MODEL = StrainModel("T", "gauge-length", {"reference_position": 1.0, "gauge_length": 1.0})


def piece_of_shared(slope, low, high, name="T-1", kind="cyclic", spread=0.5, **shares):
    at = np.linspace(low, high, 81)
    found = CurvePiece(name, kind, "mean", at, slope * at, np.full(81, spread))
    return with_shares(found, **shares) if shares else found


def with_shares(one, **shares):
    cells = {"a": CELL, "b": OTHER}
    rows = np.stack([share * one.tension for share in shares.values()])
    return replace(one, component=tuple(cells[name] for name in shares), contribution=rows)


PIECES = (
    piece_of_shared(100, 0.5, 1.2), piece_of_shared(120, 0.9, 2.0, "T-2"), piece_of_shared(108, 1.5, 2.6, "T-3"),
    piece_of_shared(90, 0.2, 0.9, "T-1", "first-loading"),
)  # fmt: skip


def test_a_gain_of_every_piece_moves_the_whole_curve_and_nothing_between_them():
    plain = _composite_curve(PIECES)
    gained = _composite_curve([with_shares(one, a=0.1) for one in PIECES])
    assert gained.between_pieces == pytest.approx(plain.between_pieces, rel=1e-12)
    assert gained.tension == pytest.approx(plain.tension, rel=1e-12)
    assert gained.doubt == plain.doubt
    assert gained.random_standard_uncertainty == pytest.approx(plain.standard_uncertainty)
    assert gained.component == (CELL,)
    assert gained.contribution == pytest.approx(0.1 * gained.tension[None])
    both = np.hypot(plain.standard_uncertainty, 0.1 * plain.tension)
    assert gained.standard_uncertainty == pytest.approx(both)


def test_the_contribution_of_a_gain_is_what_scaled_logs_would_change():
    step = 1e-3
    gained = _composite_curve([with_shares(one, a=step) for one in PIECES])
    scaled = _composite_curve([replace(one, tension=(1 + step) * one.tension) for one in PIECES])
    assert scaled.tension - gained.tension == pytest.approx(gained.contribution[0], rel=1e-6)


def test_a_zero_of_the_cell_goes_through_the_weights_as_shifted_logs_do():
    """Weights move with tension a little: a shift of 0.01 N of 50 to 260."""
    step = 0.01
    pieces = [
        replace(one, component=(ZERO,), contribution=np.full((1, 81), step)) for one in PIECES[:3]
    ]
    found = _composite_curve(pieces)
    shifted = _composite_curve([replace(one, tension=one.tension + step) for one in PIECES[:3]])
    nodes = (found.piece >= 0) & (found.strain > 0.5)
    moved = (shifted.tension - found.tension)[nodes]
    assert found.contribution[0, nodes] == pytest.approx(moved, rel=0.2)
    assert found.contribution[0, nodes] == pytest.approx(np.full(nodes.sum(), step), rel=0.2)


def test_two_cells_explain_part_of_what_two_pieces_differ_by():
    """20 of 110: a deviation of 12.9 %; cells good to 5 % each explain 5 % of it in each piece."""
    one, two = (
        piece_of_shared(100, 0.5, 1.5, spread=0.0),
        piece_of_shared(120, 0.5, 1.5, "T-2", spread=0.0),
    )
    alone = _composite_curve([one, two]).between_pieces
    assert alone == pytest.approx(20 / 110 / np.sqrt(2), rel=1e-6)
    cells = [with_shares(one, a=0.05), with_shares(two, b=0.05)]
    found = _composite_curve(cells)
    expected = np.sqrt(alone**2 - (0.05 * 100 * 120 / 110**2) ** 2)
    assert found.between_pieces == pytest.approx(expected, rel=1e-6)
    # each has one part of the mean, by its cell and by what is between them
    middle = np.argmin(np.abs(found.strain - 1.0))
    weight = 1 / (np.array([5.0, 6.0]) ** 2 + (expected * 110) ** 2)
    weight /= weight.sum()
    assert found.tension[middle] == pytest.approx(weight @ [100, 120], rel=1e-6)
    assert found.contribution[:, middle] == pytest.approx(weight * [5.0, 6.0], rel=1e-6)


def test_a_piece_whose_cell_is_bad_has_less_to_say_and_one_whose_error_all_share_has_not():
    one, two = (
        piece_of_shared(100, 0.5, 1.5, spread=1.0),
        piece_of_shared(104, 0.5, 1.5, "T-2", spread=1.0),
    )
    fair = _composite_curve([one, two]).tension_at(1.0)
    alike = _composite_curve([with_shares(one, a=0.1), with_shares(two, a=0.1)]).tension_at(1.0)
    assert alike == pytest.approx(fair)
    bad = _composite_curve([one, with_shares(two, b=0.2)]).tension_at(1.0)
    assert 100 < bad < fair - 1.5


def test_over_a_gap_what_both_ends_share_stays_whole():
    found = _composite_curve(
        [piece_of_shared(100, 0.5, 1.0, a=0.1), piece_of_shared(100, 1.4, 2.0, "T-2", a=0.1)]
    )
    middle = np.flatnonzero(found.is_gap[:-1] & found.is_gap[1:]) + 1
    assert found.contribution[0, middle] == pytest.approx(0.1 * found.tension[middle])
    assert found.contribution[0, 0] == 0


def test_tethers_of_one_curve_share_all_of_it_and_of_two_curves_what_their_tests_do():
    one = _Tether(_composite_curve([piece_of_shared(100, 0.5, 2.0, a=0.1, spread=4.0)]), MODEL)
    two = _Tether(_composite_curve([piece_of_shared(100, 0.5, 2.0, a=0.1, spread=4.0)]), MODEL)
    alike, apart = _assemble(_equal_tethers(one, 2)), _assemble([one, two])
    for found, random in ((alike, 8.0), (apart, 4 * np.sqrt(2))):
        both, own, shared = found.uncertainty_at(2.0)
        assert own == pytest.approx(random, rel=1e-3)
        assert shared == pytest.approx(0.1 * 200, rel=1e-6)
        assert both == pytest.approx(np.hypot(own, shared))
        assert found.component == (CELL,)
        assert found.contribution[0] == pytest.approx(0.1 * found.tension, rel=1e-6, abs=1e-9)
    assert alike.standard_uncertainty == pytest.approx(
        np.hypot(alike.random_standard_uncertainty, alike.shared_standard_uncertainty)
    )


@pytest.mark.parametrize("is_stated", [False, True])
def test_the_cell_of_the_marks_is_in_the_splices_too_and_stated_splices_know_no_cell(is_stated):
    """Logs 1 % high: the law of the splices is fitted again to loads that are 1 % high, or stated."""
    step = 0.01
    known = dict(DRIVEN.coefficients)
    if not is_stated:
        known["splice_compliance"] /= (1 + step) ** known["splice_exponent"]
    rubber = piece_of_shared(400, 0.1, 2.0, a=step)
    found = _assemble([_Tether(_composite_curve([rubber]), DRIVEN, is_stated=is_stated)])
    high = _composite_curve([replace(rubber, tension=(1 + step) * rubber.tension)])
    other = _assemble([_Tether(high, replace(DRIVEN, coefficients=known))])
    at = np.linspace(found.total_length[5], 0.98 * found.total_length[-1], 20)
    moved = other.tension_at(at) / found.tension_at(at) - 1
    rows = np.interp(at, found.total_length, found.contribution[0]) / found.tension_at(at)
    assert rows == pytest.approx(moved, rel=0.02)
    assert bool(rows[-1] > 0.999 * step) is not is_stated


def test_a_soft_part_in_line_takes_its_share_of_a_wrong_cell():
    """Half of the stretch is in the part, which is stated: half of the gain is left at one length."""
    tether = _Tether(_composite_curve([piece_of_shared(100, 0.5, 2.0, a=0.1)]), MODEL)
    found = _assemble([tether], [SeriesPart("spring", 1.0, 100.0)])
    assert found.uncertainty_at(3.0)[2] == pytest.approx(0.1 * 50 / 2, rel=1e-3)


TABLE_4 = Path(__file__).parents[1] / "golden" / "whoi_2005_10_table_4.csv"
INCH, LBF = 0.0254, 4.4482216152605


def pieces(ascending, descending, **asked):
    load = np.array([ascending, descending], dtype=float)
    strain = 0.1 * (1 + np.arange(load.shape[1]))
    return pieces_of_branches(strain, load, np.ones_like(load), name="T", **asked)


def table_4():
    with open(TABLE_4, encoding="utf-8") as lines:
        rows = list(csv.reader(line for line in lines if line[0] != "#"))[1:]
    weight, length, elongation, eye = np.array([row[1:5] for row in rows], dtype=float).T
    readings = StepReadings(
        clock=tuple(row[0] for row in rows),
        time=900.0 * np.arange(len(rows)),
        tension=LBF * weight,
        length=INCH * length,
        eye_to_eye_length=INCH * eye,
        printed_strain=elongation / 100,
        length_standard_uncertainty=0.02 * INCH,
    )
    return reduce_stepwise(readings, area=np.pi / 4 * INCH**2)


def test_static_branches_of_table_4_leave_the_row_out_that_contradicts_itself():
    up = piece_of_steps(table_4(), name="1997")
    down = piece_of_steps(table_4(), name="1997", branch="descending")
    assert up.tension / LBF == pytest.approx([51, 74, 97, 119, 141, 163, 185, 208])
    assert 100 * up.strain == pytest.approx([52, 86, 111, 135, 157, 175, 194, 210], abs=0.7)
    assert down.tension / LBF == pytest.approx([51, 97, 119, 141, 163, 185])  # without 74 lb
    # 0.02 in on 3.2 to 12.9 in of elongation, and the tension goes with it by the secant
    share = 0.02 / (6.125 * up.strain)
    assert up.random_standard_uncertainty / up.tension == pytest.approx(share, rel=0.05)


def test_the_static_test_alone_gives_85_pounds_at_a_stretch_of_100_percent_within_3_percent():
    curve = _composite_curve([piece_of_steps(table_4(), name="1997")])
    assert curve.tension_at(1.0) / LBF == pytest.approx(85, rel=0.03)  # sec. 2.3.2 prints 85


def test_a_gap_parts_a_branch_into_pieces_and_slack_is_left_out():
    found = pieces([-1, 2, 3, np.nan, 5, 6, np.nan, 8], 8 * [1.0], branch="ascending")
    assert [one.tension.tolist() for one in found] == [[2, 3], [5, 6]]
    assert found[0].strain == pytest.approx([0.2, 0.3])


def test_the_mean_of_both_branches_stands_where_both_do():
    (found,) = pieces([10, 20, 30], [np.nan, 16, 28])
    assert found.tension.tolist() == [18, 29]
    assert found.random_standard_uncertainty == pytest.approx(np.sqrt(2) / 2)


@pytest.mark.parametrize(
    ("strain", "tension", "spread", "message"),
    [
        ([0.1, 0.1], [1, 2], [0, 0], "not above the one before"),
        ([0.1], [1], [0], "is not a curve"),
        ([0.0, 0.1], [1, 2], [0, 0], "points that are slack"),
        ([0.1, 0.2], [0, 2], [0, 0], "points that are slack"),
        ([0.1, 0.2], [1, np.nan], [0, 0], "not finite"),
        ([0.1, 0.2], [1, 2], [0, np.nan], "not finite"),
        ([0.1, 0.2], [1, 2], [0, -1], "is negative"),
        ([0.1, 0.2], [1, 2], [0], "do not pair up"),
    ],
)
def test_what_is_no_curve_is_refused(strain, tension, spread, message):
    arrays = [np.array(one, dtype=float) for one in (strain, tension, spread)]
    with pytest.raises(DataError, match=message):
        CurvePiece("T", "cyclic", "mean", *arrays)


CELL_OF_PIECES, CLOCK = Component("tension_gain", "cell"), Component("lag", "clock")


def test_the_mean_of_two_branches_keeps_a_gain_whole_and_loses_a_lag():
    """A gain is in both branches with one sign, a lag with two; scatter is less by a root of 2."""
    load = np.array([[10.0, 20.0, 30.0], [6.0, 18.0, 30.0]])
    rows = np.stack([0.1 * load, np.array([[-1.0] * 3, [1.0] * 3])])
    shared = Contributions((CELL_OF_PIECES, CLOCK), {"tension": rows})
    at = [0.1, 0.2, 0.3]
    given = {"name": "T", "shared": shared}
    (mean,) = pieces_of_branches(at, load, np.ones((2, 3)), **given)
    assert mean.contribution[0] == pytest.approx(0.1 * mean.tension)
    assert mean.contribution[1] == pytest.approx(np.zeros(3))
    assert mean.random_standard_uncertainty == pytest.approx(np.full(3, np.sqrt(2) / 2))
    (down,) = pieces_of_branches(at, load, np.ones((2, 3)), branch="descending", **given)
    assert down.component == (CELL_OF_PIECES, CLOCK)
    assert down.contribution[1] == pytest.approx(np.ones(3))


def test_a_point_of_which_nothing_shared_is_known_stays_in_the_piece():
    rows = np.full((1, 2, 3), 0.5)
    rows[0, 0, 1] = np.nan
    shared = Contributions((CELL_OF_PIECES,), {"tension": rows})
    load = [[10.0, 20.0, 30.0]] * 2
    (up,) = pieces_of_branches(
        [0.1, 0.2, 0.3], load, np.ones((2, 3)), name="T", branch="ascending", shared=shared
    )
    assert up.contribution.tolist() == [[0.5, 0.0, 0.5]]


def test_contributions_have_to_fit_the_piece():
    at = np.array([0.1, 0.2])
    with pytest.raises(
        DataError, match="contributions to T do not fit.*found shape .1, 3.; needed"
    ):
        CurvePiece("T", "cyclic", "mean", at, at, 0 * at, (CELL_OF_PIECES,), np.ones((1, 3)))


def test_weights_that_are_heavier_than_they_say_move_the_static_piece_and_a_diameter_does_not():
    steps = table_4()
    area = np.pi / 4 * INCH**2
    errors = InstrumentErrors("1997", tension_gain=0.01, diameter=0.02 * INCH)
    up = piece_of_steps(steps, name="1997", shared=stepwise_contributions(steps, errors, area=area))
    rows = {one.source: row for one, row in zip(up.component, up.contribution, strict=True)}
    assert rows["tension_gain"] == pytest.approx(0.01 * up.tension)
    assert "diameter" not in rows
    # a longer gauge length is less strain at one tension: the chord has more tension at one strain
    relative = steps.gauge_length_standard_uncertainty / steps.gauge_length
    assert rows["gauge_length"] == pytest.approx(
        up.tension * (1 + up.strain) / up.strain * relative
    )


def test_branches_have_to_fit_their_grid():
    with pytest.raises(DataError, match="not that of two branches on the grid"):
        pieces_of_branches([0.1, 0.2], [1.0, 2.0], [0.1, 0.1], name="T")
    with pytest.raises(DataError, match="strain are not above the one before"):
        pieces_of_branches([0.2, 0.1], [[1.0, 2.0]] * 2, [[0.1, 0.1]] * 2, name="T")


def branch(way, low, high, slope, spread=3.0):
    at = np.linspace(low, high, 5)
    return CurvePiece("T", "static", way, at, slope * at, np.full(5, spread))


def test_the_mean_of_two_branches_stands_where_both_were_read():
    mean = mean_piece(branch("ascending", 0.5, 2.0, 110), branch("descending", 0.8, 2.2, 90, 4.0))
    assert (mean.strain[0], mean.strain[-1]) == (0.8, 2.0)
    assert mean.tension == pytest.approx(100 * mean.strain)
    assert mean.random_standard_uncertainty == pytest.approx(
        np.full(mean.strain.size, 2.5)
    )  # 3, 4, 5
    assert (mean.kind, mean.branch) == ("static", "mean")


CELL_OF_STATIC, TAPE = Component("tension_gain", "cell"), Component("gauge_length", "new")


def test_what_both_ways_share_is_whole_in_their_mean_and_what_one_has_is_half():
    up, down = branch("ascending", 0.5, 2.0, 110), branch("descending", 0.8, 2.2, 90)
    up = replace(
        up,
        component=(CELL_OF_STATIC, TAPE),
        contribution=np.stack([0.1 * up.tension, 0 * up.tension + 4]),
    )
    down = replace(down, component=(CELL_OF_STATIC,), contribution=0.1 * down.tension[None])
    mean = mean_piece(up, down)
    rows = dict(zip(mean.component, mean.contribution, strict=True))
    assert rows[CELL_OF_STATIC] == pytest.approx(0.1 * mean.tension)
    assert rows[TAPE] == pytest.approx(np.full(mean.strain.size, 2.0))


def test_a_cell_that_reads_high_makes_a_pull_stretch_too_little_and_its_tension_too_high():
    """Strain at a logged tension is 1 % less of its slope: tension at a strain is 1 % more."""
    load = np.array([100.0, 200.0, 300.0])
    strain = 1e-4 * load
    shared = Contributions((CELL_OF_STATIC,), {"strain": -0.01 * strain[None]})
    found = piece_of_pull(strain, load, np.full(3, 1e-4), name="Q", shared=shared)
    assert found.component == (CELL_OF_STATIC,)
    assert found.contribution == pytest.approx(0.01 * load[None])


def test_a_pull_ends_where_its_cubic_turns_back():
    load = np.array([0.0, 100.0, 200.0, 300.0, 400.0])
    found = piece_of_pull([0.0, 0.01, 0.02, 0.019, 0.03], load, np.full(5, 1e-4), name="Q")
    assert found.tension == pytest.approx([100, 200])


def test_a_fit_that_begins_below_zero_strain_begins_where_it_is_above():
    load = np.array([50.0, 100.0, 200.0])
    found = piece_of_pull([-0.001, 0.01, 0.02], load, np.full(3, 1e-4), name="Q")
    assert found.strain == pytest.approx([0.01, 0.02])


REFUSED = {
    "a kind that stands twice is refused": (
        lambda: CompositeRule(precedence=("cyclic", "cyclic")),
        SettingsError,
        "names a kind twice",
    ),
    "a first rise has one branch": (
        lambda: pieces([1, 2], [1, 2], kind="first-loading"),
        SettingsError,
        "a first rise only rises",
    ),
    "branches that do not overlap have no mean": (
        lambda: mean_piece(branch("ascending", 0.5, 1.0, 110), branch("descending", 1.2, 2.0, 90)),
        DataError,
        "the branches of T do not overlap; found 0.5 to 1 and 1.2",
    ),
    "a pull of one point is no curve": (
        lambda: piece_of_pull([0.01, np.nan], [100.0, 200.0], [1e-4, 1e-4], name="Q"),
        DataError,
        "Q is not a curve; found 1 points",
    ),
}


test_refusals = refusals(REFUSED)

"""Errors that pieces share go through a composite by their sign, and weigh nothing between them."""

from dataclasses import replace

import numpy as np
import pytest
from assemblies import DRIVEN

from reduction.lines.assembly import SeriesPart, _assemble, _equal_tethers, _Tether
from reduction.lines.composite import CurvePiece, _composite_curve
from reduction.record.contributions import Component
from reduction.stages.strain.strain_model import StrainModel

CELL, OTHER = Component("tension_gain", "A"), Component("tension_gain", "B")
ZERO = Component("tension_offset", "A")
MODEL = StrainModel("T", "gauge-length", {"reference_position": 1.0, "gauge_length": 1.0})


def piece(slope, low, high, name="T-1", kind="cyclic", spread=0.5, **shares):
    at = np.linspace(low, high, 81)
    found = CurvePiece(name, kind, "mean", at, slope * at, np.full(81, spread))
    return with_shares(found, **shares) if shares else found


def with_shares(one, **shares):
    cells = {"a": CELL, "b": OTHER}
    rows = np.stack([share * one.tension for share in shares.values()])
    return replace(one, component=tuple(cells[name] for name in shares), contribution=rows)


PIECES = (
    piece(100, 0.5, 1.2), piece(120, 0.9, 2.0, "T-2"), piece(108, 1.5, 2.6, "T-3"),
    piece(90, 0.2, 0.9, "T-1", "first-loading"),
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
    one, two = piece(100, 0.5, 1.5, spread=0.0), piece(120, 0.5, 1.5, "T-2", spread=0.0)
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
    one, two = piece(100, 0.5, 1.5, spread=1.0), piece(104, 0.5, 1.5, "T-2", spread=1.0)
    fair = _composite_curve([one, two]).tension_at(1.0)
    alike = _composite_curve([with_shares(one, a=0.1), with_shares(two, a=0.1)]).tension_at(1.0)
    assert alike == pytest.approx(fair)
    bad = _composite_curve([one, with_shares(two, b=0.2)]).tension_at(1.0)
    assert 100 < bad < fair - 1.5


def test_over_a_gap_what_both_ends_share_stays_whole():
    found = _composite_curve([piece(100, 0.5, 1.0, a=0.1), piece(100, 1.4, 2.0, "T-2", a=0.1)])
    middle = np.flatnonzero(found.is_gap[:-1] & found.is_gap[1:]) + 1
    assert found.contribution[0, middle] == pytest.approx(0.1 * found.tension[middle])
    assert found.contribution[0, 0] == 0


def test_tethers_of_one_curve_share_all_of_it_and_of_two_curves_what_their_tests_do():
    one = _Tether(_composite_curve([piece(100, 0.5, 2.0, a=0.1, spread=4.0)]), MODEL)
    two = _Tether(_composite_curve([piece(100, 0.5, 2.0, a=0.1, spread=4.0)]), MODEL)
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
    rubber = piece(400, 0.1, 2.0, a=step)
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
    tether = _Tether(_composite_curve([piece(100, 0.5, 2.0, a=0.1)]), MODEL)
    found = _assemble([tether], [SeriesPart("spring", 1.0, 100.0)])
    assert found.uncertainty_at(3.0)[2] == pytest.approx(0.1 * 50 / 2, rel=1e-3)

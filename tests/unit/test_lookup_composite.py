import numpy as np
import pytest

from reduction.lines.composite import CompositeRule, CurvePiece, _composite_curve
from reduction.record.errors import DataError, SettingsError


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
    for share in (0.0, 0.5, 1.0):
        curve = _composite_curve(pieces, rule=CompositeRule(least_slope=share))
        slope = np.diff(curve.tension) / np.diff(curve.strain)
        at = (curve.strain[1:] + curve.strain[:-1]) / 2
        softest = 0.7 * (600 - 300 * at + 135 * at**2)
        assert (slope[~curve.is_gap] >= 0.99 * share * softest[~curve.is_gap]).all()


def test_rules_and_pieces_that_make_no_sense_are_refused():
    with pytest.raises(SettingsError, match="names no known kind of piece"):
        CompositeRule(precedence=())
    with pytest.raises(SettingsError, match="taper is a share"):
        CompositeRule(taper=0.6)
    with pytest.raises(SettingsError, match="least slope is a share"):
        CompositeRule(least_slope=1.1)
    with pytest.raises(SettingsError, match="a grid has two points"):
        CompositeRule(n_points=1)
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


def test_a_kind_that_stands_twice_is_refused():
    with pytest.raises(SettingsError, match="names a kind twice"):
        CompositeRule(precedence=("cyclic", "cyclic"))


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

"""Laws of the splices where tape readings leave open whether strain or tension drives them."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.strain import splice_laws
from reduction.stages.strain.splice_laws import LAWS, SpliceReadings, _other_load, fit_splice_laws

FREE = np.array([0.0, 0.5, 0.8, 1.0, 1.3, 1.6, 1.9, 2.2, 2.5])
# a rubber that softens, then stiffens
TENSION = 300.0 * FREE * (1 - 0.25 * FREE + 0.09 * FREE**2)
TAPE = 1e-3


def readings(splice, tension=TENSION):
    """Marks of one test without error, read with a tape of the stated one."""
    return SpliceReadings(
        FREE, splice, tension, np.zeros(FREE.size, int), FREE == 0, 0.45, TAPE, np.zeros((2, 2)),
        tension_uncertainty=np.zeros(FREE.size),
    )  # fmt: skip


def stiffening(bend=2.0, at_one=0.2):
    """Splices that follow the free strain along a curve that steepens."""
    return at_one * FREE * (1 + (FREE / bend) ** 2) / (1 + bend**-2)


def test_splices_that_steepen_with_the_free_strain_are_not_taken_for_driven_by_tension():
    """A second test has its marks at nine tenths of the tension of the first."""
    free, splice = np.tile(FREE, 2), np.tile(stiffening(), 2)
    found = fit_splice_laws(
        SpliceReadings(
            free, splice, np.concatenate([TENSION, 0.9 * TENSION]), np.arange(18) // 9, free == 0,
            0.45, TAPE, np.zeros((2, 2)), tension_uncertainty=np.zeros(18),
        )
    )  # fmt: skip
    assert found.laws[0].name == "strain-cubic"
    assert found.laws[0].values[1:5] == pytest.approx([0.16, 0.0, 0.04, 0.0], abs=1e-6)
    assert found.values[4] == pytest.approx(0.0, abs=0.01)


def test_no_law_has_splices_that_shorten_as_the_free_length_stretches():
    found = fit_splice_laws(readings(stiffening(1.5)))
    slopes = np.stack([np.ones(FREE.size), 2 * FREE, 3 * FREE**2], axis=1)[1:]
    for law in found.laws:
        spread = np.sqrt(np.einsum("ri,ij,rj->r", slopes, law.covariance[1:4, 1:4], slopes))
        assert (slopes @ law.values[1:4] >= -2 * spread - 1e-12).all(), law.name


def test_a_side_that_fits_is_reached_by_the_interval_of_the_average():
    """With 21 % of the weight, 1.96 standard deviations of two laws reach the lighter one."""
    found = fit_splice_laws(readings(0.2 * (TENSION / TENSION[3]) ** 1.2))
    by_strain = [
        weight for law, weight in zip(found.laws, found.weight, strict=True)
        if "tension" not in LAWS[law.name]
    ]  # fmt: skip
    assert found.laws[0].name == "tension-driven"
    assert sum(by_strain) >= 1 / (1 + 1.96**2) - 1e-12
    lightest = next(law for law in found.laws if law.name == "strain-cubic")
    away = abs(found.values[4] - lightest.values[4])
    assert 1.96 * np.sqrt(found.between[4, 4]) >= away


def test_marks_of_one_pull_do_not_tell_tension_from_strain_by_a_bend_that_no_power_has():
    """Splices that saturate with the tension; in the cycles the same strain has less of it."""
    tension = np.array([0.0, 179.0, 308.0, 427.0, 623.0, 865.0])
    free = np.array([0.0, 0.39, 0.79, 1.2, 1.82, 2.43])
    found = fit_splice_laws(
        SpliceReadings(
            free, 0.25 * (1 - np.exp(-tension / 500.0)), tension, np.zeros(6, int), free == 0,
            0.415, 0.0017, np.zeros((2, 2)), tension_uncertainty=np.full(6, 0.01),
        )
    )  # fmt: skip
    relaxed = 345.0
    terms = np.array([1.0, 1.2, 1.2**2, 1.2**3, (relaxed / found.reference) ** found.values[5]])
    away = terms @ found.values[:5] - 0.25 * (1 - np.exp(-relaxed / 500.0))
    spread = (found.covariance + found.between)[:5, :5]
    assert abs(away) < 1.96 * np.sqrt(terms @ spread @ terms)


def test_a_cubic_is_not_tried_with_fewer_than_five_loaded_marks():
    kept = np.array([0, 1, 3, 5, 8])
    few = SpliceReadings(
        FREE[kept], 0.2 * FREE[kept], TENSION[kept], np.zeros(kept.size, int), FREE[kept] == 0,
        0.45, TAPE, np.zeros((2, 2)), tension_uncertainty=np.zeros(kept.size),
    )  # fmt: skip
    assert "strain-cubic" not in {law.name for law in fit_splice_laws(few).laws}


def three_marks(splice, tension=(260.0, 470.0, 700.0), free=(0.48, 1.02, 1.57)):
    """Marks of one test: slack, min, centre and max."""
    return SpliceReadings(
        np.array([0.0, *free]), np.array([0.0, *splice]), np.array([0.0, *tension]),
        np.zeros(4, int), np.array([True, False, False, False]), 0.464, 0.0013, np.zeros((2, 2)),
        tension_uncertainty=np.zeros(4),
    )  # fmt: skip


def hyperbola(tension):
    """Two unlike ends, each a F / (F + F_c) with a line."""
    ends = 0.15 * tension / (tension + 90.0) + 0.13 * tension / (tension + 200.0)
    return ends + 1.5e-4 * tension


def weight_of(found, term):
    return sum(
        weight for law, weight in zip(found.laws, found.weight, strict=True)
        if (term in LAWS[law.name])
    )  # fmt: skip


def test_three_marks_of_splices_that_saturate_leave_a_law_of_the_tension():
    found = fit_splice_laws(three_marks(hyperbola(np.array([260.0, 470.0, 700.0]))))
    by_tension = next(law for law in found.laws if law.name == "tension-driven")
    # d ln s / d ln F at the middle mark, by hand: 0.118 / 0.288
    assert by_tension.values[5] == pytest.approx(0.41, abs=0.04)
    assert by_tension.freedom == 1
    assert weight_of(found, "tension") == pytest.approx(0.5)
    assert found.is_checked


def test_a_misread_mark_among_three_is_told_and_the_next_law_is_carried():
    """Any three marks lie on a curve with an offset: that it fits says nothing of them."""
    sound = 0.25 * (np.array([260.0, 470.0, 700.0]) / 470) ** 0.43
    found = fit_splice_laws(three_marks(sound - [0.0, 0.0, 0.021]))
    assert not found.is_checked
    assert 0 < weight_of(found, "tension") < 1
    # the laws' own misfit is in their spread: a misread inch is in it
    law = next(one for one in found.laws if one.name == "tension-driven")
    assert law.freedom == 1
    assert law.spread[4, 4] == pytest.approx(law.covariance[4, 4] * law.chi_square)


def test_two_marks_of_splices_that_saturate_keep_both_sides():
    free = np.array([0.0, 0.49, 1.59])
    two = SpliceReadings(
        free, np.array([0.0, 0.17, 0.27]), np.array([0.0, 265.0, 703.0]), np.zeros(3, int),
        free == 0, 0.464, 0.0013, np.zeros((2, 2)), tension_uncertainty=np.zeros(3),
    )  # fmt: skip
    found = fit_splice_laws(two)
    assert weight_of(found, "tension") == pytest.approx(0.5)
    assert not found.is_checked


@pytest.mark.parametrize("shape", ["root", "share", "steep"])
def test_marks_at_one_stretch_leave_the_slope_of_the_splices_open(shape):
    """Synthetic: two tests marked at one stretch; a cycle follows the slope of the splices there."""
    free, tension = np.array([0.0, 1.0, 1.002]), np.array([0.0, 300.0, 290.0])
    power = {"root": 0.5, "share": 1.0, "steep": 1.6}[shape]
    splice = 0.2 * (tension / 300) ** power
    found = fit_splice_laws(
        SpliceReadings(
            free, splice, tension, np.array([0, 0, 1]), free == 0, 0.45, 3e-3, np.zeros((2, 2)),
            tension_uncertainty=np.zeros(3),
        )
    )  # fmt: skip
    assert not found.is_checked
    # slope of the splice strain with the free strain, while the tension rises in proportion
    by = np.zeros(10)
    by[[1, 2, 3, 4, 5]] = 1.0, 2.0, 3.0, found.values[5], found.values[4]
    slope = found.values[1] + found.values[4] * found.values[5]
    spread = np.sqrt(by @ (found.covariance + found.between) @ by)
    assert abs(slope - 0.2 * power) < 2 * spread
    assert spread < 0.15


@pytest.mark.parametrize(("force", "tape"), [(60.0, 3e-3), (60.0, 5e-3), (80.0, 3e-3)])
def test_an_exponent_that_the_marks_do_not_fix_is_as_uncertain_as_its_range(force, tape):
    """Of saturated splices; between .3 and 1.9 an exponent is known without any mark."""
    free = np.linspace(0.0, 2.0, 6)
    tension = 300.0 * free * (1 - 0.25 * free + 0.09 * free**2)
    splice = 0.15 * (1 - np.exp(-tension / force))
    found = fit_splice_laws(
        SpliceReadings(
            free, splice, tension, np.zeros(6, int), free == 0, 0.45, tape, np.zeros((2, 2)),
            tension_uncertainty=np.zeros(6),
        )
    )  # fmt: skip
    bedded = next(law for law in found.laws if law.name == "bedded tension-driven")
    assert bedded.values[5] == pytest.approx(0.3, abs=1e-3)
    assert np.sqrt(bedded.covariance[5, 5]) <= 1.9 - 0.3
    # splices of 15 % are not uncertain by more than they strain
    assert np.sqrt(np.diag(found.covariance)[[0, 4]]).max() < 0.15


@pytest.mark.parametrize(
    "splice", [0.2 * (TENSION / 300) ** 1.2, 0.15 * (1 - np.exp(-TENSION / 300))]
)
def test_the_mean_carries_the_variance_of_its_laws(splice):
    """Of a strain by the tension, the first-order variance is the mean of those of the laws."""
    given = readings(splice)
    found = fit_splice_laws(given)

    def gradient(values, free, tension):
        power = (tension / given.reference) ** values[5]
        by_exponent = values[4] * power * np.log(tension / given.reference)
        return np.array([1.0, free, free**2, free**3, power, by_exponent])

    for place in (2, 5, 8):
        at = FREE[place], TENSION[place]
        by_mean = gradient(found.values, *at)
        own = sum(
            weight * gradient(law.values, *at) @ law.spread[:6, :6] @ gradient(law.values, *at)
            for law, weight in zip(found.laws, found.weight, strict=True)
        )
        variance = by_mean @ found.covariance[:6, :6] @ by_mean
        assert np.sqrt(variance) == pytest.approx(np.sqrt(own), rel=0.1)


def three_tests(splice_of, tape=1e-3, scatter=0.0):
    """Marks of three tests, in the later ones of a softer rubber, by splices of the tension."""
    levels = np.array([0.0, 0.75, 1.0, 1.25, 0.5, 1.0, 1.5, 1.0, 1.5, 2.0])
    soft = np.array([1.0] * 4 + [0.93] * 3 + [0.86] * 3)
    tension = soft * 300.0 * levels * (1 - 0.25 * levels + 0.09 * levels**2)
    error = scatter * np.random.default_rng(1).standard_normal(levels.size) * (levels > 0)
    return SpliceReadings(
        levels, splice_of(tension) + error, tension, np.array([0] * 4 + [1] * 3 + [2] * 3),
        levels == 0, 0.45, tape, np.zeros((2, 2)), tension_uncertainty=np.zeros(levels.size),
    )  # fmt: skip


def strain_by(values, reference, free, tension):
    """Splice strain of an average, by its formula."""
    relative = tension / reference
    share = 0.0
    if values[7] > 0:
        share = (1 - np.exp(-values[7] * relative)) / (1 - np.exp(-values[7]))
    by_strain = values[0] + free * (values[1] + free * (values[2] + free * values[3]))
    return by_strain + values[4] * relative ** values[5] + values[6] * share


def of_average(found, free, tension):
    """Splice strain of the average and its standard uncertainty, by differences."""
    values = np.array(found.values[:8])
    slope = np.zeros(8)
    for place in range(8):
        step = 1e-6 * np.eye(8)[place]
        slope[place] = (
            strain_by(values + step, found.reference, free, tension)
            - strain_by(values, found.reference, free, tension)
        ) / 1e-6
    spread = (found.covariance + found.between)[:8, :8]
    return strain_by(values, found.reference, free, tension), np.sqrt(slope @ spread @ slope)


def exponential(tension):
    return 0.25 * (1 - np.exp(-tension / 200.0))


def test_splices_that_saturate_over_three_tests_have_a_law():
    """No power of the tension follows them, and the rubber of each test has other tensions."""
    found = fit_splice_laws(three_tests(exponential))
    assert found.laws[0].name == "saturating"
    assert found.laws[0].values[6] == pytest.approx(exponential(found.reference), rel=1e-4)
    assert found.laws[0].values[7] == pytest.approx(found.reference / 200.0, rel=1e-3)
    # in the cycles the rubber is softer still
    strain, spread = of_average(found, 1.2, 150.0)
    assert abs(strain - exponential(150.0)) < 1.96 * spread
    assert spread < 2 * TAPE * np.sqrt(3)


@pytest.mark.parametrize(
    "splice_of",
    [
        lambda tension: 0.35 * tension / (tension + 250.0),
        lambda tension: 0.25 * np.arctan(tension / 200.0) * 2 / np.pi,
        lambda tension: 0.12 * np.log1p(tension / 100.0),
        lambda tension: 0.09 * (1 - np.exp(-tension / 80.0)) + 2.5e-4 * tension,
    ],
    ids=["hyperbola", "arctan", "logarithm", "unlike ends"],
)
def test_splices_that_soften_otherwise_are_within_the_interval(splice_of):
    found = fit_splice_laws(three_tests(splice_of, scatter=1.7e-3))
    for free, tension in ((0.6, 120.0), (1.2, 170.0), (1.9, 300.0)):
        strain, spread = of_average(found, free, tension)
        assert abs(strain - splice_of(tension)) < 1.96 * spread
        assert spread < 0.005


def test_the_mean_of_laws_of_unlike_bends_is_that_of_their_strains():
    """A mean saturation of laws that saturate early and late is that of neither."""
    found = fit_splice_laws(
        three_tests(lambda tension: 0.03 * (tension > 0) + 0.2 * (tension / 400.0) ** 0.72)
    )
    limited = [law.values[7] for law, w in zip(found.laws, found.weight, strict=True) if w > 0.01]
    assert np.ptp(limited) > 0.5
    given = three_tests(exponential)
    for free, tension in zip(given.free[1:], given.tension[1:], strict=True):
        wanted = sum(
            weight * strain_by(law.values, found.reference, free, tension)
            for law, weight in zip(found.laws, found.weight, strict=True)
        )
        strain, _ = of_average(found, free, tension)
        assert strain == pytest.approx(wanted, abs=0.2 * TAPE)


def test_a_mark_below_all_others_is_not_set_aside_for_a_law_that_saturates():
    """Of splices by x2 / (1 + x2), x = F / 350 N, read to .3 mm, all marks but the lowest do."""
    tension = np.array([0.0, 403.0, 605, 800, 557, 864, 1156])
    free = np.array([0.0, 0.566, 0.972, 1.391, 0.977, 1.495, 2.025])
    splice = np.array([0.0, 0.1273, 0.1659, 0.1833, 0.1572, 0.1876, 0.2011])
    found = fit_splice_laws(
        SpliceReadings(
            free, splice, tension, np.array([0, 0, 0, 0, 1, 1, 1]), free == 0, 0.45, 2.5e-4,
            np.zeros((2, 2)),
            tension_uncertainty=np.array([0, 0.0143, 0.0081, 0.0079, 0.0073, 0.0063, 0.009]),
        )
    )  # fmt: skip
    assert found.set_aside == ()


def test_a_mark_below_a_kink_is_not_set_aside_for_a_law_that_the_others_hardly_pass():
    """Of splices of 15 % at 400 N and a fifth of that slope above, read to .3 mm."""
    tension = np.array([0.0, 303.0, 451, 598, 414, 645, 861])
    free = np.array([0.0, 0.5753, 0.9797, 1.4013, 0.9810, 1.5059, 2.0314])
    splice = np.array([0.0, 0.11472, 0.15482, 0.16565, 0.15270, 0.16988, 0.1860])
    given = SpliceReadings(
        free, splice, tension, np.array([0, 0, 0, 0, 1, 1, 1]), free == 0, 0.45, 2.6e-4,
        np.zeros((2, 2)),
        tension_uncertainty=np.array([0, 0.0143, 0.009, 0.0097, 0.0077, 0.0063, 0.0087]),
    )  # fmt: skip
    with pytest.raises(DataError, match="no law"):
        fit_splice_laws(given)


def marks_of_five_tests(*wrong):
    """Splices that strain by 0.1 (1 - exp(-F / 120 N)), read to a 600th; rows off by so much."""
    tension = np.tile([0.0, 110.0, 190.0, 280.0], 5) * np.repeat([1.0, 1.1, 1.25, 1.4, 1.6], 4)
    free = 0.004 * tension + 1e-6 * tension**2 * np.repeat([1.0, 0.6, 1.4, 0.8, 1.2], 4)
    splice = 0.1 * -np.expm1(-tension / 120.0)
    for row, error in wrong:
        splice[row] += error
    return SpliceReadings(
        free, splice, tension, np.repeat(np.arange(5), 4), tension == 0, 0.4, 1 / 600,
        np.zeros((2, 2)),
    )  # fmt: skip


def test_a_misread_mark_is_set_aside_beside_another_that_is_less_so():
    """20 and 10 mm of splices of 0.6 m: laws that the others contradict do not excuse a mark."""
    found = fit_splice_laws(marks_of_five_tests((10, 0.033), (5, -0.0165)))
    assert 10 in found.set_aside
    assert set(found.set_aside) <= {5, 10}


def test_a_refusal_names_the_mark():
    rng = np.random.default_rng(3)
    wrong = [(row, 0.05 * rng.choice([-1, 1])) for row in (1, 2, 5, 6, 9, 10, 13, 14, 17)]
    names = [f"mark {row}" for row in range(20)]
    with pytest.raises(DataError, match=r"Look at mark \d+, off by"):
        fit_splice_laws(marks_of_five_tests(*wrong), names=names)


@pytest.mark.parametrize("row", [1, 5])
def test_a_refusal_names_the_first_and_the_last_mark_and_not_the_one_beside_it(row):
    """Splices that strain 22 % of what the free length does; one mark is 30 mm off."""
    free = np.array([0.0, 0.75, 0.875, 1.0, 1.125, 1.25])
    tension = np.array([0.0, 240.0, 275.0, 310.0, 345.0, 385.0])
    splice = 0.22 * free
    splice[row] += 0.03 / 1.17
    given = SpliceReadings(
        free, splice, tension, np.zeros(6, int), free == 0, 0.46, 1e-3, np.zeros((2, 2))
    )
    names = [f"mark {number}" for number in range(6)]
    with pytest.raises(DataError, match=f"Look at mark {row}: without it"):
        fit_splice_laws(given, names=names)


def test_marks_on_the_way_down_alone_are_refused_with_what_they_lack():
    slack = np.zeros(1)
    given = SpliceReadings(
        slack, slack, slack, np.zeros(1, int), np.array([True]), 0.46, 1e-3, np.zeros((2, 2))
    )
    with pytest.raises(DataError, match=r"found no stretched mark .* approached by loading"):
        fit_splice_laws(given)


@pytest.mark.parametrize(("factor", "is_told"), [(4.4482, True), (0.4536, True), (1.3, False)])
def test_a_load_in_another_unit_than_that_of_the_other_tests_is_told_by_the_marks(factor, is_told):
    """Four tests at strains that overlap, of a rubber that softens by 4 % from test to test."""
    free = np.array([
        0, 0.75, 1.0, 1.25, 0, 0.5, 1.0, 1.5, 0, 1.25, 1.5, 1.75, 0, 1.0, 1.5, 2.0,
    ])  # fmt: skip
    test = np.arange(16) // 4
    tension = np.interp(free, FREE, TENSION) * (1 - 0.04 * test)
    tension[test == 1] *= factor
    marks = SpliceReadings(free, 0.2 * free, tension, test, free == 0, 0.45, TAPE, np.zeros((2, 2)))
    found = _other_load(marks)
    if is_told:
        row, ratio = found
        assert test[row] == 1
        assert ratio == pytest.approx(factor, rel=0.08)
    assert (found is not None) is is_told


def table_of_tests(wrong, n_tests=8):
    """Six marks of every test on splices of a mixed law; some read wrong by 4 points of strain."""
    rng = np.random.default_rng(4)
    free = np.concatenate([[0.0, *np.sort(rng.uniform(0.5, 2.3, 6))] for _ in range(n_tests)])
    tension = 460 * (free / 2.1 + 0.3 * (free / 2.1) ** 3)
    splice = 0.16 * free + 0.06 * (tension / 300) ** 0.7
    loaded = free > 0
    splice[loaded] += rng.normal(0, 1.7e-3, loaded.sum())
    splice[rng.choice(np.flatnonzero(loaded), wrong, replace=False)] += 0.04
    return SpliceReadings(
        free, splice, tension, np.repeat(np.arange(n_tests), 7), ~loaded, 0.47, 1e-3,
        1e-6 * np.eye(2),
    )  # fmt: skip


def test_a_long_table_is_refused_without_a_fit_of_all_laws_for_every_mark(monkeypatch):
    count = []
    fit = splice_laws._fit
    monkeypatch.setattr(splice_laws, "_fit", lambda *some: count.append(1) or fit(*some))
    with pytest.raises(DataError, match="no law of the splices"):
        fit_splice_laws(table_of_tests(16))
    assert len(count) < 1500  # 48 marks, 14 laws and some 20 shapes: 13,000


def test_a_law_that_agrees_without_a_mark_is_not_passed_over():
    whole = table_of_tests(1, n_tests=3)
    judged = splice_laws._judged(whole)
    may = splice_laws._may_agree(whole, judged)
    rows = np.flatnonzero(~whole.is_slack)
    rows = rows[np.argsort([-sum(one[row] for one in may.values()) for row in rows])][:2]
    agrees = []
    for row in rows:
        for law in splice_laws._fitted(whole.without(int(row)), judged.slip):
            agrees.append(law.chance >= splice_laws.REJECTED)
            assert may[law.name][row] or not agrees[-1]
    assert any(agrees)
    assert sum(int(one.sum()) for one in may.values()) < 0.5 * 14 * 18

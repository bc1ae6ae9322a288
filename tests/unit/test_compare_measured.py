"""None"""

from types import SimpleNamespace

import numpy as np
import pytest
from compared_hoses import PSI, TRUTH, cycled, dataset, squeezed
from measured_hoses import Truth
from scipy.stats import binom

from reduction.prediction.hose_comparison import _compare_hose, compare_record
from reduction.prediction.hose_prediction import HosePlan
from reduction.prediction.hose_tension import predict_hose
from reduction.prediction.measured_curve import (
    MeasuredCurve,
    _branch_scatter,
    _end_of_curve,
    _fill_cells,
    _Reading,
    _select_samples,
    _shared_scatter,
    _tension_at_centres,
    constant_errors,
    measured_curve,
    pressure_errors,
)
from reduction.record.errors import DataError, SettingsError


def strokes(n_cycles, n_samples, *, low=0.0, high=1.0):
    """Triangular strain, branch and cycle number."""
    phase = np.linspace(0, n_cycles, n_cycles * n_samples, endpoint=False)
    rise = 1 - np.abs(2 * (phase % 1) - 1)
    branch = np.where(phase % 1 < 0.5, 1, 2)
    return low + (high - low) * rise, branch, phase.astype(int) + 1


def test_a_parabola_comes_back_exactly_from_uneven_samples():
    rng = np.random.default_rng(4)
    strain = np.sort(rng.uniform(0.0, 0.6, 4000))
    curve = measured_curve(strain, 300 + 5000 * strain**2, loading="static", strain_step=0.02)
    inner = slice(1, -1)
    expected = 300 + 5000 * curve.strain**2
    # neighbouring bins have not quite the same spread of strain
    assert curve.branch_tension[0][inner] == pytest.approx(expected[inner], abs=0.05)


def test_noise_does_not_pull_the_mean_curve_to_one_side():
    strain, branch, number = strokes(50, 400)
    rng = np.random.default_rng(5)
    tension = 2000 * strain + 3000 * strain**3 + rng.normal(0, 30, strain.size)
    curve = measured_curve(strain, tension, loading="static", cycle_number=number, branch=branch)
    error = curve.midline_tension - 2000 * curve.strain - 3000 * curve.strain**3
    ratio = (error / curve.midline_standard_uncertainty)[1:-1]
    error = error[1:-1]
    assert abs(np.mean(error)) < 3 * 30 / np.sqrt(strain.size)
    assert 0.7 < np.std(ratio) < 1.2


def test_a_drifting_time_in_a_bin_does_not_shift_a_steep_curve():
    # samples crowd at the upper edge of every bin: their mean is off the centre by 0.3 of it
    centre = np.arange(1, 60) * 0.01
    strain = (centre[:, None] + [0.002, 0.003, 0.004]).ravel()
    curve = measured_curve(strain, 8000 * strain, loading="static", strain_step=0.01)
    inside = slice(1, -1)
    assert curve.branch_tension[0][inside] == pytest.approx(8000 * curve.strain[inside], abs=1e-8)


def test_branches_and_cycles_stay_apart():
    strain, branch, number = strokes(3, 400)
    tension = 1000 * strain + np.where(branch == 1, 40, -60) + 10 * number
    curve = measured_curve(strain, tension, loading="dynamic", cycle_number=number, branch=branch)
    k = np.searchsorted(curve.strain, 0.4999)
    assert curve.tension[:, 0, k] == pytest.approx([550, 560, 570])
    assert curve.tension[:, 1, k] == pytest.approx([450, 460, 470])
    assert curve.branch_tension[:, k] == pytest.approx([560, 460])
    assert curve.midline_tension[k] == pytest.approx(510)
    assert curve.judged == "midline" and curve.loading == "dynamic"
    assert curve.curves() == ("ascending", "descending", "midline")


def test_break_in_cycles_are_kept_and_in_no_mean():
    strain, branch, number = strokes(4, 400)
    tension = 1000 * strain + np.where(number == 1, 500, 0)
    curve = measured_curve(
        strain, tension, loading="static", cycle_number=number, branch=branch, break_in_cycles=1
    )
    k = np.searchsorted(curve.strain, 0.4999)
    assert curve.tension[0, 0, k] == pytest.approx(1000)
    assert curve.midline_tension[k] == pytest.approx(500)


def test_a_slow_pull_ends_at_its_greatest_tension_and_has_one_branch():
    strain = np.concatenate([np.linspace(0, 1, 500), np.ones(100), np.linspace(1, 0.2, 200)])
    tension = 900 * strain
    tension[500:600] -= np.linspace(0.1, 80, 100)  # relaxes, then is let off
    tension[600:] -= 100
    curve = measured_curve(strain, tension, loading="static")
    assert curve.judged == "ascending" and curve.curves() == ("ascending",)
    assert curve.tension.shape[:2] == (1, 2)
    assert np.isnan(curve.tension[0, 1]).all()
    assert curve.branch_tension[0] == pytest.approx(900 * curve.strain, abs=1e-6)
    assert "one branch was measured" in str(curve.notes[0])


def test_missing_samples_are_left_out_and_bins_not_visited_are_nan():
    strain = np.linspace(0, 1, 2001)
    tension = 500 * strain
    tension[(strain > 0.3) & (strain < 0.4)] = np.nan
    curve = measured_curve(strain, tension, loading="static")
    gap = (curve.strain > 0.311) & (curve.strain < 0.389)
    assert np.isnan(curve.branch_tension[0][gap]).all()
    assert np.isfinite(curve.branch_tension[0][~gap]).sum() > 80
    assert curve.count[0, 0][gap].sum() == 0


def test_a_mean_needs_half_of_the_cycles():
    strain, branch, number = strokes(5, 400)
    strain = np.where(number == 5, strain * 1.2, strain)
    curve = measured_curve(
        strain, 100 * strain, loading="static", cycle_number=number, branch=branch
    )
    beyond = curve.strain > 1.02
    assert np.isnan(curve.midline_tension[beyond]).all()
    assert np.isfinite(curve.tension[4, 0][beyond][:-1]).all()


def test_few_samples_widen_the_bins_and_a_step_can_be_given():
    strain, branch, number = strokes(4, 40)
    wide = measured_curve(strain, strain, loading="static", cycle_number=number, branch=branch)
    assert np.diff(wide.strain)[0] == pytest.approx(0.1)  # 1.5 samples of 0.05, on 1, 2, 5
    dense = measured_curve(np.linspace(0, 1, 5000), np.linspace(0, 9, 5000), loading="static")
    assert np.diff(dense.strain)[0] == pytest.approx(0.01)


def test_calibration_errors_are_signed_shifts_of_the_curve():
    strain = np.linspace(0, 1, 5001)
    truth = lambda x: 3000 * x + 2000 * x**2  # noqa: E731
    shared = constant_errors(
        tension_offset=5, tension_gain=0.01, strain_offset=0.002, strain_gain=0.005
    )
    curve = measured_curve(strain, truth(strain), loading="static", shared=shared)
    sources = [one.source for one in curve.component]
    inner = slice(2, -2)
    # the same pull, read by instruments that are one standard uncertainty high
    for name, read_strain, read_tension in (
        ("tension_offset", strain, truth(strain) + 5),
        ("tension_gain", strain, truth(strain) * 1.01),
        ("strain_offset", strain + 0.002, truth(strain)),
        ("strain_gain", strain * 1.005, truth(strain)),
    ):
        wrong = measured_curve(read_strain, read_tension, loading="static")
        n = min(wrong.strain.size, curve.strain.size)
        moved = (wrong.branch_tension[0][:n] - curve.branch_tension[0][:n])[inner]
        row = curve.contribution_of("ascending")[sources.index(name)][:n][inner]
        assert row == pytest.approx(moved, abs=0.3), name  # second order


def test_what_cycles_share_is_kept_apart_from_what_they_do_not():
    strain, branch, number = strokes(12, 600)
    rng = np.random.default_rng(11)
    scale = 1 + 0.01 * rng.standard_normal(13)
    tension = (500 + 4000 * strain) * scale[number] + rng.normal(0, 10, strain.size)
    curve = measured_curve(strain, tension, loading="static", cycle_number=number, branch=branch)
    common = np.sqrt(np.sum(curve.scatter_contribution**2, axis=0))
    # Student's ratio for 12 cycles, 1.123, over the scatter of these very cycles
    expected = 1.123 * (500 + 4000 * curve.strain) * np.std(scale[1:], ddof=1) / np.sqrt(12)
    inner = slice(5, -5)
    assert common[inner] == pytest.approx(expected[inner], rel=0.1)
    n_in_bin = 12 * 600 / curve.strain.size  # both branches
    own = np.nanmedian(curve.independent_uncertainty())
    assert own == pytest.approx(10 / np.sqrt(n_in_bin), rel=0.2)


def test_cycles_without_common_scatter_have_no_common_error():
    rng = np.random.default_rng(12)
    found = [
        _shared_scatter(rng.normal(0, 1, (8, 80)), np.zeros(80))[0].shape[0] for _ in range(50)
    ]
    assert np.mean(np.array(found) > 0) < 0.2


def test_one_cycle_has_no_common_scatter():
    parts, rest = _shared_scatter(np.ones((1, 30)), np.ones(30))
    assert parts.shape == (0, 30) and rest.shape == (1, 30)


def test_scatter_of_two_cycles_is_pooled_over_the_branch():
    rng = np.random.default_rng(13)
    cycles = rng.normal(0, 6, (2, 1, 200))
    _, variance = _branch_scatter(cycles, np.zeros((2, 1, 200)))
    assert np.sqrt(variance).min() > 0.8 * 6 / np.sqrt(2)
    assert np.sqrt(variance.mean()) == pytest.approx(6 / np.sqrt(2), rel=0.15)


def test_noise_of_a_single_pull_is_that_of_its_bins():
    rng = np.random.default_rng(14)
    ratios = []
    for _ in range(20):
        strain = np.linspace(0, 1, 3000)
        truth = Truth()
        pull = measured_curve(
            strain, truth.tension(strain) + rng.normal(0, 20, 3000), loading="static"
        )
        error = pull.branch_tension[0] - truth.tension(pull.strain)
        ratios.append(np.nanstd((error / pull.branch_standard_uncertainty[0])[2:-2]))
    assert 0.8 < np.mean(ratios) < 1.15


def test_noise_slower_than_the_samples_is_seen_from_bin_to_bin():
    rng = np.random.default_rng(15)
    strain = np.linspace(0, 1, 20_000)
    slow = np.repeat(rng.normal(0, 20, 200), 100)  # constant within half a bin
    pull = measured_curve(strain, 1000 * strain + slow, loading="static")
    error = pull.branch_tension[0] - 1000 * pull.strain
    assert np.std(error[1:-1]) < 1.5 * np.median(pull.branch_standard_uncertainty[0])


def test_more_than_a_thousand_cycles_are_kept_as_means_of_consecutive_ones():
    strain, branch, number = strokes(2500, 40)
    curve = measured_curve(
        strain, 100 * strain + number, loading="dynamic", cycle_number=number, branch=branch,
        strain_step=0.1,
    )  # fmt: skip
    assert [one.code for one in curve.notes] == ["cycles-pooled"]
    assert curve.tension.shape[0] == 834
    assert curve.cycle_number[:3].tolist() == [1, 4, 7]
    k = np.searchsorted(curve.strain, 0.4999)
    assert curve.tension[1, 0, k] == pytest.approx(55, abs=0.5)  # cycles 4, 5, 6
    assert "pools 3 consecutive cycles" in str(curve.notes[0])


def test_end_bins_are_not_extrapolated():
    # samples of the last bin lie at its far edge, and none beyond
    strain = np.array([0.10, 0.20, 0.26, 0.27])
    cells, centre = _fill_cells(strain, strain, row=np.zeros(4, int), n_rows=1, step=0.1)
    tension = _tension_at_centres(cells)
    assert centre == pytest.approx([0.1, 0.2, 0.3])
    assert np.isfinite(tension[0]).tolist() == [True, True, False]


def test_a_kink_is_read_as_the_samples_show_it():
    truth = Truth()
    strain, branch, number = strokes(3, 700)
    curve = measured_curve(
        strain, truth.tension(strain), loading="static", cycle_number=number, branch=branch
    )
    node = curve.reading.node
    read = curve.reading.of(np.sign(node) * truth.tension(np.abs(node)))
    seen = np.isfinite(curve.midline_tension)
    plain = np.abs(truth.tension(curve.strain) - curve.midline_tension)[seen]
    assert np.abs(read - curve.midline_tension)[seen].max() < 0.1 < 1.0 < plain.max()
    assert not curve.reading.weight[~seen].any()


def test_a_strain_that_is_off_moves_what_is_read():
    truth = Truth()
    strain = np.linspace(0, 1, 1501)
    curve = measured_curve(strain + 0.003, truth.tension(strain), loading="static")
    node = curve.reading.node - 0.003
    read = curve.reading.of(np.sign(node) * truth.tension(np.abs(node)))
    seen = np.isfinite(curve.branch_tension[0])
    assert read[seen] == pytest.approx(curve.branch_tension[0][seen], abs=0.3)


def test_cycles_of_break_in_are_not_read():
    strain, branch, number = strokes(3, 400)
    strain = np.where(number == 1, strain + 0.002, strain)
    kinked = 1000 * strain + 8000 * np.maximum(strain - 0.497, 0)
    curve = measured_curve(
        strain, kinked, loading="static", cycle_number=number, branch=branch, break_in_cycles=1
    )
    node = curve.reading.node
    read = curve.reading.of(1000 * node + 8000 * np.maximum(node - 0.497, 0))
    seen = np.isfinite(curve.midline_tension)
    assert read[seen] == pytest.approx(curve.midline_tension[seen], abs=0.1)


def test_the_curve_goes_on_to_its_last_sample():
    rng = np.random.default_rng(31)
    strain, branch, number = strokes(4, 900, high=0.9681)
    tension = 500 + 8000 * strain**2
    curve = measured_curve(
        strain, tension + rng.normal(0, 10, strain.size), loading="static", cycle_number=number,
        branch=branch,
    )  # fmt: skip
    last = curve.strain[np.isfinite(curve.midline_tension)][-1]
    assert last == pytest.approx(0.96) and 0.965 < curve.end_strain < 0.9682
    error = curve.end_tension - (500 + 8000 * curve.end_strain**2)
    assert abs(error) < 3 * curve.end_standard_uncertainty < 30
    whole = measured_curve(np.linspace(0, 0.9, 901), np.linspace(0, 9, 901), loading="static")
    assert np.isnan(whole.end_strain) and np.isnan(whole.end_tension)


def test_an_end_that_few_cycles_reached_is_no_end_of_the_curve():
    strain, branch, number = strokes(5, 400)
    strain = np.where(number == 5, strain * 1.0335, strain)
    curve = measured_curve(
        strain, 100 * strain, loading="static", cycle_number=number, branch=branch
    )
    assert np.isnan(curve.end_strain) or curve.end_strain < 1.01


def test_no_tension_lies_beyond_the_samples_that_it_is_read_from():
    # bins of half the curve: slope and bend from bin to bin are not those of the curve
    strain = np.linspace(0, 1, 400)
    tension = Truth().tension(strain)
    curve = measured_curve(strain, tension, loading="static", strain_step=0.3)
    seen = np.isfinite(curve.branch_tension[0])
    slack = 0.05 * np.ptp(tension)
    assert curve.branch_tension[0][seen].min() >= -slack
    assert curve.branch_tension[0][seen].max() <= tension.max() + slack
    cells, _ = _fill_cells(
        np.array([0.06, 0.1, 0.14, 0.2, 0.3]), np.array([0.0, 0.0, 0.0, 0.0, 1000.0]),
        row=np.zeros(5, int), n_rows=1, step=0.1,
    )  # fmt: skip
    assert _tension_at_centres(cells)[0, 0] >= -50  # 5 % of the range of what is beside it


def test_bad_input_is_refused():
    with pytest.raises(SettingsError, match="loading is unknown; found quick"):
        measured_curve([0.0, 0.1], [0.0, 1.0], loading="quick")
    with pytest.raises(SettingsError, match="strain_step cannot be used; found -1"):
        measured_curve([0.0, 0.1], [0.0, 1.0], loading="static", strain_step=-1)
    with pytest.raises(DataError, match="series do not pair up"):
        measured_curve([0.0, 0.1], [0.0], loading="static")
    with pytest.raises(SettingsError, match="cycle_number and branch go together"):
        measured_curve([0.0], [1.0], loading="static", branch=[1])
    with pytest.raises(DataError, match="do not pair up with the samples"):
        measured_curve([0.0], [1.0], loading="static", branch=[1, 1], cycle_number=[1, 1])
    with pytest.raises(DataError, match="no sample belongs to a branch"):
        measured_curve([0.0], [1.0], loading="static", branch=[0], cycle_number=[0])
    with pytest.raises(DataError, match="no sample belongs to a branch"):
        measured_curve([np.nan], [1.0], loading="static")
    with pytest.raises(DataError, match="no cycle is left after break-in"):
        measured_curve(
            [0.0], [1.0], loading="static", branch=[1], cycle_number=[1], break_in_cycles=1
        )
    with pytest.raises(DataError, match="a slow pull has no break-in"):
        measured_curve([0.0], [1.0], loading="static", break_in_cycles=2)
    percent = np.linspace(0, 97, 400)
    with pytest.raises(DataError, match=r"strain in per cent\?; found a strain of 97, 9700 %"):
        measured_curve(percent, 10 * percent, loading="static")
    with pytest.raises(DataError, match="no sample of a branch has a strain"):
        measured_curve([-0.5], [1.0], loading="static")
    with pytest.raises(SettingsError, match="uncertainty of strain_offset cannot be used"):
        constant_errors(strain_offset=-0.1)


def test_a_measured_curve_checks_its_shapes():
    one = np.zeros(3)
    with pytest.raises(DataError, match="branch_tension does not fit the measured curve"):
        MeasuredCurve(
            one, np.zeros((1, 2, 3)), np.zeros((1, 2, 3), int), np.ones(1, int), np.zeros((2, 4)),
            np.zeros((2, 3)), one, one, np.zeros((0, 3)), (), np.zeros((0, 3, 3)), np.zeros((0, 3)),
            "static",
            _Reading(np.zeros(201), np.zeros((3, 121))),
        )  # fmt: skip


def test_rows_are_ascending_then_descending():
    found = _select_samples(
        [0.1, 0.2, 0.1], [1.0, 2.0, 1.0], cycle_number=[2, 2, 2], branch=[1, 1, 2],
        break_in_cycles=0,
    )  # fmt: skip
    assert found.row.tolist() == [0, 0, 1] and found.cycle_number.tolist() == [2]


def test_cycles_without_samples_are_no_cycles_of_the_mean():
    strain, branch, number = strokes(4, 801)
    apart = np.array([0, 1, 2, 700, 90000])[number]
    tension = 500 * strain
    whole = measured_curve(strain, tension, loading="static", cycle_number=number, branch=branch)
    found = measured_curve(
        strain, tension, loading="static", cycle_number=apart, branch=branch, break_in_cycles=2
    )
    assert found.cycle_number.tolist() == [1, 2, 700, 90000] and found.notes == ()
    np.testing.assert_allclose(found.midline_tension, whole.midline_tension)
    # the two after break-in alone
    noise = np.where(apart <= 2, 1e3, 0.0)
    later = measured_curve(
        strain, tension + noise, loading="static", cycle_number=apart, branch=branch,
        break_in_cycles=2,
    )  # fmt: skip
    np.testing.assert_allclose(later.midline_tension, whole.midline_tension)


def test_the_end_of_a_curve_is_half_a_bin_beyond_its_last_samples_with_the_noise_of_both():
    """A straight line through two bins: weights 3/2 and -1/2, of 4 and 9 readings."""
    cells = SimpleNamespace(
        offset=np.zeros((1, 3)), furthest=np.full((1, 3), 0.5), count=np.array([[9.0, 4.0, 0.0]]),
        tension=np.array([[100.0, 120.0, np.nan]]),
        residual=np.array([8.0]), freedom=np.array([4.0]),  # noise of 2 N2
    )  # fmt: skip
    strain, tension, spread = _end_of_curve(
        cells, np.array([[0]]), np.array([True, False, False]), np.array([0.5, 0.0, 0.0])
    )
    assert (strain, tension) == (1.5, 130.0)
    assert spread**2 == pytest.approx(0.5**2 + 2 * (1.5**2 / 4 + 0.5**2 / 9))


# measured fill pressure against the prediction, of hoses whose pressure is known

UNCERTAIN = {"wrap_angle": np.radians(0.3), "cord_load_scale": 0.03}
GAUGE, STRAIN_GAIN = 5e3, 0.003


def compared(truth=TRUTH, *, pressure=None, gauge=2e3, calibrate=()):
    return _compare_hose(
        TRUTH.design(), cycled(truth, reach=0.9), standard_uncertainty=UNCERTAIN,
        calibrate=calibrate, pressure=pressure or squeezed(truth, reach=0.9, gauge=gauge),
    ).pressure  # fmt: skip


def test_the_pressure_of_the_prediction_is_the_hoop_force_over_the_radius():
    strain = np.linspace(0.0, 1.0, 51)
    np.testing.assert_allclose(
        predict_hose(TRUTH.design(), strain).fill_pressure, TRUTH.pressure(strain), rtol=1e-9, atol=1e-6
    )  # fmt: skip


def test_a_right_pressure_agrees_and_a_wrong_one_does_not():
    found = compared()
    assert found.validation.agrees and "% of the fill pressure" in found.validation.verdict
    assert found.fill_pressure_rms < 0.01 * np.nanmax(found.predicted)
    stronger = compared(TRUTH.but(cord_load_scale=1.6))
    assert not stronger.validation.agrees
    assert stronger.fill_pressure_bias < 0 and "kPa" in stronger.validation.verdict
    assert "below the test" in stronger.validation.verdict


def test_the_pressure_finds_the_angle_and_says_nothing_of_the_rubber():
    steeper = TRUTH.but(wrap_angle=np.radians(64.5), rubber_modulus=250 * PSI)
    found = compared(steeper, calibrate=("rubber_modulus", "wrap_angle"))
    assert found.calibration.parameter == ("wrap_angle",)
    rubber, angle = found.fill_pressure_parameter_value
    assert np.isnan(rubber)
    assert angle == pytest.approx(np.radians(64.5), abs=np.radians(0.1))
    spread = found.fill_pressure_parameter_value_standard_uncertainty
    assert np.isnan(spread[0]) and 0 < spread[1] < np.radians(0.5)
    assert compared(steeper, calibrate=("rubber_modulus",)).calibration is None


def test_cords_that_never_press_calibrate_nothing():
    """A gauge that reads its own noise, over strains at which the cords are still slack."""
    reach = 0.3
    assert not TRUTH.pressure(np.linspace(0.0, reach, 51)).any()
    up = np.linspace(0.0, reach, 401)
    idle = measured_curve(
        np.tile(np.concatenate([up, up[::-1]]), 3), np.random.default_rng(5).normal(0, 1e3, 2406),
        loading="static", cycle_number=np.repeat([1, 2, 3], 802),
        branch=np.tile(np.repeat([1, 2], 401), 3), shared=pressure_errors(None, 2e3),
    )  # fmt: skip
    found = compared(pressure=idle, calibrate=("wrap_angle",))
    assert not found.calibration.identifiability.is_identified


def test_the_pressure_stands_on_the_strains_of_the_tension():
    archive = dataset()
    strain, pressure = archive["strain"].values[0], archive["measured_fill_pressure"].values
    there = np.isfinite(pressure[0])
    expected = TRUTH.pressure(strain[there])
    # a bin in which the cords pick up is rounded
    assert pressure[0, there] == pytest.approx(expected, abs=0.01 * expected.max())
    assert (
        np.isnan(pressure[1:]).all() and (archive["fill_pressure_verdict"].values[1:] == "").all()
    )


def record(rng):
    """A log of a hose as it was built, and what its gauge, load cell and marks are wrong by."""
    truth = Truth(
        wrap_angle=TRUTH.wrap_angle + UNCERTAIN["wrap_angle"] * rng.standard_normal(),
        cord_load_scale=1 + UNCERTAIN["cord_load_scale"] * rng.standard_normal(),
    )
    phase = np.linspace(0, 3, 1800, endpoint=False)
    strain = 0.9 * (1 - np.abs(2 * (phase % 1) - 1))
    pressure = truth.pressure(strain) + rng.normal(0, 2e3, strain.size)
    pressure += GAUGE * rng.standard_normal()
    return {
        "strain": strain * (1 + STRAIN_GAIN * rng.standard_normal()),
        "tension": truth.tension(strain) + rng.normal(0, 20, strain.size),
        "fill_pressure": pressure,
        "cycle_number": phase.astype(int) + 1,
        "branch": np.where(phase % 1 < 0.5, 1, 2),
    }  # fmt: skip


@pytest.mark.parametrize("n_draws", [4, pytest.param(200, marks=pytest.mark.nightly)])
def test_the_verdict_and_the_interval_hold_in_19_of_20_hoses(n_draws):
    # of three seeds the verdict holds in 93.0, 94.0 and 95.5 %, the interval in 93.5, 95.5 and 96.5 %
    rng = np.random.default_rng(11)
    hose = HosePlan("H", TRUTH.design(), standard_uncertainty=UNCERTAIN)
    hits = []
    for _ in range(n_draws):
        found = compare_record(
            hose, **record(rng), loading="static", fill_pressure_standard_uncertainty=GAUGE,
            shared=constant_errors(strain_gain=STRAIN_GAIN),
        ).pressure  # fmt: skip
        last = np.flatnonzero(np.isfinite(found.difference.difference))[-5]
        limit = 1.96 * found.validation.validation_uncertainty[last]
        hits.append((found.validation.agrees, abs(found.difference.difference[last]) <= limit))
    low, high = (0.93, 0.98) if n_draws == 200 else (binom.ppf(1e-3, n_draws, 0.95) / n_draws, 1)
    share = np.mean(hits, axis=0)
    assert np.all(share >= low) and np.all(share <= high), share

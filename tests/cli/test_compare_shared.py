"""What a test may be wrong by, in its comparison: logs made wrong and compared again."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from reduction.archive.open import open_archive
from reduction.batch.prediction_product import compare_archive
from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign

pytestmark = pytest.mark.nightly

RAW = Path(__file__).parents[2] / "raw" / "hose-synthetic"
LBF, LENGTH = 4.4482216152605, 96.0
PLAN = {"L-64": "H64-static", "S-64": "H64-pull"}
STATED = """
[uncertainty]
lag = "0.05 s"
strain = "0.5 %"
[uncertainty.tension]
gain = "1 %"
offset = "10 lbf"
noise = "50 lbf"
[uncertainty.crosshead_position]
gain = "0.1 %"
offset = "0.1 in"
[uncertainty.temperature]
value = "2 K"
stiffness_per_kelvin = "1 %"
"""


def reduced(folder, stated, *, tests=("L-64",), change=lambda log: log, edit=lambda text: text):
    """A campaign of one hose, with its logs changed; its plan and the archives of the tests."""
    raw = folder / "raw"
    raw.mkdir(parents=True)
    for name in tests:
        log = change(pd.read_csv(RAW / f"{name}.csv", comment="#"))
        log.to_csv(raw / f"{name}.csv", index=False, float_format="%.6f")
    text = edit((RAW / "campaign.toml").read_text(encoding="utf-8")) + stated
    (raw / "campaign.toml").write_text(text, encoding="utf-8")
    campaign = load_campaign(raw / "campaign.toml")
    run = run_campaign(
        campaign, processed=folder / "p", reports=folder / "r", clock=lambda: 0.0, tests=list(tests)
    )
    return campaign, run.processed


def compared(folder, stated, test="L-64", **options):
    campaign, processed = reduced(folder, stated, tests=(test,), **options)
    plan = campaign.comparisons[PLAN[test]]
    return compare_archive(processed / f"{test}.nc", campaign.hoses["H64"], plan).comparison


def with_column(name, values):
    def change(log):
        return log.assign(**{name: values(log[name])})

    return change


LOAD, PLACE, TIME = "load_lbf", "flange_to_flange_in", "time_s"
WRONG = {
    "tension_gain": with_column(LOAD, lambda load: 1.01 * load),
    "tension_offset": with_column(LOAD, lambda load: load + 10.0),
    # lengths are told from the first rest of the same log: a wrong zero is in both
    "position_gain": with_column(PLACE, lambda place: 1.001 * place),
    "position_offset": with_column(PLACE, lambda place: place + 0.1),
    # a record of which the load was taken late: at each time it is that of a while ago
    "lag": lambda log: log.assign(
        load_lbf=np.interp(log[TIME] - 0.05, log[TIME], log[LOAD])
    ),
}  # fmt: skip


def both(folder, **options):
    """Comparisons of a slow pull and of slow loops."""
    campaign, processed = reduced(folder, STATED, tests=tuple(PLAN), **options)
    return {
        test: compare_archive(
            processed / f"{test}.nc", campaign.hoses["H64"], campaign.comparisons[name]
        ).comparison
        for test, name in PLAN.items()
    }


@pytest.fixture(scope="module")
def right(tmp_path_factory):
    return both(tmp_path_factory.mktemp("right"))


@pytest.fixture(
    scope="module",
    params=[
        "tension_gain",
        *(
            pytest.param(name, marks=pytest.mark.nightly)
            for name in WRONG
            if name != "tension_gain"
        ),
    ],
)
def wrong(request, tmp_path_factory):
    return request.param, both(tmp_path_factory.mktemp("wrong"), change=WRONG[request.param])


@pytest.mark.nightly
@pytest.mark.parametrize("test", list(PLAN))
def test_logs_that_are_wrong_move_the_measured_curve_by_what_the_comparison_says(
    right, wrong, test
):
    source, found = wrong
    curve, wrong = right[test].measured, found[test].measured
    names = [one.source for one in curve.component]
    n = min(curve.strain.size, wrong.strain.size)
    for name in curve.curves():
        rows = dict(zip(names, curve.contribution_of(name), strict=True))
        row = rows.get(source, np.zeros(curve.strain.size))[:n]
        moved = wrong.tension_of(name)[:n] - curve.tension_of(name)[:n]
        slope = np.gradient(curve.tension_of(name)[:n], curve.strain[:n])
        there = np.isfinite(moved) & np.isfinite(slope)
        # where cords pick up the slope jumps within a bin, and ends are read by a line
        bend = np.abs(np.gradient(slope)) > 0.1 * np.abs(slope)
        there &= ~bend
        there[:3] = there[-3:] = False
        size = np.sqrt(np.mean(row[there] ** 2))
        assert there.sum() > 60
        # the samples of a bin change, and with them its noise of some 4 N
        left = (moved - row)[there]
        assert np.sqrt(np.mean(left**2)) < 0.03 * size + 5, (name, size)
        if size < 10:  # a lag nearly leaves the midline as it is
            continue
        assert moved[there] @ row[there] / (row[there] @ row[there]) == pytest.approx(1, abs=0.05)


@pytest.mark.parametrize("test", list(PLAN))
def test_what_shared_errors_add_is_in_the_shape_of_each(right, test):
    found = right[test]
    curve = found.measured
    names = [one.source for one in curve.component]
    rows = dict(zip(names, curve.contribution_of(found.judged), strict=True))
    tension = curve.tension_of(found.judged)
    there = np.isfinite(tension)
    np.testing.assert_allclose(rows["tension_gain"][there], 0.01 * tension[there], rtol=0.01)
    np.testing.assert_allclose(rows["tension_offset"][there], 10 * LBF, rtol=1e-9)
    np.testing.assert_allclose(rows["temperature"][there], 0.02 * tension[there], rtol=0.01)
    errors = dict(zip(names, curve.strain_error, strict=True))
    strain = curve.strain
    np.testing.assert_allclose(errors["strain_gain"], 0.005 * strain, rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(np.abs(errors["strain_calibration"]), strain * 0.05 / LENGTH,
                               rtol=1e-3, atol=1e-7)  # fmt: skip
    np.testing.assert_allclose(errors["position_gain"], 0.001 * strain, rtol=1e-3, atol=1e-12)
    assert "position_offset" not in errors
    assert not any(
        "calibration uncertainty is stated" in note for note in map(str, found.validation.notes)
    )


GAIN = '[uncertainty.tension]\ngain = "5 %"\n'
NOISE = '[uncertainty.tension]\nnoise = "50 lbf"\nresolution = "10 lbf"\n'
STRAIN = '[uncertainty]\nstrain = "5 %"\n'
WARM = '[uncertainty.temperature]\nvalue = "5 K"\nstiffness_per_kelvin = "1 %"\n'


def without_length(text):
    return text.replace('gauge_length_standard_uncertainty = "0.05 in"\n', "")


def without_channels(text):
    return text.replace(', standard_uncertainty = "0.02 in"', "").replace(
        ', standard_uncertainty = "5 lbf"', ""
    )


def test_a_gain_is_a_share_of_the_tension_at_every_strain(tmp_path):
    found = compared(tmp_path, GAIN, edit=without_length)
    curve, u = found.measured, found.validation.measurement_standard_uncertainty
    tension = curve.midline_tension
    own = curve.midline_standard_uncertainty
    for level, expected in ((138.0, 6.9), (4970.0, 248.5), (16366.0, 818.3)):
        place = np.nanargmin(np.abs(tension - level))
        assert np.sqrt(u[place] ** 2 - own[place] ** 2) == pytest.approx(expected, rel=0.01)
    # with an exact design nothing but a scale is open: what a scale cannot make is a difference
    assert found.validation.chi_square_freedom > 90


@pytest.mark.nightly
def test_noise_of_one_reading_is_no_error_that_samples_share(tmp_path):
    """Thousands of samples average it, and their scatter holds it already."""
    found = [
        compared(tmp_path / str(k), text, edit=edit)
        for k, (text, edit) in enumerate(
            ((NOISE, without_channels), ("", without_channels), ("", lambda text: text))
        )
    ]
    assert {one.validation.verdict for one in found} == {found[0].validation.verdict}
    for one in found:
        # the gauge length, and the step of 0.001 in of the position at the rest of zero strain
        assert [each.source for each in one.measured.component] == ["strain_calibration"] * 2
        assert any(
            "no load cell uncertainty is stated" in note for note in map(str, one.validation.notes)
        )
        assert not any("has no curve" in note for note in map(str, one.notes))


@pytest.mark.parametrize(
    ("text", "source", "share"),
    [
        pytest.param(STRAIN, "strain_gain", None, marks=pytest.mark.nightly),
        pytest.param(WARM, "temperature", 0.05, marks=pytest.mark.nightly),
    ],
)
def test_strain_and_temperature_reach_a_comparison_as_they_reach_the_test(
    tmp_path, text, source, share
):
    campaign, processed = reduced(tmp_path, text, edit=without_length)
    plan = campaign.comparisons["H64-static"]
    named = compare_archive(processed / "L-64.nc", campaign.hoses["H64"], plan)
    curve = named.comparison.measured
    # beside the step of the position at the rest of zero strain
    rows = curve.contribution_of("ascending")
    assert sorted(one.source for one in curve.component) == sorted([source, "strain_calibration"])
    (row,) = (
        of_error
        for of_error, one in zip(rows, curve.component, strict=True)
        if one.source == source
    )
    with open_archive(processed / "L-64.nc") as archive:
        strain = archive["strain_bin"].to_numpy()
        tension = archive["branch_tension"].to_numpy()[0, 0]
        rows = archive["branch_tension_uncertainty_contribution"].to_numpy()[:, 0, 0]
        sources = archive["uncertainty_source"].to_numpy().tolist()
    of_test = np.abs(rows[sources.index(source)]) / tension
    here = np.abs(row) / curve.tension_of("ascending")
    for at in (0.3, 0.7, 0.9):
        expected = np.interp(at, strain, of_test)
        # two ways to take a slope: of a window, and from bin to bin
        assert np.interp(at, curve.strain, here) == pytest.approx(expected, rel=0.05)
        if share is not None:
            assert expected == pytest.approx(share, rel=0.01)
    assert not any("calibration uncertainty is stated" in note for note in map(str, named.notes))


def test_that_nothing_is_stated_is_said_where_nothing_is(tmp_path):
    found = compared(tmp_path, "", edit=without_length)
    # the log itself shows the step of the position at the rest of zero strain
    assert [one.source for one in found.measured.component] == ["strain_calibration"]
    assert any(
        "no load cell uncertainty is stated" in one for one in map(str, found.validation.notes)
    )


@pytest.mark.nightly
def test_a_hose_without_a_diameter_says_that_its_lag_is_left_out(tmp_path):
    campaign, processed = reduced(
        tmp_path, '[uncertainty]\nlag = "1 ms"\n' + GAIN,
        edit=lambda text: text.replace('diameter = ["5 in"]\n', ""),
    )  # fmt: skip
    plan = campaign.comparisons["H64-static"]
    named = compare_archive(processed / "L-64.nc", campaign.hoses["H64"], plan)
    assert any("has no curve with instrument errors" in note for note in map(str, named.notes))
    # the gain of the load, and the length that strain is over, count all the same
    measured = named.comparison.measured
    assert "tension_gain" in [one.source for one in measured.component]
    of_length = max(np.abs(measured.strain_error), key=np.max)
    np.testing.assert_allclose(of_length, measured.strain * 0.05 / LENGTH, atol=1e-12)

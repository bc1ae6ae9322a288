"""SPEC.toml of an experiment: levels and limits in SI, or as shares; refusals are CLI tests."""

import pytest

from reduction.campaign.experiment_plans import _response_unit, load_spec
from reduction.record.errors import SettingsError

LBF = 4.4482216152605


@pytest.fixture
def load(tmp_path):
    def load_text(text):
        (tmp_path / "SPEC.toml").write_text(text)
        return load_spec(tmp_path / "SPEC.toml")

    return load_text


def test_an_empty_spec_declares_nothing(load):
    spec = load("")
    assert spec.keys.kind is None and spec.factors == () and spec.responses == ()
    assert (
        spec.keys.levels == "engineering"
        and spec.keys.sigma == (None, "1")
        and spec.keys.repeats == "together"
    )


def test_any_factor_has_the_dimension_of_its_unit(load):
    spec = load('[factors]\nT = ["5 degC", "25 degC"]\nx = [1, 2]\ndepth = ["1 ft", "2 ft"]\n')
    axes = [factor.axis(None) for factor in spec.factors]
    assert [unit for unit, _, _ in axes] == ["K", "1", "m"]
    assert axes[0][1:] == pytest.approx((278.15, 298.15))
    assert axes[2][1:] == pytest.approx((0.3048, 0.6096))


def test_a_share_becomes_a_force_where_the_strength_is_known(load):
    spec = load('[factors]\nmean_tension = ["12 %RBS", "30 %RBS"]\n')
    assert spec.factors[0].axis(None) == ("1", 0.12, 0.3)
    assert spec.factors[0].axis(1000.0) == ("N", 120.0, 300.0)


@pytest.mark.parametrize(
    ("written", "limits"),
    [("40 %RBS", (None, 0.4)), ("100 lbf", (100 * LBF, None)), ("2 kN", (2000.0, None))],
)
def test_a_load_limit_is_a_force_or_a_share(load, written, limits):
    spec = load(f'[experiment]\nload_limit = "{written}"\n')
    assert spec.keys.load_limit == pytest.approx(limits)


@pytest.mark.parametrize(
    ("written", "sigma"),
    [
        ("2 %", (0.02, "1")),
        ("0.02", (0.02, "1")),
        ("5 lbf", (5 * LBF, "N")),
        ("3 J/m", (3.0, "J m-1")),
    ],
)
def test_sigma_is_a_share_or_in_a_unit(load, written, sigma):
    spec = load(f'[experiment]\nsigma = "{written}"\n')
    assert spec.keys.sigma == (pytest.approx(sigma[0]), sigma[1])


def test_units_of_quantities_are_spelt_as_in_products():
    assert _response_unit("hysteresis_energy", "lbf") == ("J m-1", pytest.approx(LBF), 0.0)
    assert _response_unit("loop energy", "lbf ft / ft") == ("J m-1", pytest.approx(LBF), 0.0)
    assert _response_unit("stiffness", "kN") == ("N", pytest.approx(1000), 0.0)
    assert _response_unit("life", "") == ("", 1.0, 0.0)
    with pytest.raises(SettingsError, match="unit 'lbf' is not a unit of relaxation_time"):
        _response_unit("relaxation_time", "lbf")


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ('[factors]\nx = ["1 m", "2 ft"]', "factors.x: the two levels of x are given in different"),
        ('[factors]\nmean_tension = ["12 %RBS", "30 % of mean"]', "factors.mean_tension: the two"),
        ('[factors]\nx = ["one", "two"]', "factors.x: a value is not a number; found 'one'"),
        ('[factors]\n"x*y" = [1, 2]', "factors"),
        ("[responses]\ny = { unit = 3 }", "responses.y.unit"),
        ('[experiment]\nkind = "latin-square"', "experiment.kind"),
        ("[experiment]\nn_centre = -1", "experiment.n_centre"),
        ('[experiment]\nload_limit = "10 s"', "experiment.load_limit: unit 's' is not"),
        ("[experiments]\n", "experiments"),
    ],
)
def test_a_value_that_cannot_be_used_is_told_by_its_key(load, text, place):
    with pytest.raises(SettingsError) as refused:
        load(text)
    assert "SPEC.toml: " in str(refused.value) and place in str(refused.value)

"""``[uncertainty]``: every form in which it is printed, and every way to get it wrong."""

import json
from pathlib import Path

import pytest
from pydantic import ValidationError

from reduction.campaign.model import CampaignFile, UncertaintySection, stated_errors
from reduction.campaign.toml_file import faults_of, read_toml
from reduction.record.errors import SettingsError
from reduction.record.measurement import Specimen

PATH = Path("campaign.toml")
LBF = 4.4482216152605


CAMPAIGN = '[campaign]\nid = "c"\ntitle = "t"\n'


def inline(value):
    """A table of TOML in one line."""
    if not isinstance(value, dict):
        return json.dumps(value)
    return "{" + ", ".join(f"{key} = {inline(one)}" for key, one in value.items()) + "}"


def errors(**section):
    text = f"uncertainty = {inline(section)}\n{CAMPAIGN}"
    file = read_toml(PATH, CampaignFile, what="it", needed="it", keys="docs", text=text)
    return stated_errors(PATH, file.uncertainty)


def test_what_is_not_stated_is_zero():
    found = errors()
    assert found.tension_gain == found.lag == found.diameter == found.stiffness == 0.0


def test_a_plain_value_is_a_standard_uncertainty():
    found = errors(tension={"gain": "0.1 %", "offset": "0.5 lbf"}, lag="2 ms")
    assert found.tension_gain == pytest.approx(0.001)
    assert found.tension_offset == pytest.approx(0.5 * LBF)
    assert found.lag == pytest.approx(0.002)


def test_an_expanded_value_is_over_its_k():
    assert errors(tension={"gain": {"expanded": "0.2 %", "k": 2}}).tension_gain == pytest.approx(
        0.001
    )


def test_limits_are_over_the_root_of_three_and_triangular_ones_of_six():
    found = errors(diameter={"half_width": "0.003 in"})
    assert found.diameter == pytest.approx(0.003 * 0.0254 / 3**0.5)
    found = errors(diameter={"half_width": "0.003 in", "shape": "triangular"})
    assert found.diameter == pytest.approx(0.003 * 0.0254 / 6**0.5)


def test_noise_and_resolution_are_of_one_reading():
    found = errors(tension={"noise": "0.3 N", "resolution": "1 N"})
    assert found.tension_reading == pytest.approx((0.3**2 + 1 / 12) ** 0.5)


def test_a_temperature_moves_the_stiffness():
    found = errors(temperature={"value": "2 K", "stiffness_per_kelvin": "-0.3 %"})
    assert found.stiffness == pytest.approx(0.006)


@pytest.mark.parametrize(
    ("section", "words"),
    [
        ({"tension": {"gain": "0.5 lbf"}}, r"uncertainty\.tension\.gain"),
        ({"tension": {"offset": "0.1 %"}}, r"uncertainty\.tension\.offset"),
        ({"lag": {"expanded": "2 m", "k": 2}}, r"uncertainty\.lag\.expanded: unit 'm'"),
        ({"lag": {"half_width": "2 m"}}, r"uncertainty\.lag\.half_width: unit 'm'"),
        ({"tension": {"gain": "-0.1 %"}}, "not a standard uncertainty.*zero or more"),
        ({"tension": {"gain": 60}}, "at most 50 %"),
        ({"tension": {"gain": 0.25}}, r"gain: a share .*which is 25 %; needed .25 %., or .0\.25 %"),
        (
            {"strain": {"half_width": "0.2"}},
            r"strain\.half_width: a share this large needs its sign",
        ),
        ({"lag": {"expanded": "2 ms", "k": 0}}, r"uncertainty\.lag.*coverage_factor"),
        (
            {"temperature": {"value": "2 degC", "stiffness_per_kelvin": "0.3 %"}},
            "as a difference: in K",
        ),
        (
            {"temperature": {"value": "90 K", "stiffness_per_kelvin": "300 %"}},
            r"uncertainty\.temperature: value times stiffness_per_kelvin is not a standard uncertainty; "
            "found 27,000 % of the stiffness; needed at most 50 %",
        ),
    ],
)
def test_what_cannot_be_meant_is_refused_with_its_key(section, words):
    with pytest.raises(SettingsError, match=words):
        errors(**section)


@pytest.mark.parametrize(
    ("stated", "fault"),
    [
        ({"expanded": "2 mm"}, "tape.k: is required"),
        (
            {"half_width": "2 mm", "shape": "rectangle"},
            "tape.shape: Input should be 'rectangular', 'triangular' or 'arcsine'; found 'rectangle'",
        ),
    ],
)
def test_a_fault_in_one_form_is_not_told_of_the_other(stated, fault):
    table = {"tape": stated}
    with pytest.raises(ValidationError) as refused:
        UncertaintySection.model_validate(table)
    assert [str(one) for one in faults_of(refused.value, table, UncertaintySection)] == [fault]


def test_an_error_of_a_diameter_is_small_against_it():
    half_an_inch = Specimen("rope", diameter=(0.0127,))
    section = UncertaintySection.model_validate({"diameter": "0.1 in"})
    assert stated_errors(PATH, section, [half_an_inch]).diameter == pytest.approx(0.00254)
    section = UncertaintySection.model_validate({"diameter": "3 in"})
    words = (
        r"campaign.toml: uncertainty\.diameter: this is not a standard uncertainty of the diameter of "
        r"'rope'; found 76.2 mm of 12.7 mm; needed at most 20 % of it"
    )
    with pytest.raises(SettingsError, match=words):
        stated_errors(PATH, section, [half_an_inch])
    # a line of unknown diameter bounds nothing
    assert stated_errors(PATH, section, [Specimen("chain")]).diameter == pytest.approx(0.0762)


def test_channels_share_a_load_cell_only_where_that_is_said():
    apart = errors(tension={"gain": "0.1 %"})
    first = apart.of_channel("new", channel=1, test="T-1", load_cell="LC-3")
    other = apart.of_channel("used", channel=2, test="T-1", load_cell="LC-3")
    assert first.tension_instrument != other.tension_instrument
    again = apart.of_channel("new", channel=1, test="T-2", load_cell="LC-3")
    assert first.tension_instrument == again.tension_instrument
    one = errors(tension={"gain": "0.1 %", "one_load_cell": True})
    assert (
        one.of_channel("new", channel=1, test="T-1").tension_instrument
        == one.of_channel("used", channel=2, test="T-1").tension_instrument
    )

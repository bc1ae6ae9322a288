"""Predicted hoses in an archive: every number in its place, what is not known absent, CF kept."""

import hashlib
from dataclasses import fields

import numpy as np
import pytest
from predicted_hoses import (
    CORD_LOAD,
    CORD_STRAIN,
    LAYERS,
    UNCERTAIN,
    dataset,
    pick_up_strain,
    predicted,
    working_tension,
)
from rulesofcf import hold_against_cf

from reduction.archive import open as opening
from reduction.archive.campaign_products import EVENTS
from reduction.archive.open import ReadOnce, open_archive
from reduction.archive.write import write_archive
from reduction.batch.prediction_product import write_hoses
from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_prediction import _LayerResponse
from reduction.prediction.hose_product import HosePrediction
from reduction.quantities.flags import HOSE_STATES
from reduction.quantities.names import PREDICTION_SCHEMA
from reduction.record.measurement import Source

SHORT_CORD = CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0]))


@pytest.fixture(scope="module")
def hoses():
    """A long and a short one: no uncertainty, no layer, two points of cord."""
    short = predicted("stiff", 50.0, uncertain={}, layers=(), cord=SHORT_CORD)
    return predicted(), short


@pytest.fixture(scope="module")
def path(hoses, tmp_path_factory):
    path = tmp_path_factory.mktemp("archive") / "predictions.nc"
    write_archive(dataset(*hoses), path)
    return path


@pytest.fixture
def archive(path):
    with open_archive(path) as data:
        yield data.load()


def test_what_was_just_written_is_given_without_the_file_being_read(hoses, tmp_path, monkeypatch):
    path, opener = tmp_path / "predictions.nc", ReadOnce()
    source = Source("campaign.toml", "0" * 64, 1)
    write_hoses(
        hoses, path, campaign_id="a", attributes={}, source=source, command="run", opener=opener
    )
    with open_archive(path) as on_disk:
        monkeypatch.delattr(opening, "reading")
        with opener(path) as kept:
            assert kept.identical(on_disk)
            assert list(kept.variables) == list(on_disk.variables)


def test_every_response_comes_back_at_every_strain(archive, hoses):
    names = [one.name for one in fields(HosePrediction) if not one.name.startswith("is_")]
    for row, hose in enumerate(hoses):
        size = hose.prediction.strain.size
        for name in names:
            stored = archive[name].values[row]
            np.testing.assert_array_equal(stored[:size], getattr(hose.prediction, name))
            assert np.isnan(stored[size:]).all(), name
    assert archive.sizes["hose_point"] == hoses[0].prediction.strain.size
    assert hoses[1].prediction.strain.size < hoses[0].prediction.strain.size


def test_the_states_of_a_hose_are_masks_that_say_what_they_mean(archive, hoses):
    state = archive["hose_state"]
    assert state.dims == ("hose", "hose_point")
    meanings = dict(
        zip(state.attrs["flag_meanings"].split(), state.attrs["flag_masks"], strict=True)
    )
    assert meanings == HOSE_STATES
    size = hoses[0].prediction.strain.size
    is_slack = (state.values[0, :size] & meanings["slack"]) > 0
    # 68 degrees: slack until the closed form says so
    np.testing.assert_array_equal(is_slack, archive["strain"].values[0] <= pick_up_strain(68))
    beyond = hoses[1].prediction.strain.size
    assert not state.values[1, beyond:].any()


def test_strains_beyond_the_break_jammed_and_narrow_are_flagged(tmp_path):
    hose = predicted(
        greatest_strain=2.5, cord_diameter=0.00075, minimum_inner_diameter=0.05, layers=()
    )
    data = dataset(hose)
    state, strain = data["hose_state"].values[0], data["strain"].values[0]
    broken, jammed, narrow = (
        (state & HOSE_STATES[name]) > 0 for name in ("broken", "jammed", "bore_too_small")
    )
    assert broken.any() and jammed.any() and narrow.any()
    assert np.isnan(data["tension"].values[0][broken]).all()
    # constant volume: the bore is 63.5 mm over the root of the stretch
    np.testing.assert_array_equal(narrow, 0.0635 / np.sqrt(1 + strain) < 0.05)
    spacing = data["cord_spacing"].values[0]
    np.testing.assert_array_equal(jammed, spacing < 0.00075)


def test_events_stand_by_name_with_the_numbers_of_the_closed_forms(archive):
    assert tuple(archive["hose_event"].values) == EVENTS
    one = archive.sel(hose="gumby")
    assert float(one["event_strain"].sel(hose_event="pick_up")) == pytest.approx(pick_up_strain(68))
    assert float(one["event_tension"].sel(hose_event="working")) == pytest.approx(
        working_tension(68), rel=1e-9
    )
    assert float(one["event_cord_tension"].sel(hose_event="cord_break")) == CORD_LOAD[-1]
    assert one["event_tension"].attrs["ancillary_variables"] == "event_tension_standard_uncertainty"


def test_the_design_and_its_stated_uncertainties_come_back(archive, hoses):
    design = hoses[0].plan.design
    assert archive["wrap_angle"].values.tolist() == [np.radians(68.0), np.radians(50.0)]
    assert archive["layer_diameter"].values[0].tolist() == list(map(float, design.layer_diameter))
    assert archive["rubber_law"].values.tolist() == ["neo-hookean"] * 2
    np.testing.assert_array_equal(archive["cord_curve_strain"].values[0], CORD_STRAIN)
    np.testing.assert_array_equal(archive["cord_curve_load"].values[1][:2], SHORT_CORD.load)
    assert np.isnan(archive["cord_curve_load"].values[1][2:]).all()
    for name, value in UNCERTAIN.items():
        first, second = archive[f"{name}_standard_uncertainty"].values
        assert first == value and np.isnan(second)
    # a ribbon is pi d cos a wide, and there are 34 cords an inch in two of them
    width = np.pi * np.array([3.4, 3.6]) * 0.0254 * np.cos(np.radians(68))
    assert archive["ribbon_width"].values[0] == pytest.approx(width)
    assert float(archive["number_of_cords"][0]) == pytest.approx(width.sum() * 34 / 0.0254)


def test_what_is_not_stated_has_no_variable(archive):
    assert "inner_diameter_standard_uncertainty" not in archive
    bare = dataset(predicted(uncertain={}, layers=()))
    assert not [name for name in bare.variables if "uncertain" in str(name)]
    assert not [name for name in bare.variables if "contribution" in str(name)]
    assert not [name for name in bare.variables if str(name).startswith("hose_layer")]


def test_a_hose_of_which_nothing_is_stated_has_no_uncertainty_rather_than_none_at_all(archive):
    assert np.isnan(archive["tension_standard_uncertainty"].values[1]).all()
    assert np.isnan(archive["event_tension_standard_uncertainty"].values[1]).all()


def test_contributions_add_in_squares_to_the_uncertainty(archive):
    assert archive["uncertainty_source"].values.tolist() == [*UNCERTAIN, "pick_up"]
    for name in ("tension", "fill_pressure"):
        parts = archive[f"{name}_contribution"].values[0]
        together = archive[f"{name}_standard_uncertainty"].values[0]
        np.testing.assert_allclose(np.sqrt((parts**2).sum(axis=0)), together, rtol=1e-12)
    # a steeper hose is softer, a stiffer rubber is not: contributions keep their sign
    angle, modulus, _, _ = archive["tension_contribution"].values[0][:, -1]
    assert angle < 0 < modulus


def test_sources_of_one_hose_are_nothing_to_another():
    other = predicted("other", uncertain={"outer_diameter": 1e-4})
    data = dataset(predicted(), other)
    assert data["uncertainty_source"].values.tolist() == [
        "wrap_angle", "outer_diameter", "rubber_modulus", "cord_load_scale", "pick_up",
    ]  # fmt: skip
    parts = data["tension_contribution"].values
    assert not parts[0, 1].any() and parts[1, 1].any()
    assert not parts[1, [0, 2, 3, 4]].any()


def test_both_layers_share_the_uncertainty_of_their_diameter():
    data = dataset(predicted(uncertain={"layer_diameter": 5e-4}))
    assert data["layer_diameter_standard_uncertainty"].values.tolist() == [[5e-4, 5e-4]]


def test_layers_that_carry_no_load_stand_in_their_order(archive, hoses):
    assert archive["hose_layer_name"].values.tolist() == [["Kevlar", "conductors"], ["", ""]]
    assert archive["hose_layer_wrap_angle"].values[0].tolist() == [one.wrap_angle for one in LAYERS]
    for name in _LayerResponse.__dataclass_fields__.keys() - {"layer"}:
        np.testing.assert_array_equal(
            archive[f"hose_layer_{name}"].values[0], [getattr(one, name) for one in hoses[0].layers]
        )
    assert np.isnan(archive["hose_layer_compression_limit"].values[0, 1])


def test_notes_stand_beside_their_hose(archive, hoses):
    pairs = list(zip(archive["note_hose"].values, archive["note"].values, strict=True))
    assert pairs == [(hose.plan.name, note) for hose in hoses for note in map(str, hose.notes)]
    assert ("stiff" in dict(pairs)) and "Kevlar" in dict(pairs)["gumby"]


def test_the_archive_says_where_it_comes_from(archive):
    assert archive.attrs["id"] == "hoses/predictions"
    assert archive.attrs["raw_file"] == "hose.toml"
    assert archive.attrs["raw_file_sha256"] == "ab" * 32
    assert archive.attrs["summary"].endswith("gumby and stiff, from construction alone.")


def test_every_variable_is_of_the_schema_with_its_dimensions(archive):
    for name, variable in archive.variables.items():
        assert variable.dims == PREDICTION_SCHEMA[str(name)].dims


def test_the_file_keeps_every_rule(path):
    hold_against_cf(path)


def test_equal_hoses_give_equal_bytes(path, hoses, tmp_path):
    write_archive(dataset(*hoses), tmp_path / "again.nc")
    first, second = (hashlib.sha256(one.read_bytes()) for one in (path, tmp_path / "again.nc"))
    assert first.digest() == second.digest()

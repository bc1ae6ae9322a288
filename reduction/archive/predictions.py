"""The predictions of a campaign as one dataset that follows CF."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from reduction.archive.attributes import part_attributes
from reduction.archive.build import build_dataset
from reduction.archive.prediction_schema import HOSE_STATES, PREDICTION_SCHEMA
from reduction.archive.values import Values, pad, pad_texts, texts
from reduction.errors import ArchiveError
from reduction.predict.product import HOSE_PARAMETERS, HoseEvents
from reduction.predict.uncertainty import EventUncertainty
from reduction.prediction import PredictedHose
from reduction.provenance import Origin
from reduction.record import Floats

EVENTS = ("deepest_slack", "pick_up", "working", "cord_break")
_STATES = {
    "slack": "is_slack",
    "broken": "is_broken",
    "jammed": "is_jammed",
    "bore_too_small": "is_bore_too_small",
}
_ALONG = (
    "strain", "free_strain", "tension", "fill_pressure", "cord_tension", "cord_strain",
    "cord_share", "rubber_share", "end_cap_load", "current_wrap_angle", "cord_spacing",
    "current_inner_diameter",
)  # fmt: skip
_AT_EVENT = ("strain", "tension", "fill_pressure", "cord_tension", "cord_strain")
_DESIGN = (
    "wrap_angle", "inner_diameter", "outer_diameter", "cords_per_length", "cord_diameter",
    "rubber_modulus", "working_share", "cord_load_scale", "cord_strain_scale",
    "dead_length_share", "minimum_inner_diameter",
)  # fmt: skip
_OF_LAYER = ("least_strain", "greatest_strain", "break_strain", "least_angle", "greatest_angle")


def predictions_to_dataset(hoses: Sequence[PredictedHose], *, origin: Origin) -> xr.Dataset:
    """Bring predictions into the form of the archive; no file is touched.

    Parameters
    ----------
    hoses : sequence of PredictedHose
        One or more, each with a name of its own.
    origin : Origin
        The campaign, and the file that says how the hoses are made.

    Returns
    -------
    dataset : xarray.Dataset
        Names, dimensions and attributes of `PREDICTION_SCHEMA`, encoding included. Equal
        inputs give equal datasets.

    Raises
    ------
    ArchiveError
        If there is no hose, or two have one name.
    """
    names = [hose.plan.name for hose in hoses]
    if not hoses or len(set(names)) < len(names):
        raise ArchiveError(
            "the predictions cannot be kept", found=", ".join(names) or "none",
            needed="one or more hoses, each with a name of its own",
        )  # fmt: skip
    values: Values = {
        "hose": texts(names),
        "hose_event": texts(EVENTS),
        "cord_layer": texts(("inner", "outer")),
        "rubber_law": texts([hose.plan.design.rubber_law for hose in hoses]),
        "note_hose": texts([hose.plan.name for hose in hoses for _ in hose.notes]),
        "note": texts([note for hose in hoses for note in hose.notes]),
    }
    values |= _design_values(hoses) | _curve_values(hoses) | _event_values(hoses)
    values |= _uncertainty_values(hoses) | _layer_values(hoses)
    for axis, along in (("hose_point", "strain"), ("cord_point", "cord_curve_strain")):
        values[axis] = np.arange(1, values[along].shape[1] + 1)
    return build_dataset(
        values,
        PREDICTION_SCHEMA,
        attributes=part_attributes("predictions", names, origin=origin),
    )


def _design_values(hoses: Sequence[PredictedHose]) -> Values:
    designs = [hose.plan.design for hose in hoses]
    values: Values = {
        name: np.array([float(getattr(design, name)) for design in designs]) for name in _DESIGN
    }
    values["layer_diameter"] = np.array([design.layer_diameter for design in designs], dtype=float)
    values["ribbon_width"] = np.array([hose.ribbon_width for hose in hoses])
    values["number_of_cords"] = np.array([hose.number_of_cords for hose in hoses])
    values["cord_curve_strain"] = pad([design.cord.strain for design in designs])
    values["cord_curve_load"] = pad([design.cord.load for design in designs])
    for name in HOSE_PARAMETERS:
        spread = np.array(
            [hose.plan.standard_uncertainty.get(name, np.nan) for hose in hoses], dtype=float
        )
        if np.isfinite(spread).any():
            both = name == "layer_diameter"
            values[f"{name}_standard_uncertainty"] = np.stack([spread] * 2, 1) if both else spread
    return values


def _curve_values(hoses: Sequence[PredictedHose]) -> Values:
    values: Values = {
        name: pad([getattr(hose.prediction, name) for hose in hoses]) for name in _ALONG
    }
    state = np.zeros(values["strain"].shape, dtype=np.uint16)
    for row, hose in zip(state, hoses, strict=True):
        for name, bit in HOSE_STATES.items():
            is_so = getattr(hose.prediction, _STATES[name])
            row[: is_so.size] |= np.where(is_so, bit, 0).astype(np.uint16)
    return values | {"hose_state": state}


def _event_values(hoses: Sequence[PredictedHose]) -> Values:
    def at(events: HoseEvents, name: str) -> list[float]:
        return [float(getattr(getattr(events, event), name)) for event in EVENTS]

    return {
        f"event_{name}": np.array([at(hose.events, name) for hose in hoses]) for name in _AT_EVENT
    }


def _uncertainty_values(hoses: Sequence[PredictedHose]) -> Values:
    """Nothing of hoses of which no number is uncertain."""
    given = [hose.uncertainty for hose in hoses]
    sources = [name for name in HOSE_PARAMETERS if any(name in one.source for one in given)]
    if not sources:
        return {}
    n_points = max(hose.prediction.strain.size for hose in hoses)
    values: Values = {"uncertainty_source": texts(sources)}
    for name in ("tension", "fill_pressure"):
        parts = np.full((len(hoses), len(sources), n_points), np.nan)
        for part, hose in zip(parts, hoses, strict=True):
            found: Floats = getattr(hose.uncertainty, f"{name}_contribution")
            part[:, : found.shape[-1]] = 0.0
            for source, row in zip(hose.uncertainty.source, found, strict=True):
                part[sources.index(source), : row.size] = row
        values[f"{name}_contribution"] = parts
        values[f"{name}_standard_uncertainty"] = pad(
            [
                _nan_where_exact(hose, getattr(hose.uncertainty, f"{name}_standard_uncertainty"))
                for hose in hoses
            ]
        )
    for name in ("strain", "tension", "fill_pressure"):
        values[f"event_{name}_standard_uncertainty"] = np.array(
            [[_at_event(hose, event, name) for event in EVENTS] for hose in hoses]
        )
    return values


def _nan_where_exact(hose: PredictedHose, values: Floats) -> Floats:
    """NaN, not zero, of a hose of which no number is uncertain."""
    return values if hose.uncertainty.source else np.full(values.shape, np.nan)


def _at_event(hose: PredictedHose, event: str, name: str) -> float:
    found: EventUncertainty = getattr(hose.uncertainty, event)
    if not hose.uncertainty.source:
        return np.nan
    return float(getattr(found, f"{name}_standard_uncertainty"))


def _layer_values(hoses: Sequence[PredictedHose]) -> Values:
    most = max(len(hose.layers) for hose in hoses)
    if not most:
        return {}
    values: Values = {
        "hose_layer": np.arange(1, most + 1),
        "hose_layer_name": pad_texts([[one.layer.name for one in hose.layers] for hose in hoses]),
    }
    for name in ("wrap_angle", "strain_limit", "compression_limit"):
        values[f"hose_layer_{name}"] = pad(
            [[getattr(one.layer, name) for one in hose.layers] for hose in hoses]
        )
    for name in _OF_LAYER:
        values[f"hose_layer_{name}"] = pad(
            [[getattr(one, name) for one in hose.layers] for hose in hoses]
        )
    return values

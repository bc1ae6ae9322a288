"""What the page is sent: tests, settings, figures and tables as JSON, every name as plain text."""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from typing import Any

import numpy as np

from reduction.batch.survey import Survey
from reduction.campaign.numbers import dimension_of, limits_of
from reduction.errors import ReductionError
from reduction.explore.answers import answer_table
from reduction.explore.figures import draw_change
from reduction.explore.file import CampaignText, Written
from reduction.explore.keys import Setting, settings_of_kind
from reduction.explore.session import Made, Session
from reduction.report.figure import Figure
from reduction.report.htmltable import Table, number_text
from reduction.report.summary import all_notes
from reduction.report.view import TestView
from reduction.units import UnitSystem, display_unit, parse_quantity

__all__ = ["campaign_document", "change_document"]

# where the archive says what was found for a number that nobody stated
_FOUND = {
    "phases.position_tolerance": ("standstill_position_tolerance",),
    "phases.tension_tolerance": ("hold_tension_tolerance",),
    "phases.slack_tension": ("slack_tension",),
    "cycles.band": ("position_band", "tension_band"),
    "modulus.window": ("strain_window",),
}
_SLOW = 2.0
"""A change that takes longer is told beforehand. [s]"""


def campaign_document(session: Session, units: UnitSystem) -> dict[str, Any]:
    """The campaign and its tests."""
    attributes = session.campaign.attributes
    return {
        "campaign": session.campaign.id,
        "title": attributes.get("title", ""),
        "synthetic": attributes.get("synthetic") == "yes",
        "file": str(session.path),
        "units": units,
        "tests": [
            {
                "id": one.plan.id,
                "kind": one.plan.kind,
                "rows": one.n_rows,
                "error": "" if one.error is None else session.campaign.in_words(str(one.error)),
            }
            for one in session.surveys
        ],
    }


def change_document(
    session: Session,
    test: str,
    text: CampaignText,
    before: Made,
    after: Made,
    units: UnitSystem,
) -> dict[str, Any]:
    """Settings, answers and figures of a test, and the diff of campaign.toml.

    Parameters
    ----------
    session : Session
        The campaign.
    test : str
        Id of the product.
    text : CampaignText
        What campaign.toml would say.
    before, after : Made
        The test as the file on the disk has it, and as that text has it.
    units : UnitSystem
        What a reader is shown.
    """
    views = [
        None if one.dataset is None else TestView(name, one.dataset, units)
        for name, one in (("before", before), ("after", after))
    ]
    is_same = text.digest == session.text.digest
    old, new = (views[0], views[0]) if is_same else views
    of_cycles = [one.survey.plan.settings.cycles for one in (before, after)]
    left_out = (of_cycles[0].break_in_cycles, of_cycles[1].break_in_cycles)
    table = answer_table(old, new)
    return {
        "test": test,
        "settings": _settings(session, text, after, new, units),
        "error": after.error,
        "notes": [] if new is None else all_notes(new),
        "answers": None if table is None else _table(table),
        "figures": [_figure(one) for one in draw_change(old, new, left_out=left_out)],
        "diff": session.text.difference(text),
        "before": session.text.digest,
        "after": text.digest,
        "also": list(after.also),
        "is_standing": before.is_standing,
        "seconds": after.seconds,
        "rows": after.survey.n_rows,
        "is_slow": not is_same and after.seconds > _SLOW,
    }


def _settings(
    session: Session, text: CampaignText, made: Made, view: TestView | None, units: UnitSystem
) -> list[dict[str, Any]]:
    survey = made.survey
    log = survey.plan.log
    found = [
        _setting(one, session, text, survey, view, units)
        for one in settings_of_kind(survey.plan.kind)
    ]
    if survey.plan.step_place:
        now = text.step_ends(log, survey.plan.step_place - 1)
        found += [
            {
                "key": key, "group": "Steps", "words": f"{key.rpartition('.')[2]}, of this step",
                "value": value, "shown": value, "place": "test", "choices": [], "slider": None,
            }
            for key, value in now.items()
        ]  # fmt: skip
    return found


def _setting(
    setting: Setting,
    session: Session,
    text: CampaignText,
    survey: Survey,
    view: TestView | None,
    units: UnitSystem,
) -> dict[str, Any]:
    written = text.written(survey.plan.log, setting)
    in_force = _in_force(setting, survey, view)
    return {
        "key": setting.key,
        "group": setting.group,
        "words": setting.words,
        "value": written.text if written.place == "test" else "",
        "shown": written.text or _shown(setting, survey, in_force, units),
        "place": _place(setting, survey, written),
        "choices": list(setting.choices),
        "slider": _slider(setting, survey, in_force),
    }


def _place(setting: Setting, survey: Survey, written: Written) -> str:
    """Where the value in force comes from; what nobody stated is a default, or was found."""
    if written.place != "nowhere" and (written.text or written.place == "table"):
        return written.place
    return "found" if _stated(setting, survey) is None else "default"


def _stated(setting: Setting, survey: Survey) -> Any:
    """Value of a setting of a plan, in SI; None where it is to be found."""
    group, _, name = setting.key.rpartition(".")
    return getattr(getattr(survey.plan.settings, group or "cycles"), name)


def _in_force(setting: Setting, survey: Survey, view: TestView | None) -> Any:
    """Value of a setting, in SI; what was found in the record where nobody stated it."""
    value = _stated(setting, survey)
    if value is not None or view is None:
        return value
    if setting.key == "strain.method":
        return ", ".join(dict.fromkeys(view.texts("strain_method")))
    if setting.key == "modulus.strain_bin_width":
        bounds = view.array("strain_bin_bounds")
        return None if bounds is None or not bounds.size else float(bounds[0, 1] - bounds[0, 0])
    values = (view.array(one) for one in _FOUND.get(setting.key, ()))
    return next((float(np.ravel(one)[0]) for one in values if one is not None and one.size), None)


def _shown(setting: Setting, survey: Survey, value: Any, units: UnitSystem) -> str:
    """A value as a person would write it, in the units that are shown."""
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    group, _, name = setting.key.partition(".")
    dimension = dimension_of(group, name, control=survey.plan.control)
    if isinstance(value, tuple):
        return ", ".join(_quantity(one, dimension, units) for one in value)
    return _quantity(float(value), dimension, units)


def _quantity(value: float, dimension: str | None, units: UnitSystem) -> str:
    if not isfinite(value):
        return ""
    if dimension == "strain":
        return f"{number_text(100 * value).rstrip('0').rstrip('.')} %"
    si = {"time": "s", "length": "m", "force": "N"}.get(dimension or "")
    if si is None:
        return f"{value:.6g}"
    unit, factor = display_unit(si, units)
    return f"{value * factor:.4g} {unit}"


def _slider(setting: Setting, survey: Survey, in_force: Any) -> dict[str, Any] | None:
    """Ends, step and place of a slider; wide enough for the value in force."""
    slider = setting.slider
    if slider is None:
        return None
    scale = 1.0
    if slider.unit:
        scale = parse_quantity(f"1 {slider.unit}", "strain")
    value = in_force / scale if isinstance(in_force, int | float) else slider.low
    group, _, name = setting.key.partition(".")
    least, greatest = limits_of(group, name)
    high = slider.high
    if setting.key == "cycles.break_in_cycles":
        high = max(1, survey.n_cycles - 1)
    return {
        "low": max(min(slider.low, value), least / scale),
        "high": min(max(high, value), greatest / scale) if isfinite(greatest) else max(high, value),
        "step": slider.step,
        "unit": slider.unit,
        "value": value,
    }


def _figure(figure: Figure) -> dict[str, Any]:
    return {
        "key": figure.key.removeprefix("after-").removeprefix("before-"),
        "caption": figure.caption + (" Synthetic data." if figure.synthetic else ""),
        "label": figure.label,
        "height": figure.height,
        "wide": figure.is_wide,
        "json": figure.json(),
    }


def _table(table: Table) -> dict[str, Any]:
    return {
        "caption": table.caption,
        "columns": list(table.columns),
        "numbers": list(table.number_columns),
        "rows": [[{"text": cell.text, "value": cell.value} for cell in row] for row in table.rows],
        "remarks": list(table.remarks),
    }


def as_json(document: Mapping[str, Any]) -> bytes:
    """A document as it is sent; a number that is not finite would be no JSON."""
    try:
        return json.dumps(document, allow_nan=False, separators=(",", ":")).encode("utf-8")
    except ValueError as error:
        raise ReductionError(f"internal error, a defect of this program: {error}") from error

"""What the explorer sends to its page."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

import numpy as np

from reduction.batch.survey import Survey
from reduction.campaign.model import dimension_of, limits_of
from reduction.pages.explorer_campaign import (
    CampaignText,
    Session,
    Setting,
    Written,
    settings_of_kind,
)
from reduction.quantities.units import UnitSystem, display_unit, parse_quantity
from reduction.record.errors import SettingsError
from reduction.report.page_template import render_section
from reduction.report.test_section import make_section
from reduction.report.test_view import TestView
from reduction.report.text_style import number_text

# where the archive says what was found for a number that nobody stated
_FOUND = {
    "phases.position_tolerance": ("standstill_position_tolerance",),
    "phases.tension_tolerance": ("hold_tension_tolerance",),
    "phases.slack_tension": ("slack_tension",),
    "cycles.band": ("position_band", "tension_band"),
    "modulus.window": ("strain_window",),
}


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
    session: Session, units: UnitSystem, *, test: str, changes: Mapping[str, str]
) -> dict[str, Any]:
    """Settings of a test, its section of the report, and the diff of campaign.toml."""
    text = session.changed(test, changes)
    made = session.made(test, text)
    key = "standing" if text.digest == session.text.digest else "changed"
    view = None if made.dataset is None else TestView(key, made.dataset, units)
    survey = made.survey
    settings = [
        _setting(one, session, text, survey, view, units)
        for one in settings_of_kind(survey.plan.kind)
    ]
    return {
        "test": test,
        "settings": settings + _step_settings(survey, text),
        "error": made.error,
        # names out of files are escaped in it, and no script of it runs
        "section": "" if view is None else render_section(make_section(view), is_folded=False).html,
        "diff": session.text.difference(text),
        "before": session.text.digest,
        "after": text.digest,
        "also": list(made.also),
        "is_standing": made.is_standing,
        "seconds": made.seconds,
        "rows": survey.n_rows,
    }


def save_document(
    session: Session, *, test: str, changes: Mapping[str, str], before: str, after: str
) -> dict[str, Any]:
    """Write what was shown; ``before`` and ``after`` are the digests that came with the diff."""
    text = session.changed(test, changes)
    if (session.text.digest, text.digest) != (before, after):
        raise SettingsError(
            "the diff that was shown is not of this file any more",
            hint="Nothing was written. Look at the diff again.",
        )
    session.save(text)
    return {"saved": str(session.path)}


def _step_settings(survey: Survey, text: CampaignText) -> list[dict[str, Any]]:
    """Both ends of a step, which are no setting of a reduction."""
    if not survey.plan.step_place:
        return []
    ends = text.step_ends(survey.plan.log, survey.plan.step_place - 1)
    return [
        {
            "key": key, "group": "Steps", "words": f"{key.rpartition('.')[2]}, of this step",
            "value": value, "shown": value, "place": "test", "choices": [], "slider": None,
        }
        for key, value in ends.items()
    ]  # fmt: skip


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

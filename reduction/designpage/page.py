"""The page as a file: what was read before stays where it still holds, and appears in one piece."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any, cast, get_args
from urllib.parse import quote

import numpy as np
from jinja2 import Environment, StrictUndefined

from reduction import __version__
from reduction.archive.open import Opener, reading
from reduction.archive.write import write_whole
from reduction.designpage.campaigns import CampaignLines, read_campaigns, state_of
from reduction.designpage.linedata import json_text, line_data
from reduction.designpage.printed import errata_told, printed_at
from reduction.published.linesource import published_sources
from reduction.surface.tested import ABOVE_LEVERAGE
from reduction.uncertainty.combine import coverage_factor
from reduction.units import Dimension, UnitSystem, display_unit, scale_to_si
from reduction.vocabulary import quantity

PAGE_NAME = "design-values.html"
MOST_BYTES = 2_500_000
"""Of the lines of campaigns on one page; of the rest it says how many archives there are."""
_REPORT = "index.html"
_FORMAT = 2
"""Of what one page keeps for the next."""
_TIMES = 3
_SHARES = np.append(1e-12, np.arange(1, 33) / 32)
"""Inverse degrees of freedom at which the page has the factor of an interval; the first is none."""
_SCRIPTS = (
    "format.js", "student.js", "surface.js", "curve.js", "loads.js", "lookup.js", "shown.js",
    "data.js", "chart.js", "form.js", "command.js", "answer.js", "page.js",
)  # fmt: skip
_DATA = re.compile(r'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)
_OF_LINES = (
    "apparent_spring_constant", "hysteresis_energy", "quasi_static_spring_constant",
    "dissipation_spring_constant", "relaxation_time", "dashpot_coefficient", "tangent_modulus",
    "branch_tension", "strain",
)  # fmt: skip
_SYMBOLS = ("K_ap", "H", "K_0", "K_1", "tau", "N")
_LEVELS: dict[str, Dimension] = {
    "frequency": "frequency", "mean_tension": "force", "tension_amplitude": "force",
    "tension": "force", "strain": "strain",
}  # fmt: skip
_GIVEN: dict[Dimension, tuple[str, ...]] = {
    "frequency": ("Hz",),
    "force": ("N", "kN", "lbf"),
    "strain": ("%", "1"),
}


def write_design_page(
    processed: Path,
    reports: Path,
    *,
    unreadable: Callable[[Path, str], None] | None = None,
    opener: Opener = reading,
) -> Path:
    """Write the page of a folder of products, or write it again.

    Parameters
    ----------
    processed : pathlib.Path
        Folder in which campaigns have theirs; an archive that cannot be read is named on the page.
    reports : pathlib.Path
        Folder of the page; one that is there is replaced in one piece.
    unreadable : callable, optional
        Told each archive that cannot be read, and why, before the page is written, which says
        it too.
    opener : Opener
        How archives are opened.

    Returns
    -------
    path : pathlib.Path
        ``design-values.html``.

    Raises
    ------
    ArchiveError
        If the disk refuses.
    """
    path = reports / PAGE_NAME
    known = _files_on(path)
    for _ in range(_TIMES):
        state = state_of(processed)
        campaigns = read_campaigns(processed, known, room=MOST_BYTES, opener=opener)
        if unreadable is not None:
            for one in campaigns:
                for name, why in one.faults.items():
                    unreadable(processed / one.name / name, why)
        write_whole(path, render_design_page(campaigns, _reports_beside(reports, campaigns)))
        if state_of(processed) == state:
            break
        # another run ended meanwhile, and the page that it wrote may just have been replaced
        known = {one.name: one.files for one in campaigns}
    return path


def render_design_page(
    campaigns: Sequence[CampaignLines] = (), reports: Mapping[str, str] | None = None
) -> str:
    """Return the page as HTML that opens from disk.

    Parameters
    ----------
    campaigns : sequence of CampaignLines
        Beside the published lines.
    reports : mapping of str to str, optional
        Address of the report of a campaign, from this page, by the name of the campaign.

    Returns
    -------
    html : str
        With everything inside.
    """
    room = files("reduction.designpage")
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    page = environment.from_string((room / "templates" / PAGE_NAME).read_text("utf-8"))
    data = _constants() | {
        "format": _FORMAT,
        "campaigns": [
            {"name": one.name, "files": one.files, "names": one.names} for one in campaigns
        ],
        "faults": [
            [one.name, name, text] for one in campaigns for name, text in one.faults.items()
        ],
        "reports": dict(reports or {}),
        "left_out": [[one.name, one.left_out] for one in campaigns if one.left_out],
    }  # fmt: skip
    return page.render(
        style=(room / "static" / "page.css").read_text("utf-8"),
        script="\n".join((room / "static" / name).read_text("utf-8") for name in _SCRIPTS),
        data=json_text(data),
    )


def _reports_beside(reports: Path, campaigns: Sequence[CampaignLines]) -> dict[str, str]:
    """Address of each campaign's report that is there, as a link takes it."""
    return {
        one.name: f"{quote(one.name)}/{_REPORT}"
        for one in campaigns
        if (reports / one.name / _REPORT).is_file()
    }


def _constants() -> dict[str, Any]:
    """What does not depend on any campaign."""
    lines = tuple(published_sources().values())
    published = [line_data(line) | {"printed": printed_at(line)} for line in lines]
    known = {name: quantity(name) for name in (*_OF_LINES, *_LEVELS)}
    units = {one.unit for one in known.values()}
    return {
        "version": __version__,
        "published": published,
        "errata": errata_told(lines),
        "quantities": {name: [one.unit, one.long_name] for name, one in known.items()},
        "symbols": dict(zip(_OF_LINES, _SYMBOLS, strict=False)),
        "shown": {
            unit: {
                system: list(display_unit(unit, cast("UnitSystem", system)))
                for system in get_args(UnitSystem)
            }
            for unit in sorted(units)
        },
        "levels": _LEVELS,
        "given": {
            dimension: [[unit, scale_to_si(unit, dimension)[0]] for unit in given]
            for dimension, given in _GIVEN.items()
        },
        "above_leverage": ABOVE_LEVERAGE,
        "coverage_factors": coverage_factor(1 / _SHARES).tolist(),
    }


def _files_on(path: Path) -> dict[str, dict[str, Any]]:
    """What the page that is there keeps of campaigns; nothing of one of another version."""
    try:
        found = _DATA.search(path.read_text(encoding="utf-8"))
        data = json.loads(found[1]) if found is not None else {}
        if (data["format"], data["version"]) != (_FORMAT, __version__):
            return {}
        return {one["name"]: one["files"] for one in data["campaigns"]}
    except (OSError, ValueError, KeyError, TypeError):
        # no page, or one that is not ours: everything is read
        return {}

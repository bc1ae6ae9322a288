"""The page of design values."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from hashlib import file_digest, sha256
from importlib.resources import files
from pathlib import Path
from typing import Any, cast, get_args
from urllib.parse import quote

import numpy as np
from jinja2 import Environment, StrictUndefined
from numpy.typing import ArrayLike

from reduction import __version__
from reduction.archive.atomic_write import write_text_atomically
from reduction.archive.open import Opener, reading
from reduction.archive.product_files import DESIGN_PAGE_NAME, STATUS_NAME
from reduction.experiments.surface_points import ABOVE_LEVERAGE
from reduction.lines.archive_source import (
    archives_of_lines,
    lines_of_open_archive,
    unique_names,
    with_runs,
)
from reduction.lines.deck_formats import FORMS
from reduction.lines.line_consistency import SOLVED, column_warnings, refitted_surfaces
from reduction.lines.line_search import joined_conditions
from reduction.lines.lookup_product import (
    LEVEL_DIMENSIONS,
    LineCurve,
    LineLevels,
    LineSource,
    LineSurface,
)
from reduction.lines.published_source import published_sources
from reduction.published.printed_cells import REPORTS, ReportId, cells_of, errata_of
from reduction.published.published_lines import published_lines
from reduction.quantities.names import quantity
from reduction.quantities.units import Dimension, UnitSystem, display_unit, scale_to_si
from reduction.record.contributions import Component, coverage_factor
from reduction.record.errors import ReductionError
from reduction.stages.three_parameter_line.line_product import REASONS

_TEXTS = ("name", "source", "material", "construction", "condition", "kind", "strength_of")

_NUMBERS = (
    "diameter", "rated_break_strength", "tensile_strength", "linear_density", "wet_linear_density",
)  # fmt: skip


def _json_text(data: Any) -> str:
    """JSON that cannot end an element of a page, whatever its content."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _numbers(values: ArrayLike) -> Any:
    """Numbers for JSON with their nesting: null is NaN, the text inf is infinite.

    Examples
    --------
    >>> _numbers([1.5, float("nan"), float("inf")])
    [1.5, None, 'inf']
    """
    array = np.asarray(values)
    shown = array.astype(object)
    if array.dtype.kind == "f":
        for is_so, text in ((np.isnan, None), (np.isposinf, "inf"), (np.isneginf, "-inf")):
            shown[is_so(array)] = text
    return shown.tolist()


def _line_data(line: LineSource) -> dict[str, Any]:
    """All data of a line that a look-up needs.

    Examples
    --------
    >>> line = LineSource("a", "b", "nylon", "braid", "new", 0.0127, 28e3)
    >>> _line_data(line)["rated_break_strength"]
    28000.0
    """
    return (
        {name: getattr(line, name) for name in _TEXTS}
        | {name: _numbers(getattr(line, name)) for name in _NUMBERS}
        | {
            "factors": list(line.factor_names),
            "surfaces": {name: _surface(one) for name, one in line.surfaces.items()},
            "curves": [_curve(one) for one in line.curves],
            "levels": [_levels(one) for one in line.levels],
            "specimens": list(line.specimens),
            "absent": dict(line.absent),
            "notes": list(line.notes),
            "warnings": list(line.warnings),
            "conditions": dict(line.conditions),
            "rule": line.rule,
            # from which the page solves K_1 and tau for sinusoids
            "slow_pulls": {}
            if line.by_fundamental
            else {of: _curve(one) for of, one in line.slow_pulls.items()},
            "is_printed": line.is_printed,
            **_refits(line),
            "is_tether": line.is_tether,
            "quantities": list(line.quantities),
            "has_dashpot": line.has_dashpot,
        }
    )


def _refits(line: LineSource) -> dict[str, Any]:
    """Results independent of the levels: inconsistent columns, and z."""
    refits = refitted_surfaces(line)
    return {
        "column_warnings": {
            name: list(column_warnings(line, name, refits)) for name in SOLVED if refits
        },
        "greatest_z": {
            one.slow_pull: _numbers(one.greatest) for one in refits if one.quantity == SOLVED[0]
        },
    }


def _surface(surface: LineSurface) -> dict[str, Any]:
    return {
        "quantity": surface.quantity,
        "exponents": surface.exponents.tolist(),
        "discrepancy_exponents": surface.discrepancy_exponents.tolist(),
        "frequency_column": surface.frequency_column,
        **{
            name: _numbers(getattr(surface, name))
            for name in (
                "coefficient", "low", "high", "covariance_factor", "sigma", "degrees_of_freedom",
                "greatest_leverage", "exponent", "contribution", "alternatives", "rounding",
                "line_scatter", "n_lines", "discrepancy", "discrepancy_degrees_of_freedom",
            )
        },
        "alternative_boxes": [[_numbers(end) for end in box] for box in surface.alternative_boxes],
        "component": _components(surface.component),
        "errata": list(surface.errata),
        "notes": list(surface.notes),
    }  # fmt: skip


def _curve(curve: LineCurve) -> dict[str, Any]:
    return {
        "quantity": curve.quantity,
        "variable": curve.variable,
        "branch": curve.branch,
        "spread_of": curve.spread_of,
        "range_note": curve.range_note,
        "is_inverse_slope": curve.is_inverse_slope,
        **{
            name: _numbers(getattr(curve, name))
            for name in (
                "low", "high", "coefficient", "at", "value", "standard_uncertainty",
                "degrees_of_freedom", "contribution", "gaps", "loop_bend", "loop_bend_misfit",
            )
        },
        "component": _components(curve.component),
        "errata": list(curve.errata),
        "notes": list(curve.notes),
        "warnings": list(curve.warnings),
    }  # fmt: skip


def _levels(levels: LineLevels) -> dict[str, Any]:
    return {
        "quantity": levels.quantity,
        "variables": list(levels.variables),
        "tests": list(levels.tests),
        "at": _numbers(levels.at),
        "value": _numbers(levels.value),
        "conditions": [dict(one) for one in levels.conditions],
    }


def _components(component: tuple[Component, ...]) -> list[list[Any]]:
    """Identity and degrees of freedom of each shared error."""
    return [[one.source, one.of, one.number, _numbers(one.degrees_of_freedom)] for one in component]


_LINES: ReportId = "CG-D-39-80"

_TETHER = re.compile(r"WHOI-2005-10, Table (\d+)")


def _printed_at(line: LineSource) -> dict[str, str]:
    """Report, table and page of each quantity of a published line, in words.

    Examples
    --------
    >>> from reduction.lines.published_source import published_sources
    >>> line = published_sources()["nylon-double-braid-0.5in-new"]
    >>> _printed_at(line)["relaxation_time"]
    'CG-D-39-80, Table 17 (page 48), Table 18 (page 49)'
    """
    tether = _TETHER.match(line.source)
    if tether is not None:
        return dict.fromkeys(line.quantities, _words("WHOI-2005-10", (tether[1],)))
    found: dict[str, str] = {}
    for one in published_lines():
        if one.name != line.name:
            continue
        found = {name: _words(_LINES, part.tables) for name, part in one.surfaces.items()}
        for cubic in (one.load_strain, one.stiffness):
            if cubic is not None:
                name = "strain" if cubic.quantity == "quasi_static_strain" else cubic.quantity
                found[name] = _words(_LINES, cubic.tables)
    return {name: text for name, text in found.items() if name in line.quantities}


def _words(report: ReportId, tables: Iterable[str]) -> str:
    parts = [f"Table {table} ({_pages(report, table)})" for table in tables]
    return f"{report}, {', '.join(parts)}"


@cache
def _pages(report: ReportId, table: str) -> str:
    found = dict.fromkeys(cell.page for cell in cells_of(report) if cell.table == table)
    return f"page{'s' if len(found) > 1 else ''} {', '.join(found)}"


def _errata_notes(lines: Iterable[LineSource]) -> dict[str, list[str]]:
    """Place, printed and correct text, and evidence of every erratum of a line, by its id."""
    touching: set[str] = set()
    for line in lines:
        touching.update(*(one.errata for one in line.surfaces.values()))
        touching.update(*(one.errata for one in line.curves))
    return {
        one.id: [
            f"{one.report}, {one.place}",
            f"printed {one.printed}; corrected {one.corrected or 'nothing'}"
            + (f" ({one.confidence})" if one.confidence not in ("", one.corrected) else ""),
            one.evidence,
        ]
        for report in REPORTS
        for one in errata_of(report)
        if one.id in touching
    }


_SURFACES = "surfaces"

# exceptions from a damaged or hand-made file
_FAULTS = (ReductionError, OSError, RuntimeError, KeyError, IndexError, ValueError, TypeError)


@dataclass(frozen=True)
class _CampaignLines:
    """A campaign in the form stored on the page."""

    name: str
    files: dict[str, dict[str, Any]] = field(default_factory=dict)
    faults: dict[str, str] = field(default_factory=dict)
    left_out: int = 0

    @property
    def names(self) -> list[str]:
        """Names of the lines of all files, as in a look-up in the folder."""
        return unique_names(
            [(stem, line["name"]) for stem, one in self.files.items() for line in one["lines"]]
        )


def _state_of(processed: Path) -> str:
    """Digest of the archives and their times; it changes with any of them."""
    text = "\n".join(
        f"{path.parent.name}/{path.name} {_stamp(path)}"
        for folder in _folders(processed)
        for path in archives_of_lines(folder)
    )
    return sha256(text.encode("utf-8", "surrogateescape")).hexdigest()


def _read_campaigns(
    processed: Path,
    known: Mapping[str, Mapping[str, Any]] | None = None,
    *,
    room: int,
    opener: Opener = reading,
) -> list[_CampaignLines]:
    """Lines of every campaign below a folder, as far as they fit on a page."""
    found = [
        _Reading(folder, (known or {}).get(folder.name, {}), opener)
        for folder in _folders(processed)
    ]
    newest = sorted(found, key=lambda one: -one.changed)
    for is_surfaces in (True, False):
        for one in newest:
            for path in one.paths:
                if (path.stem == _SURFACES) != is_surfaces:
                    continue
                # archives after the first that does not fit are not read, not even for their size
                room -= one.read(path) if room > 0 else one.leave(path)
                if room < 0:
                    one.leave(path)
    return [one.campaign for one in found]


class _Reading:
    """A campaign whose archives are being read."""

    def __init__(self, folder: Path, known: Mapping[str, Any], opener: Opener) -> None:
        self.paths = archives_of_lines(folder)
        self._stamps = {path: _stamp(path) for path in self.paths}
        self.changed = max(int(stamp.split()[0]) for stamp in self._stamps.values())
        self._digests: dict[Path, str] = {}
        self._name, self._known, self._opener = folder.name, known, opener
        self._files: dict[Path, dict[str, Any]] = {}
        self._faults: dict[str, str] = {}
        self._left: set[Path] = set()

    def read(self, path: Path) -> int:
        """Read an archive, or take it from the known ones; return its size on the page. [bytes]."""
        # surfaces include properties of their specimens from the tests beside them
        rests_on = self.paths if path.stem == _SURFACES else (path,)
        state = sha256(" ".join(map(self._digest, rests_on)).encode()).hexdigest()
        before = self._known.get(path.stem)
        if before is not None and before["state"] == state:
            self._files[path] = dict(before)
        else:
            try:
                self._files[path] = {"state": state, "lines": _lines(path, rests_on, self._opener)}
            except _FAULTS as error:
                text = str(error) if isinstance(error, ReductionError) else repr(error)
                self._faults[path.name] = text.replace(str(path), path.name)
                return 0
        return len(_json_text(self._files[path]))

    def _digest(self, path: Path) -> str:
        """Digest of all bytes: times and file numbers would make the page depend on its place."""
        if path not in self._digests:
            self._digests[path] = ""
            if not path.is_file():  # reading a pipe would block
                return ""
            try:
                with path.open("rb") as file:
                    self._digests[path] = file_digest(file, "sha256").hexdigest()
            except OSError:
                pass  # the archive is then read, which reports the reason
        return self._digests[path]

    def leave(self, path: Path) -> int:
        """Leave an archive out; it takes no space."""
        self._files.pop(path, None)
        self._left.add(path)
        return 0

    @property
    def campaign(self) -> _CampaignLines:
        """The lines read, in the order of the folder."""
        files = {path.stem: self._files[path] for path in self.paths if path in self._files}
        lines = [line for one in files.values() for line in one["lines"]]
        for line in lines:
            if line["surfaces"]:
                # properties of its runs, as in a look-up in the folder
                line["conditions"] = joined_conditions(
                    one["conditions"]
                    for one in lines
                    if one["levels"] and set(one["specimens"]) & set(line["specimens"])
                )
        return _CampaignLines(self._name, files, self._faults, len(self._left))


def _folders(processed: Path) -> list[Path]:
    try:
        # an unreadable folder is not an empty one, as it is for `Path.glob`
        found = sorted(processed.iterdir())
    except FileNotFoundError:
        return []
    return [one for one in found if (one / STATUS_NAME).is_file() and archives_of_lines(one)]


def _stamp(path: Path) -> str:
    """Time, size and number of a file; zeros where it was removed meanwhile."""
    try:
        found = path.stat()
    except OSError:
        return "0 0 0"
    return f"{found.st_mtime_ns} {found.st_size} {found.st_ino}"


def _lines(path: Path, rests_on: Sequence[Path], opener: Opener) -> list[dict[str, Any]]:
    with opener(path) as archive:
        lines = lines_of_open_archive(archive, path, opener)
    if path.stem == _SURFACES:
        tests: list[LineSource] = []
        for other in rests_on:
            if other == path:
                continue
            # an archive that cannot be read is named at its own place
            with suppress(*_FAULTS), opener(other) as archive:
                tests += lines_of_open_archive(archive, other, opener)
        lines = [with_runs(line, tests) if line.surfaces else line for line in lines]
    return [_line_data(line) for line in lines]


MOST_BYTES = 2_500_000
"""Size limit for the lines of campaigns on one page; the rest is given as a count of archives."""

_REPORT = "index.html"

_FORMAT = 6
"""Format version of the data that one page keeps for the next."""

_TIMES = 3

_SHARES = np.append(1e-12, np.arange(1, 33) / 32)
"""Inverse degrees of freedom with tabulated interval factors on the page; the first is zero."""

_SCRIPTS = (
    "format.js", "student.js", "surface.js", "curve.js", "loads.js", "lookup.js", "consistent.js",
    "shown.js", "data.js", "chart.js", "form.js", "command.js", "answer.js", "page.js",
)  # fmt: skip

_DATA = re.compile(r'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)

_OF_LINES = (
    "apparent_spring_constant", "hysteresis_energy", "quasi_static_spring_constant",
    "dissipation_spring_constant", "relaxation_time", "dashpot_coefficient", "tangent_modulus",
    "branch_tension", "strain",
)  # fmt: skip

_SYMBOLS = ("K_ap", "H", "K_0", "K_1", "tau", "N")

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
    """Write or rewrite the page of a folder of products."""
    path = reports / DESIGN_PAGE_NAME
    known = _files_on(path)
    for _ in range(_TIMES):
        state = _state_of(processed)
        campaigns = _read_campaigns(processed, known, room=MOST_BYTES, opener=opener)
        if unreadable is not None:
            for one in campaigns:
                for name, why in one.faults.items():
                    unreadable(processed / one.name / name, why)
        write_text_atomically(
            path, _render_design_page(campaigns, _reports_beside(reports, campaigns))
        )
        if _state_of(processed) == state:
            break
        # another run ended meanwhile, and its page may just have been replaced
        known = {one.name: one.files for one in campaigns}
    return path


def _render_design_page(
    campaigns: Sequence[_CampaignLines] = (), reports: Mapping[str, str] | None = None
) -> str:
    """Return the page as HTML that opens from disk."""
    room = files("reduction.pages")
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    page = environment.from_string((room / "templates" / DESIGN_PAGE_NAME).read_text("utf-8"))
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
        style=(room / "design_values_static" / "page.css").read_text("utf-8"),
        script="\n".join(
            (room / "design_values_static" / name).read_text("utf-8") for name in _SCRIPTS
        ),
        data=_json_text(data),
        other_codes=[name for name in FORMS if name != "moordyn"],
    )


def _reports_beside(reports: Path, campaigns: Sequence[_CampaignLines]) -> dict[str, str]:
    """Address of each existing campaign report, as used in a link."""
    return {
        one.name: f"{quote(one.name)}/{_REPORT}"
        for one in campaigns
        if (reports / one.name / _REPORT).is_file()
    }


def _constants() -> dict[str, Any]:
    """Data that do not depend on any campaign."""
    lines = tuple(published_sources().values())
    published = [_line_data(line) | {"printed": _printed_at(line)} for line in lines]
    known = {name: quantity(name) for name in (*_OF_LINES, *LEVEL_DIMENSIONS)}
    units = {one.unit for one in known.values()}
    return {
        "version": __version__,
        "published": published,
        "errata": _errata_notes(lines),
        "quantities": {name: [one.unit, one.long_name] for name, one in known.items()},
        "symbols": dict(zip(_OF_LINES, _SYMBOLS, strict=False)),
        "shown": {
            unit: {
                system: list(display_unit(unit, cast("UnitSystem", system)))
                for system in get_args(UnitSystem)
            }
            for unit in sorted(units)
        },
        "levels": LEVEL_DIMENSIONS,
        "given": {
            dimension: [[unit, scale_to_si(unit, dimension)[0]] for unit in given]
            for dimension, given in _GIVEN.items()
        },
        "above_leverage": ABOVE_LEVERAGE,
        "reasons": [REASONS[reason] for reason in sorted(REASONS)],
        "coverage_factors": coverage_factor(1 / _SHARES).tolist(),
    }


def _files_on(path: Path) -> dict[str, dict[str, Any]]:
    """Campaign data kept by the existing page; none if it is from another version."""
    try:
        found = _DATA.search(path.read_text(encoding="utf-8"))
        data = json.loads(found[1]) if found is not None else {}
        if (data["format"], data["version"]) != (_FORMAT, __version__):
            return {}
        return {one["name"]: one["files"] for one in data["campaigns"]}
    except (OSError, ValueError, KeyError, TypeError):
        # no page, or one from elsewhere: everything is read
        return {}

"""One campaign in the explorer: its logs, its text, a change of its settings.

All results come from the functions of `reduction run`: a valid text of campaign.toml is loaded, the
log is surveyed with it, and the test is reduced to the dataset from which its archive would be
written.  The only file written is campaign.toml, and only on request.
"""

from __future__ import annotations

import codecs
import difflib
import errno
import hashlib
import os
import shutil
import stat
import time
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Literal, get_args

import tomlkit
import xarray as xr
from tomlkit.container import Container
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import AoT, InlineTable, Item, Table

from reduction.archive.atomic_write import atomic_file
from reduction.batch.campaign_status import Progress, Silent
from reduction.batch.reduce_tests import dataset_of
from reduction.batch.requested_products import (
    ReductionInputs,
    find_reduction_inputs,
    reduction_inputs,
)
from reduction.batch.reuse import Basis, reusable_product
from reduction.batch.survey import FirstPass, Survey, as_reduction_error, survey_log
from reduction.campaign.load import load_campaign, read_test_table
from reduction.campaign.model import dimension_of
from reduction.campaign.plan import Campaign
from reduction.pipeline.located_test import CYCLIC
from reduction.record.errors import ArchiveError, SettingsError
from reduction.record.settings import StrainMethod

Group = Literal[
    "Trim and cycles",
    "Modulus windows",
    "Splice correction",
    "Phases",
    "Holds",
    "Rope",
    "Slips",
    "Flags",
]
"""Headings, in the order of the page."""


@dataclass(frozen=True)
class _Slider:
    """Ends and step of a slider, in the displayed unit."""

    low: float
    high: float
    step: float
    unit: str = ""


@dataclass(frozen=True)
class Setting:
    """One key of ``[tests.ID]``.

    ``key`` is ``GROUP.NAME`` below ``reduction``, or a key of the test itself; ``choices`` are
    the allowed words. It is offered for the ``kinds`` of test; for all where empty.
    """

    key: str
    group: Group
    words: str
    choices: tuple[str, ...] = ()
    slider: _Slider | None = None
    kinds: tuple[str, ...] = ()

    @property
    def path(self) -> tuple[str, ...]:
        """Keys below ``[tests.ID]``."""
        parts = tuple(self.key.split("."))
        return parts if self.key in _OF_TEST else ("reduction", *parts)


_OF_TEST = ("control", "waveform", "strain.method")

_SHARE = _Slider(0.5, 1.0, 0.005)

SETTINGS: tuple[Setting, ...] = (
    Setting(
        "cycles.trim_threshold", "Trim and cycles",
        "share of the plateau rate above which a sample is kept: higher trims more of both ends",
        slider=_SHARE, kinds=CYCLIC,
    ),
    Setting(
        "cycles.break_in_cycles", "Trim and cycles", "first cycles not used in any mean",
        slider=_Slider(0, 20, 1), kinds=CYCLIC,
    ),
    Setting(
        "cycles.band", "Trim and cycles", "smallest range that counts as a reversal", kinds=CYCLIC
    ),
    Setting(
        "waveform", "Trim and cycles", "how ends are trimmed and the loop area is computed",
        choices=("triangular", "sinusoidal", "other"), kinds=CYCLIC,
    ),
    Setting(
        "control", "Trim and cycles", "channel on which reversals are found",
        choices=("position", "load"),
    ),
    Setting(
        "modulus.strain_bin_width", "Modulus windows", "spacing of the strain grid",
        slider=_Slider(0.25, 10.0, 0.25, "%"),
    ),
    Setting(
        "modulus.window", "Modulus windows", "width of the regression window",
        slider=_Slider(0.5, 30.0, 0.5, "%"),
    ),
    Setting(
        "modulus.minimum_count", "Modulus windows", "fewest samples in a window for a slope"
    ),
    Setting(
        "modulus.maximum_segments", "Modulus windows", "most straight segments tried",
        slider=_Slider(1, 8, 1), kinds=CYCLIC,
    ),
    Setting(
        "modulus.segment_tolerance", "Modulus windows",
        "distance of the segments from the branch, as a share of its tension range",
        kinds=CYCLIC,
    ),
    Setting(
        "modulus.selected_cycles", "Modulus windows",
        "longest test of which every cycle's curve is kept", kinds=CYCLIC,
    ),
    Setting(
        "modulus.stress_at_strain", "Modulus windows", "elongations at which stress is given"
    ),
    Setting(
        "strain.method", "Splice correction", "how position becomes strain of the free length",
        choices=get_args(StrainMethod),
    ),
    Setting("phases.minimum_duration", "Phases", "shortest standstill"),
    Setting("phases.position_tolerance", "Phases", "range of position inside a standstill"),
    Setting("phases.tension_tolerance", "Phases", "range of tension inside a hold at one tension"),
    Setting("phases.slack_tension", "Phases", "tension at or below which a standstill is a rest"),
    Setting("holds.minimum_duration", "Holds", "shortest hold for relaxation results"),
    Setting(
        "holds.maximum_terms", "Holds", "most Prony terms tried", slider=_Slider(1, 5, 1)
    ),
    Setting("holds.times", "Holds", "times after the ramp at which tension is given"),
    Setting("rope.last_cycles", "Rope", "last cycles that give the dynamic stiffness"),
    Setting("rope.reference_time", "Rope", "time after loading of the static stiffness"),
    Setting("rope.failure_share", "Rope", "share of the median peak below which it has failed"),
    Setting("slip.minimum_cycles", "Slips", "shortest test that is searched for slips",
            kinds=CYCLIC),
    Setting("slip.false_alarm", "Slips", "chance that a sound specimen shows a slip",
            kinds=CYCLIC),
    Setting("quality.stuck_samples", "Flags", "number of equal values that count as stuck"),
    Setting("quality.spike_factor", "Flags", "deviation from both neighbours that is a spike"),
    Setting("quality.gap_factor", "Flags", "number of median time steps that count as a gap"),
    Setting("quality.rate_tolerance", "Flags", "share by which a time step may vary"),
)  # fmt: skip

_BY_KEY = {one.key: one for one in SETTINGS}


def settings_of_kind(kind: str) -> list[Setting]:
    """Settings that affect a kind of test; there are none for weights hung by hand."""
    if kind == "stepwise":
        return []
    return [one for one in SETTINGS if not one.kinds or kind in one.kinds]


Keys = tuple[str | int, ...]

Value = bool | int | float | str | list[Any] | dict[str, Any]

_NAMED = 2
"""Keys of a header that is added where a table does not exist, as in ``[tests.T-1]``."""


def _edited(text: str, changes: Mapping[Keys, Value | None]) -> str:
    r"""Return a TOML text with some keys set, or removed where the value is None.

    Examples
    --------
    >>> print(_edited('[tests.T-1]\nfile = "a.csv"  # raw\n', {("tests", "T-1", "order"): 2}))
    [tests.T-1]
    file = "a.csv"  # raw
    order = 2
    """
    for path, value in changes.items():
        before = tomllib.loads(text)
        now = _value_at(before, path)
        if now == value and type(now) is type(value):
            continue
        try:
            made = _with(text, path, value)
            after = tomllib.loads(made)
            is_meant = _value_at(after, path) == value
            is_meant &= dict(_leaves(before, path)) == dict(_leaves(after, path))
        except (TOMLKitError, ValueError, KeyError, TypeError, AttributeError):
            is_meant = False
        if not is_meant:
            raise SettingsError(
                "campaign.toml is written in a way that cannot be edited here",
                needed=f"the line removed by hand: {_dotted(path)}"
                if value is None
                else f"the line written by hand: {_line(path, value)}",
            )
        text = made
    return text


def _value_at(document: object, path: Keys) -> Any:
    """Value at a path of a document; None where there is none."""
    for key in path:
        if isinstance(document, dict) and isinstance(key, str):
            document = document.get(key)
        elif isinstance(document, list) and isinstance(key, int) and key < len(document):
            document = document[key]
        else:
            return None
    return document


def _leaves(document: Any, left_out: Keys, at: Keys = ()) -> Iterator[tuple[Keys, Any]]:
    """Every value by its path, except one; empty tables are skipped."""
    if at == left_out:
        return
    if isinstance(document, dict | list):
        pairs = document.items() if isinstance(document, dict) else enumerate(document)
        for key, value in pairs:
            yield from _leaves(value, left_out, (*at, key))
    else:
        yield at, document


def _with(text: str, path: Keys, value: Value | None) -> str:
    """The text with one key set or removed."""
    document = tomlkit.parse(text)
    end_of_line = "\r\n" if "\r\n" in text else "\n"
    holder: Any = document
    home, keys = holder, path
    depth, last = 0, len(path) - 1
    while depth < last and (isinstance(path[depth], int) or path[depth] in holder):
        holder = holder[path[depth]]
        depth += 1
        if isinstance(holder, Table) and not holder.is_super_table():
            home, keys = holder, path[depth:]
    key = path[depth]
    if isinstance(holder, InlineTable):
        # a table on one line is rewritten as a whole
        whole: dict[str, Any] = holder.unwrap()
        for name in reversed(path[depth + 1 :]):
            value = {str(name): value}
        whole[str(key)] = value
        return _with(text, path[:depth], {k: v for k, v in whole.items() if v is not None} or None)
    if value is None:
        del holder[key]
    elif depth == last and (isinstance(key, int) or key in holder):
        holder[key] = _item(value)
    elif depth < min(_NAMED, last):
        gap = "" if not text else end_of_line if text.endswith("\n") else 2 * end_of_line
        lines = f"[{_dotted(path[:_NAMED])}]", _line(path[_NAMED:], value), ""
        return f"{text}{gap}{end_of_line.join(lines)}"
    else:
        # below the last key of its table, and above the comment of the next table
        before = _last_line(home)
        before.trail = before.trail or end_of_line
        before.trail += f"{before.indent}{_line(keys, value)}{end_of_line}"
    return tomlkit.dumps(document)


def _last_line(table: Any) -> Any:
    """Text around the last key of a table, or around its header where it has no key."""
    body = table.body if isinstance(table, Container) else table.value.body
    for key, item in reversed(body):
        if key is not None and (key.is_dotted() or not isinstance(item, Table | AoT)):
            return _last_line(item) if isinstance(item, Table) else item.trivia
    return table.trivia


def _dotted(keys: Keys) -> str:
    return tomlkit.key([str(key) for key in keys]).as_string()


def _line(keys: Keys, value: Value) -> str:
    return f"{_dotted(keys)} = {_item(value).as_string()}"


def _item(value: Value) -> Item:
    """A value as written on one line."""
    if isinstance(value, dict) and value:
        inside = ", ".join(_line((key,), one) for key, one in value.items())
        return tomlkit.value(f"{{ {inside} }}")
    return tomlkit.inline_table() if value == {} else tomlkit.item(value)


Place = Literal["test", "defaults", "table", "nowhere"]

_WRITABLE = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH

_LONGEST_NAME = 1000

_STEP_ENDS = ("from", "to")


@dataclass(frozen=True)
class Written:
    """Text of a setting in campaign.toml, and its place; empty where it is not set."""

    place: Place
    text: str = ""


@dataclass(frozen=True)
class CampaignText:
    """A campaign.toml as read; a byte-order mark before its text is kept."""

    path: Path
    text: str
    mark: bytes = b""

    @classmethod
    def read(cls, path: Path) -> CampaignText:
        """Read the file; `SettingsError` where that is not possible."""
        try:
            whole = path.read_bytes()
            mark = codecs.BOM_UTF8 if whole.startswith(codecs.BOM_UTF8) else b""
            return cls(path, whole.removeprefix(mark).decode("utf-8"), mark)
        except (OSError, UnicodeDecodeError) as error:
            raise SettingsError(
                f"{path}: the campaign cannot be read",
                found=getattr(error, "strerror", None) or str(error),
                needed="a campaign.toml",
            ) from error

    @cached_property
    def document(self) -> dict[str, Any]:
        """The parsed TOML."""
        return tomllib.loads(self.text)

    def as_bytes(self) -> bytes:
        """Return the content of the file."""
        return self.mark + self.text.encode("utf-8")

    @cached_property
    def digest(self) -> str:
        """SHA-256 of the file."""
        return hashlib.sha256(self.as_bytes()).hexdigest()

    @cached_property
    def in_table(self) -> dict[str, set[str]]:
        """Keys of each test in the table of tests, where there is one."""
        tests = self.document.get("tests")
        name = tests if isinstance(tests, str) else _value_at(self.document, ("campaign", "tests"))
        if not name:
            return {}
        rows = read_test_table(self.path.parent / str(name))
        return {test: set(row.model_fields_set) for test, row in rows.items()}

    @cached_property
    def named(self) -> tuple[Path, ...]:
        """Path of every file of the campaign folder that the text names."""
        return tuple(self.path.parent / one for one in dict.fromkeys(_texts(self.document)))

    def written(self, test: str, setting: Setting) -> Written:
        """Text of a setting of a test, and its place."""
        if setting.path[0] in self.in_table.get(test, ()):
            return Written("table")
        own = ("tests", test, *setting.path)
        if setting.key == "strain.method":
            # the table of a test replaces the defaults as a whole
            is_own = _value_at(self.document, own[:-1]) is not None
        else:
            is_own = _value_at(self.document, own) is not None
        places: tuple[tuple[Place, Keys], ...] = (
            (("test", own),) if is_own else (("defaults", ("defaults", *setting.path)),)
        )
        for place, keys in places:
            value = _value_at(self.document, keys)
            if value is not None:
                return Written(place, _as_text(value))
        return Written("test" if is_own else "nowhere")

    def step_ends(self, test: str, place: int) -> dict[str, str]:
        """``from`` and ``to`` of a step of a log, by their keys on the page."""
        return {
            f"steps.{place}.{end}": _as_text(
                _value_at(self.document, ("tests", test, "steps", place, end)) or ""
            )
            for end in _STEP_ENDS
        }

    def changed(self, test: str, changes: Mapping[str, str], *, control: str) -> CampaignText:
        """Return the text of the file with changed settings of one test."""
        paths: dict[Keys, Value | None] = {}
        for key, text in changes.items():
            paths |= self._change(test, key, text.strip(), control)
        if not paths:
            return self
        table = self.document.get("tests")
        if isinstance(table, str):
            # besides [tests.ID], the table of tests is named in [campaign]
            paths = {("tests",): None, ("campaign", "tests"): table, **paths}
        return replace(self, text=_edited(self.text, paths))

    def _change(self, test: str, key: str, text: str, control: str) -> dict[Keys, Value | None]:
        group, _, rest = key.partition(".")
        place, _, end = rest.partition(".")
        if group == "steps" and place.isdecimal() and end in _STEP_ENDS:
            if not text:
                raise SettingsError(f"{key}: a step has both ends", needed='such as "1200 s"')
            return {
                ("tests", test, "steps", int(place), end): int(text) if text.isdecimal() else text
            }
        setting = _BY_KEY.get(key)
        if setting is None:
            raise SettingsError("this setting cannot be changed here", found=repr(key))
        if setting.path[0] in self.in_table.get(test, ()):
            raise SettingsError(
                f"{key} of test '{test}' is set in the table of tests", needed="a change there"
            )
        path = ("tests", test, *setting.path)
        if setting.key == "strain.method":
            return self._strain_change(test, text)
        return {path: _as_value(setting, text, control) if text else None}

    def _strain_change(self, test: str, method: str) -> dict[Keys, Value | None]:
        """A test with its own strain method has to name the marks again."""
        own = _value_at(self.document, ("tests", test, "strain"))
        default = _value_at(self.document, ("defaults", "strain")) or {}
        rest = {key: value for key, value in (own or default).items() if key != "method"}
        wanted = {"method": method, **rest} if method else rest
        table = ("tests", test, "strain")
        if own is None:
            return {} if wanted == default else {table: wanted}
        if wanted:
            return {(*table, "method"): method or None}
        # an empty table prevents the default method
        return {table: {} if default.get("method") else None}

    def difference(self, other: CampaignText) -> str:
        """Difference to another text, as a unified diff."""
        name = self.path.name
        lines = difflib.unified_diff(
            self.text.splitlines(), other.text.splitlines(), name, f"{name} (changed)", lineterm=""
        )
        return "\n".join(lines)

    def replace_with(self, other: CampaignText) -> None:
        """Replace the file by another text, completely or not at all."""
        # a link is followed: its target is replaced, and the link is kept
        target = self.path.resolve()
        if CampaignText.read(target).digest != self.digest:
            raise SettingsError(
                f"{self.path} changed on the disk since it was read",
                needed="the diff looked at again",
                hint="Nothing was written. Load the file again.",
            )
        try:
            if not target.stat().st_mode & _WRITABLE:
                # renaming over a file needs no permission for the file itself
                raise PermissionError(errno.EACCES, "it is read-only")
            with atomic_file(target) as part:
                part.write_bytes(other.as_bytes())
                shutil.copymode(target, part)
        except ArchiveError:
            raise
        except OSError as error:
            raise ArchiveError(
                f"{self.path} cannot be written",
                found=error.strerror or str(error),
                hint="It is what it was before.",
            ) from error


def _texts(value: object) -> Iterator[str]:
    """Every text of a document that is short enough to be a file name."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for one in value:
            yield from _texts(one)
    elif isinstance(value, str) and len(value) < _LONGEST_NAME:
        yield value


def _as_text(value: object) -> str:
    """A value as a person enters it in a field; entries of a list separated by commas."""
    if isinstance(value, list):
        return ", ".join(map(_as_text, value))
    return str(value)


def _as_value(setting: Setting, text: str, control: str) -> Value:
    """Text of a field in the form of campaign.toml, where its meaning is checked."""
    if setting.choices:
        return text
    group, _, name = setting.key.partition(".")
    if setting.key in ("holds.times", "modulus.stress_at_strain"):
        return [_number(one.strip()) for one in text.split(",") if one.strip()]
    if dimension_of(group, name, control=control) is None:
        number = _number(text)
        if isinstance(number, str):
            raise SettingsError(
                f"{setting.key} is not a number", found=repr(text), needed="a number"
            )
        return number
    return _number(text)


def _number(text: str) -> Value:
    """A number where the text is one, else the text, for example a value with its unit."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


COMMAND = "reduction run campaign.toml"


@dataclass(frozen=True)
class _Made:
    """Results of a text for one test."""

    survey: Survey
    dataset: xr.Dataset | None
    error: str
    seconds: float
    is_standing: bool
    also: tuple[str, ...]


class Session:
    """A campaign in the explorer; to be used by one thread at a time.

    Parameters
    ----------
    path : pathlib.Path
        The campaign.toml.
    processed : pathlib.Path
        Folder of its archives.
    progress : Progress, optional
        Called for each log of the first pass.

    Raises
    ------
    ReductionError
        If the campaign cannot be loaded.
    """

    def __init__(self, path: Path, processed: Path, *, progress: Progress | None = None) -> None:
        self.path = path
        self._processed = processed
        self.read_again(progress)

    def read_again(self, progress: Progress | None = None) -> None:
        """Read campaign.toml and its logs as they are now."""
        text = CampaignText.read(self.path)
        campaign = load_campaign(self.path, text=text.text)
        inputs = _inputs(text, campaign)
        stamps = tuple(map(_stamp, inputs))
        now = find_reduction_inputs(campaign, progress=progress or Silent())
        # replace all of it, or keep the previous state
        self.text, self.campaign, self.surveys = text, campaign, now.first.surveys
        self._inputs, self._stamps, self._settings = inputs, stamps, _settings(now)

    @property
    def is_changed_on_disk(self) -> bool:
        """Whether campaign.toml, or a file that it names, differs from the one that was read."""
        is_same = CampaignText.read(self.path).digest == self.text.digest
        return not is_same or tuple(map(_stamp, self._inputs)) != self._stamps

    def survey(self, test: str) -> Survey:
        """The first pass over a test; `SettingsError` where the campaign lacks it."""
        for one in self.surveys:
            if one.plan.id == test:
                return one
        raise SettingsError("the campaign has no such test", found=repr(test))

    def changed(self, test: str, changes: Mapping[str, str]) -> CampaignText:
        """Text of campaign.toml after a change; `SettingsError` where it cannot be written."""
        plan = self.survey(test).plan
        control = changes.get("control") or plan.control
        return self.text.changed(plan.log, changes, control=control)

    def made(self, test: str, text: CampaignText) -> _Made:
        """Reduce a test with the settings of a text."""
        begun = time.perf_counter()
        if self.is_changed_on_disk:
            raise SettingsError(
                "campaign.toml, or a file that it names, changed on the disk since it was read",
                needed="it read again",
            )
        campaign, now = self._surveyed(text, self.survey(test).plan.log)
        survey = next(one for one in now.first.surveys if one.plan.id == test)
        error = survey.error or now.errors.get(test)
        dataset, is_standing = None, False
        if error is None:
            try:
                basis = now.basis(survey)
                # the result of a changed text has no archive yet
                is_same = text.digest == self.text.digest
                is_standing = is_same and self._is_standing(survey, basis)
                dataset, _ = dataset_of(campaign, survey, basis, command=COMMAND)
            except Exception as failure:
                # one of many texts that are tried, even where the failure is a defect here
                error = as_reduction_error(failure)
        settings = _settings(now)
        others = (one.plan.id for one in now.first.surveys if one.plan.id != test)
        also = tuple(one for one in others if settings.get(one) != self._settings.get(one))
        said = "" if error is None else campaign.in_words(str(error))
        seconds = time.perf_counter() - begun
        return _Made(replace(survey, located=None), dataset, said, seconds, is_standing, also)

    def _surveyed(self, text: CampaignText, log: str) -> tuple[Campaign, ReductionInputs]:
        """The campaign of a text, with one of its logs read again."""
        campaign = load_campaign(self.path, text=text.text)
        if list(campaign.tests) != list(self.campaign.tests):
            raise SettingsError("the tests of the campaign changed", needed="the same tests")
        own = survey_log(campaign, log)
        place = [one.plan.log for one in self.surveys].index(log)
        surveys = [one for one in self.surveys if one.plan.log != log]
        surveys[place:place] = own
        first = FirstPass(surveys, {log: own})
        return campaign, reduction_inputs(campaign, first, progress=Silent())

    def _is_standing(self, survey: Survey, basis: Basis) -> bool:
        path = self._processed / f"{survey.plan.id}.nc"
        found = reusable_product(path, survey, basis.settings, remarks=basis.remarks)
        return found is not None

    def save(self, text: CampaignText) -> None:
        """Replace campaign.toml by a text, and continue from it."""
        load_campaign(self.path, text=text.text)
        self.text.replace_with(text)
        self.read_again()


def _settings(now: ReductionInputs) -> dict[str, str]:
    """Every setting in force, by test; tests that failed have none."""
    sound = (one for one in now.first.surveys if one.plan.id not in now.failed)
    return {one.plan.id: now.basis(one).settings for one in sound}


def _inputs(text: CampaignText, campaign: Campaign) -> tuple[Path, ...]:
    """Every file that a campaign may read: those that its text and its tests name."""
    own = {campaign.folder / name for plan in campaign.tests.values() for name, _ in plan.files}
    return tuple(sorted({*text.named, *own, *campaign.copies.values()}))


def _stamp(path: Path) -> tuple[int, ...]:
    """Values that change with a file; for a missing file the reader reports the error."""
    try:
        found = os.stat(path)
    except (OSError, ValueError):  # the latter for a name that no file can have
        return ()
    return found.st_size, found.st_mtime_ns, found.st_ino

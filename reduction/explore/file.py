"""campaign.toml as text: what it says of a test, what it would say, and how that is saved."""

from __future__ import annotations

import codecs
import difflib
import errno
import hashlib
import shutil
import stat
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

from reduction.archive.whole import whole_file
from reduction.campaign.numbers import dimension_of
from reduction.campaign.testtable import read_test_table
from reduction.errors import ArchiveError, SettingsError
from reduction.explore.edit import Path as Keys
from reduction.explore.edit import Value, edited, value_at
from reduction.explore.keys import Setting, setting_of

Place = Literal["test", "defaults", "table", "nowhere"]
_WRITABLE = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH
_LONGEST_NAME = 1000
_STEP_ENDS = ("from", "to")


@dataclass(frozen=True)
class Written:
    """What campaign.toml says of a setting, and where; nothing where it is silent."""

    place: Place
    text: str = ""


@dataclass(frozen=True)
class CampaignText:
    """A campaign.toml as it stood when it was read; a byte-order mark before its text is kept."""

    path: Path
    text: str
    mark: bytes = b""

    @classmethod
    def read(cls, path: Path) -> CampaignText:
        """Read it; `SettingsError` where that is not possible."""
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
        """As TOML gives it."""
        return tomllib.loads(self.text)

    def as_bytes(self) -> bytes:
        """Return what the file holds."""
        return self.mark + self.text.encode("utf-8")

    @cached_property
    def digest(self) -> str:
        """SHA-256 of the file."""
        return hashlib.sha256(self.as_bytes()).hexdigest()

    @cached_property
    def in_table(self) -> dict[str, set[str]]:
        """Keys of each test that stand in the table of tests, where there is one."""
        tests = self.document.get("tests")
        name = tests if isinstance(tests, str) else value_at(self.document, ("campaign", "tests"))
        if not name:
            return {}
        rows = read_test_table(self.path.parent / str(name))
        return {test: set(row.model_fields_set) for test, row in rows.items()}

    @cached_property
    def named(self) -> tuple[Path, ...]:
        """Where every file of the campaign folder would be that the text names, marks among them.

        Any text of it may be a name; one that is none leads to no file.
        """
        return tuple(self.path.parent / one for one in dict.fromkeys(_texts(self.document)))

    def written(self, test: str, setting: Setting) -> Written:
        """What stands of a setting of a test."""
        if setting.path[0] in self.in_table.get(test, ()):
            return Written("table")
        own = ("tests", test, *setting.path)
        if setting.key == "strain.method":
            # a table of a test is taken whole: what it leaves out is not in the defaults
            is_own = value_at(self.document, own[:-1]) is not None
        else:
            is_own = value_at(self.document, own) is not None
        places: tuple[tuple[Place, Keys], ...] = (
            (("test", own),) if is_own else (("defaults", ("defaults", *setting.path)),)
        )
        for place, keys in places:
            value = value_at(self.document, keys)
            if value is not None:
                return Written(place, _as_text(value))
        return Written("test" if is_own else "nowhere")

    def step_ends(self, test: str, place: int) -> dict[str, str]:
        """``from`` and ``to`` of a step of a log, by their keys on the page."""
        return {
            f"steps.{place}.{end}": _as_text(
                value_at(self.document, ("tests", test, "steps", place, end)) or ""
            )
            for end in _STEP_ENDS
        }

    def changed(self, test: str, changes: Mapping[str, str], *, control: str) -> CampaignText:
        """Return what the file would say with settings of one test changed.

        Parameters
        ----------
        test : str
            Key of the test in campaign.toml.
        changes : mapping of str to str
            Texts by key, as a person writes them; empty where the key is to be left out.
        control : str
            Channel of the test, which says what a band is.

        Returns
        -------
        text : CampaignText
            The same where nothing changes.

        Raises
        ------
        SettingsError
            If a key is not one that may be moved, or stands in the table of tests.
        """
        paths: dict[Keys, Value | None] = {}
        for key, text in changes.items():
            paths |= self._change(test, key, text.strip(), control)
        if not paths:
            return self
        table = self.document.get("tests")
        if isinstance(table, str):
            # beside [tests.ID] the table of tests is named in [campaign]
            paths = {("tests",): None, ("campaign", "tests"): table, **paths}
        return replace(self, text=edited(self.text, paths))

    def _change(self, test: str, key: str, text: str, control: str) -> dict[Keys, Value | None]:
        group, _, rest = key.partition(".")
        place, _, end = rest.partition(".")
        if group == "steps" and place.isdecimal() and end in _STEP_ENDS:
            if not text:
                raise SettingsError(f"{key}: a step has both ends", needed='such as "1200 s"')
            return {
                ("tests", test, "steps", int(place), end): int(text) if text.isdecimal() else text
            }
        setting = setting_of(key)
        if setting is None:
            raise SettingsError("a setting is not one that is moved here", found=repr(key))
        if setting.path[0] in self.in_table.get(test, ()):
            raise SettingsError(
                f"{key} of test '{test}' stands in the table of tests", needed="a change there"
            )
        path = ("tests", test, *setting.path)
        if setting.key == "strain.method":
            return self._strain_change(test, text)
        return {path: _as_value(setting, text, control) if text else None}

    def _strain_change(self, test: str, method: str) -> dict[Keys, Value | None]:
        """A test that has a strain method of its own names the marks again."""
        own = value_at(self.document, ("tests", test, "strain"))
        default = value_at(self.document, ("defaults", "strain")) or {}
        rest = {key: value for key, value in (own or default).items() if key != "method"}
        wanted = {"method": method, **rest} if method else rest
        table = ("tests", test, "strain")
        if own is None:
            return {} if wanted == default else {table: wanted}
        if wanted:
            return {(*table, "method"): method or None}
        # an empty table of its own keeps the method of the defaults away
        return {table: {} if default.get("method") else None}

    def difference(self, other: CampaignText) -> str:
        """What another text would change, as a unified diff."""
        name = self.path.name
        lines = difflib.unified_diff(
            self.text.splitlines(), other.text.splitlines(), name, f"{name} (changed)", lineterm=""
        )
        return "\n".join(lines)

    def replace_with(self, other: CampaignText) -> None:
        """Put another text in the place of this one, whole or not at all.

        Raises
        ------
        SettingsError
            If the file is not what this text was read from any more.
        ArchiveError
            If the disk refuses.
        """
        # a link is followed: what it leads to is replaced, and the link stays
        target = self.path.resolve()
        if CampaignText.read(target).digest != self.digest:
            raise SettingsError(
                f"{self.path} changed on the disk since it was read",
                needed="the diff looked at again",
                hint="Nothing was written. Load the file again.",
            )
        try:
            if not target.stat().st_mode & _WRITABLE:
                # to be renamed over needs no leave of the file itself
                raise PermissionError(errno.EACCES, "it is read-only")
            with whole_file(target) as part:
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
    """Every text of a document that is short enough for the name of a file."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for one in value:
            yield from _texts(one)
    elif isinstance(value, str) and len(value) < _LONGEST_NAME:
        yield value


def _as_text(value: object) -> str:
    """A value as a person writes it into a field; entries of a list parted by commas."""
    if isinstance(value, list):
        return ", ".join(map(_as_text, value))
    return str(value)


def _as_value(setting: Setting, text: str, control: str) -> Value:
    """A text of a field as campaign.toml has it; what it means is checked there."""
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
    """A number where the text is one, else the text: a value with its unit."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text

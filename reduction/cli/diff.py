"""Compares two products, runs what that requires, and prints the differences."""

from __future__ import annotations

import os
import subprocess
import sys
import tarfile
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from dataclasses import asdict
from importlib.metadata import distributions
from io import BytesIO
from pathlib import Path
from typing import Any

from rich.markup import escape

import reduction
from reduction.archive.product_differences import Change, Differences, differences_between
from reduction.cli.output import CommandOutput
from reduction.cli.printed_numbers import short, table_of, within
from reduction.cli.progress import campaign_progress
from reduction.cli.remote_paths import in_order
from reduction.quantities.units import UnitSystem, display_unit
from reduction.readers.remote_files import scratch_folder
from reduction.record.errors import DataError, SettingsError


def _run_revision(revision: str, campaign: Path, scratch: Path, output: CommandOutput) -> Path:
    """Reduce a campaign with a revision of the checkout from which this package is installed."""
    checkout = _find_checkout(Path(reduction.__file__).parents[1])
    source = _export_revision(checkout, revision, scratch)
    processed = scratch / "processed"
    with in_order(), campaign_progress(output) as bar:
        bar.stage(f"building {revision}", 0)
        python = _install(source, scratch, revision)
        bar.stage(f"reducing with {revision}", 0)
        # isolated, so that neither this folder nor PYTHONPATH provides another version
        done = _run(
            [str(python), "-I", "-m", "reduction", "run", str(campaign), "--processed",
             str(processed), "--reports", str(scratch / "reports"), "--quiet"]
        )  # fmt: skip
    made = sorted(processed.iterdir()) if processed.is_dir() else []
    if not made:
        raise SettingsError(
            f"revision {revision} cannot run {campaign}",
            found=_last_line(done.stderr) or f"exit status {done.returncode}",
            hint="A key of campaign.toml may be newer than that revision.",
        )
    return made[0]


def _find_checkout(folder: Path) -> Path:
    """Git checkout from which a package was installed in place."""
    done = _git(folder, "ls-files", "--error-unmatch", "reduction/__init__.py")
    if done.returncode:
        raise SettingsError(
            "--against needs the git checkout of this software",
            found=f"{folder}: {_last_line(done.stderr)}",
            needed="a clone, installed in place: pip install -e .",
        )
    return folder


def _export_revision(checkout: Path, revision: str, scratch: Path) -> Path:
    """Unpack the source of a revision without changing the checkout."""
    known = _git(checkout, "rev-parse", "--verify", "--end-of-options", f"{revision}^{{commit}}")
    if known.returncode:
        raise SettingsError(
            "--against: no such revision",
            found=repr(revision),
            needed=f"a commit, tag or branch of {checkout}",
        )
    packed = _git(checkout, "archive", "--format=tar", known.stdout.decode().strip())
    if packed.returncode:
        raise SettingsError(
            f"revision {revision} cannot be unpacked", found=_last_line(packed.stderr)
        )
    source = scratch / "source"
    with tarfile.open(fileobj=BytesIO(packed.stdout)) as files:
        if hasattr(tarfile, "data_filter"):
            files.extractall(source, filter="data")
        else:  # Python before 3.11.4, as in Debian 12; the archive comes from git
            files.extractall(source)  # noqa: S202
    return source


def _install(source: Path, scratch: Path, revision: str) -> Path:
    """Install a source with the same versions of other packages as here."""
    environment = scratch / "environment"
    versions = scratch / "versions.txt"
    installed = {one.name: one.version for one in distributions() if one.name}
    installed.pop("mooring-reduction", None)
    # so that any difference is due to this software
    versions.write_text("".join(f"{name}=={number}\n" for name, number in installed.items()))
    python = environment / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    for command in (
        [sys.executable, "-m", "venv", str(environment)],
        [str(python), "-I", "-m", "pip", "install", "--quiet", "--disable-pip-version-check",
         "--constraint", str(versions), str(source)],
    ):  # fmt: skip
        done = _run(command)
        if done.returncode:
            raise SettingsError(
                f"revision {revision} cannot be installed",
                found=_last_line(done.stderr) or _last_line(done.stdout),
                hint="pip needs network access, or cached packages.",
            )
    return python


def _git(folder: Path, *words: str) -> subprocess.CompletedProcess[bytes]:
    return _run(["git", "-C", str(folder), *words])


def _run(command: Sequence[str]) -> subprocess.CompletedProcess[bytes]:
    try:
        return subprocess.run(command, capture_output=True, check=False)  # noqa: S603  # no shell
    except OSError as error:
        raise SettingsError(
            f"{command[0]} cannot be started", found=error.strerror or str(error)
        ) from error


def _last_line(said: bytes) -> str:
    lines = said.decode(errors="replace").strip().splitlines()
    return lines[-1].rstrip(".") if lines else ""


_ROWS = 20
"""Rows of a table; the others are counted, and are in the ``--json`` output."""

_ORDER = ("answer", "uncertainty", "number")
_SAID = {"came": "added", "went": "removed"}


def show_differences(
    before: Path, after: Path | None, *, against: str | None, is_exact: bool, output: CommandOutput
) -> None:
    """Compare two products, or two runs of a campaign; status 4 if an answer moved."""
    if (after is None) == (against is None):
        raise SettingsError(
            "diff compares two things",
            found="B and --against" if against else "A alone",
            needed="A and B, or CAMPAIGN.toml --against REV",
        )
    if against is not None and before.suffix.lower() != ".toml":
        raise SettingsError(
            "--against runs a campaign", found=str(before), needed="its campaign.toml"
        )
    with ExitStack() as opened:
        scratch = opened.enter_context(scratch_folder())
        # the message names the original, not its copy
        if against is not None:
            one = _run_revision(against, before.absolute(), scratch / "before", output)
            output.names[str(one)] = f"{before} by {against}"
        else:
            one = _products(before, scratch / "before", output)
        other = _products(before if after is None else after, scratch / "after", output)
        found = differences_between(one, other, is_exact=is_exact)
    _say(found, output)
    output.answer(_document(found))
    if found.is_moved:
        output.raise_status(DataError.exit_status)


def _products(path: Path, scratch: Path, output: CommandOutput) -> Path:
    """A product unchanged; for a campaign.toml, the product of a run."""
    if path.suffix.lower() != ".toml":
        return path
    # existing products are compared without importing the reduction
    from reduction.cli.campaigns import run_campaign
    from reduction.cli.remote_paths import campaign_at

    silent = CommandOutput(quiet=True)
    with campaign_at(path, allow_remote=False, output=silent) as campaign:
        run_campaign(
            campaign, processed=scratch / "processed", reports=scratch / "reports",
            tests=(), force=True, jobs=None, scheduler=None, output=silent,
        )  # fmt: skip
    made = scratch / "processed" / campaign.id
    output.names[str(made)] = str(path)
    return made


# printed text


def _say(found: Differences, output: CommandOutput) -> None:
    output.say(_verdict(found, output.system))
    _say_numbers(found.changes, output)
    texts = [one for one in found.changes if one.kind == "text" and one.n_changed]
    _say_counted("texts changed", (one.variable for one in texts), output)
    for heading, named in (("removed", found.removed), ("added", found.added)):
        _say_counted(heading, (_said_name(one) for one in named), output)
    _say_counted("in another group now", (one["variable"] for one in found.regrouped), output)
    _say_attributes(found.attributes, output)
    for one in found.tests:
        output.say(f"test {one['test']}: {_said_test(one)}")
    versions = [one for one in found.history if one["attribute"] != "history"]
    for said in _counted(f"{one['before']} -> {one['after']}" for one in versions):
        output.say(f"version: {said}")
    n_histories = len(found.history) - len(versions)
    if n_histories:
        output.say(f"history: other lines in {_number(n_histories, 'file')}")


def _verdict(found: Differences, units: UnitSystem) -> str:
    """One line: number of answers moved, other changes, and the worst."""
    changes = found.changes
    answers = [one for one in changes if one.kind == "answer"]
    n_moved, n_changed = (
        sum(getattr(one, name) for one in answers) for name in ("n_moved", "n_changed")
    )
    far = "changed" if found.is_exact else "moved by more than half their standard uncertainty"
    said = [f"{n_moved:,} of {_number(sum(one.n for one in answers), 'answer')} {far}"]
    if n_changed > n_moved:
        said.append(f"{n_changed - n_moved:,} changed by less")
    for name, word in _SAID.items():
        n = sum(getattr(one, f"n_{name}") for one in answers)
        if n:
            said.append(f"{n:,} {word}")
    wider = sum(one.n_moved for one in changes if one.kind == "uncertainty")
    if wider:
        far = "" if found.is_exact else " by more than half"
        said.append(f"{_number(wider, 'standard uncertainty')} changed{far}")
    others = {one.variable for one in changes if one.kind == "number" and one.n_changed}
    if others:
        said.append(f"{_number(len(others), 'quantity')} without uncertainty changed")
    failing = [one["test"] for one in found.tests if one["fails_now"]]
    if failing:
        said.append(f"failing now: {', '.join(failing)}")
    moved = _ranked(one for one in changes if one.n_moved)
    if moved:
        worst = moved[0]
        before, after, unit = _shown(worst, units)
        where = " ".join([Path(worst.file).with_suffix("").as_posix(), *_where(worst)])
        said.append(
            f"worst: {worst.variable} of {where}: {before} -> {after} {unit}".rstrip()
            + f", {_far(worst)}"
        )
    return "; ".join(said)


def _ranked(changes: Iterable[Change]) -> list[Change]:
    """Worst first: moved numbers, answers before others, then by the shift."""

    def rank(one: Change) -> tuple[bool, int, float]:
        size = one.relative if one.shift is None else one.shift
        return (
            not one.n_moved,
            _ORDER.index(one.kind),
            -abs(size or 0.0),
        )

    return sorted((one for one in changes if one.kind in _ORDER), key=rank)


def _say_numbers(changes: Sequence[Change], output: CommandOutput) -> None:
    """Print the worst change of each quantity over all files."""
    of_name: dict[tuple[str, str], list[Change]] = {}
    for one in _ranked(one for one in changes if one.n_changed):
        of_name.setdefault((one.variable, one.kind), []).append(one)
    if not of_name:
        return
    table = table_of(
        *"quantity|worst at|before|after|change|changed|moved|added|removed".split("|"), texts=2
    )
    for same in list(of_name.values())[:_ROWS]:
        worst = same[0]
        before, after, unit = _shown(worst, output.system)
        table.add_row(
            escape(worst.variable + (f" [{unit}]" if unit else "")),
            escape(", ".join([worst.file, *_where(worst)])), before, after, _far(worst),
            *(str(sum(numbers)) for numbers in zip(*map(_counts, same), strict=True)),
        )  # fmt: skip
    output.show(table)
    if len(of_name) > _ROWS:
        output.say(f"  and {_number(len(of_name) - _ROWS, 'quantity')} more (--json has all)")


def _counts(one: Change) -> tuple[int, ...]:
    return one.n_changed, one.n_moved, one.n_came, one.n_went


def _shown(one: Change, units: UnitSystem) -> tuple[str, str, str]:
    """Both values with enough digits to show the change, and their unit."""
    unit, factor = display_unit(one.unit, units)
    values = [
        value * factor if isinstance(value, (int, float)) else value
        for value in (one.before, one.after)
    ]
    numbers = [value for value in values if isinstance(value, (int, float))]
    if len(numbers) == 2:
        halves = [abs(numbers[1] - numbers[0]), (one.standard_uncertainty or 0.0) * factor]
        texts = [within(value, *halves) for value in numbers]
        # a change beyond the seventh digit is shown with all digits
        return (
            *(texts if texts[0] != texts[1] else map(repr, numbers)),
            "" if unit == "1" else unit,
        )
    texts = ["-" if v is None else short(v) if isinstance(v, float) else str(v) for v in values]
    return texts[0], texts[1], "" if unit == "1" else unit


def _far(one: Change) -> str:
    """Change of a number, in uncertainties if it has one."""
    if one.change in ("came", "went", "shape"):
        return _SAID.get(one.change, one.change)
    if one.shift is not None:
        return f"{one.shift:+.3g} u"
    return "from 0" if one.relative is None else f"{100 * one.relative:+.3g} %"


def _where(one: Change) -> list[str]:
    """Labels of a place: a number with its dimension."""
    return [
        f"{name} {label}" if label[:1].isdigit() or label[:1] == "-" else label
        for name, label in one.where.items()
    ]


def _said_name(one: dict[str, Any]) -> str:
    if one["kind"] == "rows":
        more = ", ..." if one["n"] > len(one["rows"]) else ""
        return f"{one['name']} {', '.join(map(_cut, one['rows'][:3]))}{more}"
    return f"{one['kind']} {one['name']}"


def _said_test(one: dict[str, Any]) -> str:
    if one["change"] != "changed":
        return str(one["change"])
    differing = [
        key for key in one["before"] if one["before"][key] != (one["after"] or {}).get(key)
    ]
    return "; ".join(
        f"{key} {_cut(one['before'][key])} -> {_cut(one['after'].get(key))}" for key in differing
    )


def _say_attributes(attributes: Sequence[dict[str, Any]], output: CommandOutput) -> None:
    alike: dict[tuple[str, str, str], list[str]] = {}
    for one in attributes:
        values = (_cut(one["before"]), _cut(one["after"]))
        of = one["attribute"] if one["of"].startswith("/") else f"{one['of']}.{one['attribute']}"
        alike.setdefault((of, *values), []).append(one["file"])
    if not alike:
        return
    table = table_of("attribute", "before", "after", "files", texts=3)
    for said, files in list(alike.items())[:_ROWS]:
        table.add_row(*map(escape, said), str(len(files)))
    output.show(table)
    if len(alike) > _ROWS:
        output.say(f"  and {_number(len(alike) - _ROWS, 'attribute')} more (--json has all)")


def _cut(value: object) -> str:
    text = "" if value is None else str(value)
    return text if len(text) <= 40 else f"{text[:37]}..."


def _say_counted(heading: str, names: Iterable[str], output: CommandOutput) -> None:
    said = _counted(names)
    more = f", and {len(said) - _ROWS} more" if len(said) > _ROWS else ""
    if said:
        output.say(f"{heading}: {', '.join(said[:_ROWS])}{more}")


def _counted(names: Iterable[str]) -> list[str]:
    """Each name once, with the number of its files."""
    return [
        f"{name} ({_number(n, 'file')})" if n > 1 else name for name, n in Counter(names).items()
    ]


def _number(n: int, name: str) -> str:
    plural = f"{name[:-1]}ies" if name.endswith("y") else f"{name}s"
    return f"{n:,} {name if n == 1 else plural}"


# the ``--json`` output


def _document(found: Differences) -> dict[str, Any]:
    changed = [asdict(one) for one in found.changes if one.n_changed]
    tables: dict[str, dict[str, Any]] = {}

    def table(file: str) -> dict[str, Any]:
        empty = {"file": file, "columns": [], "added": [], "removed": []}
        return tables.setdefault(file, empty)

    for one in found.tabled:
        if one.n_changed:
            table(one.file)["columns"].append(asdict(one))
    for key, named in (("added", found.added), ("removed", found.removed)):
        for each in named:
            if each["file"].endswith(".csv"):
                table(each["file"])[key].append(each)
    return {
        "status": DataError.exit_status if found.is_moved else 0,
        "verdict": _verdict(found, "si"),
        "exact": found.is_exact,
        "n_answers": sum(one.n for one in found.changes if one.kind == "answer"),
        "answers": [one for one in changed if one["kind"] in ("answer", "uncertainty")],
        "numbers": [one for one in changed if one["kind"] == "number"],
        "texts": [one for one in changed if one["kind"] == "text"],
        "added": found.added,
        "removed": found.removed,
        "moved": found.regrouped,
        "attributes": found.attributes,
        "history": found.history,
        "tables": list(tables.values()),
        "tests": found.tests,
    }

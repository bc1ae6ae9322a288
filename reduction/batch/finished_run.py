"""Record of the last complete run of a campaign, to stop a new run if nothing has changed.

The digests are of contents.  If a file is changed, missing or added, or the version of the package
or the units differ, the campaign runs as if nothing had been kept.
"""

from __future__ import annotations

import hashlib
import json
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path

from reduction import __version__
from reduction.archive.atomic_write import atomic_file, take_away
from reduction.archive.product_files import SUPERSEDED
from reduction.batch.campaign_status import (
    CampaignResult,
    PartStatus,
    ShownAnswers,
    ShownTable,
    TestStatus,
)
from reduction.batch.run_lock import LOCK_NAME
from reduction.record.errors import ReductionError

_NAME = "finished-run.json"

_OF_ANY_RUN = (LOCK_NAME, _NAME, "status.csv")
"""Files beside the products that describe the last run, whatever its result."""


def keep_finished(result: CampaignResult, choices: Mapping[str, str]) -> None:
    """Write the record of a run beside its products, unless the run failed.

    ``choices`` are the options of the run that affect a product.
    """
    path = result.processed / _NAME
    is_told_once = result.stray or result.superseded or result.replaced
    if result.exit_status or is_told_once or result.report is None:
        take_away(path)
        return
    tests = [asdict(replace(one, seconds=0.0, worker="")) for one in result.tests]
    kept = {
        "version": __version__,
        "choices": dict(choices),
        "read": dict(result.read),
        "written": _written(result.processed, result.report.parent),
        "tests": tests,
        "parts": {kind: [asdict(one) for one in own] for kind, own in result.parts.items()},
        "results": result.results,
        "tables": [one.relative_to(result.processed).as_posix() for one in result.tables],
        "answers": asdict(result.answers),
    }
    with atomic_file(path) as part:
        part.write_text(json.dumps(kept, ensure_ascii=False) + "\n", encoding="utf-8")


def finished_run(
    campaign: Path, processed: Path, reports: Path, choices: Mapping[str, str]
) -> CampaignResult | None:
    """Result of the last run of a campaign if everything it read and wrote is unchanged."""
    # whatever is missing, damaged or of another version: the run is simply done again
    with suppress(OSError, ValueError, LookupError, TypeError, ReductionError):
        name = tomllib.loads(campaign.read_text(encoding="utf-8-sig"))["campaign"]["id"]
        folder, report = processed / name, reports / name
        kept = json.loads((folder / _NAME).read_text(encoding="utf-8"))
        if (
            kept["version"] != __version__
            or kept["choices"] != dict(choices)
            or any(_digest(campaign.parent / one) != sum_ for one, sum_ in kept["read"].items())
            or kept["written"] != _written(folder, report)
        ):
            return None
        answers = kept["answers"]
        return CampaignResult(
            tests=tuple(replace(TestStatus(**one), status="unchanged") for one in kept["tests"]),
            parts={kind: [PartStatus(**one) for one in own] for kind, own in kept["parts"].items()},
            results=kept["results"],
            processed=folder,
            report=report / "index.html",
            tables=tuple(folder / one for one in kept["tables"]),
            read=kept["read"],
            answers=ShownAnswers(
                [ShownTable(**one) for one in answers["tables"]],
                [(tests, text) for tests, text in answers["doubts"]],
                answers["answered"],
                answers["is_synthetic"],
                answers["withheld"],
            ),
        )
    return None


def _written(processed: Path, report: Path) -> dict[str, str]:
    """Digests of all products of a campaign, by name."""
    places = {"processed": processed, "reports": report}
    return {
        f"{place}/{name}": _digest(folder / name)
        for place, folder in places.items()
        for name in sorted(_names(folder))
    }


def _names(folder: Path) -> Iterator[str]:
    for path in folder.rglob("*"):
        name = path.relative_to(folder)
        if not path.is_dir() and name.parts[0] != SUPERSEDED and str(name) not in _OF_ANY_RUN:
            yield name.as_posix()


def _digest(path: Path) -> str:
    if not path.is_file():  # opening a pipe would block
        return ""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()

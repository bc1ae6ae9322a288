"""Checks products against their raw files and settings."""

from __future__ import annotations

import filecmp
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from typing import Any, Literal

from reduction import __version__
from reduction.archive.csv_tables import write_tables
from reduction.archive.open import ReadOnce, reading
from reduction.archive.product_files import OF_CAMPAIGN, archives_in
from reduction.archive.write import values_sha256
from reduction.batch.campaign_status import Progress
from reduction.batch.experiment_product import settings_of_experiments
from reduction.batch.requested_products import (
    ReductionInputs,
    find_reduction_inputs,
    requested_parts,
    requested_products,
)
from reduction.batch.reuse import reusable_product
from reduction.batch.survey import Survey
from reduction.campaign.plan import Campaign
from reduction.readers.raw_log import hash_source
from reduction.record.errors import ArchiveError, LogError, ReductionError
from reduction.record.measurement import Source
from reduction.record.plain_text import is_address

_AGAIN = "Run the campaign again."

Kind = Literal["damaged", "missing", "raw_file", "settings", "table"]
"""Kind of fault, explained in docs/verify.md."""


@dataclass(frozen=True)
class _Finding:
    """One fault of one file; ``product`` is its name below the folder."""

    product: str
    kind: Kind
    problem: str
    found: str = ""
    needed: str = ""
    hint: str = _AGAIN

    def __str__(self) -> str:
        """The finding on one line, in the form of an error."""
        parts = [f"{self.product}: {self.problem}"]
        parts += [f"found {self.found}"] if self.found else []
        parts += [f"needed {self.needed}"] if self.needed else []
        return f"{'; '.join(parts)}. {self.hint}"


@dataclass(frozen=True)
class _Verification:
    """Items checked in the folder of one campaign, and the faults found."""

    campaign: str
    n_archives: int
    n_sources: int
    n_tables: int
    findings: tuple[_Finding, ...]
    remarks: tuple[str, ...] = ()


def verify_campaign(campaign: Campaign, folder: Path, *, progress: Progress) -> _Verification:
    """Check whether the products of a campaign agree with its current raw files."""
    paths = archives_in(folder)
    progress.stage("verify archives", len(paths))
    findings: list[_Finding] = []
    attributes: dict[str, dict[str, Any]] = {}
    for path in paths:
        try:
            with reading(path) as archive:
                attributes[path.stem] = archive.attrs
            if values_sha256(path) != archive.attrs.get("values_sha256"):
                attributes.pop(path.stem)
                problem = "its values are not those that were written"
                findings.append(_Finding(path.name, "damaged", problem))
        except (ArchiveError, OSError, RuntimeError) as error:
            attributes.pop(path.stem, None)
            findings.append(_Finding(path.name, "damaged", "it cannot be read", str(error)))
        progress.ended(path.stem)
    sources = _Sources(campaign, folder)
    of_sources = [
        one for name, stated in attributes.items() for one in sources.faults(name, stated)
    ]
    differing = {one.product for one in of_sources}
    findings += of_sources
    as_they_were = {name: one for name, one in attributes.items() if f"{name}.nc" not in differing}
    wanted = find_reduction_inputs(campaign, progress=progress)
    findings += _of_settings(campaign, folder, as_they_were, wanted)
    tests = _tests_of(campaign, wanted)
    findings += [
        _Finding(f"{name}.nc", "missing", "it is not there, and the campaign asks for it")
        for name in (*tests, *sorted(requested_parts(campaign)))
        if not (folder / f"{name}.nc").exists()
    ]
    progress.stage("verify tables", 0)
    n_tables = 0
    if len(attributes) == len(paths):  # no tables can be made from unreadable archives
        there = [folder / f"{name}.nc" for name in tests if name in attributes]
        whole = requested_products(campaign, folder, has_lengths=True)
        n_tables, of_tables = _of_tables(folder, there, whole) if there or whole else (0, [])
        findings += of_tables
    remarks = (
        f"{one} is remote and was not compared (--allow-remote fetches it)"
        for one in sources.not_fetched
    )
    return _Verification(
        campaign.id, len(paths), sources.n_read, n_tables, tuple(findings), tuple(remarks)
    )


def _tests_of(campaign: Campaign, wanted: ReductionInputs) -> list[str]:
    """Ids of the products of tests and steps, in the order of the campaign."""
    found: dict[str, list[str]] = {}
    for survey in wanted.first.surveys:
        found.setdefault(survey.plan.log, []).append(survey.plan.id)
    return [
        product
        for plan in campaign.tests.values()
        for product in ([step.product(plan.id) for step in plan.steps] or found[plan.id])
    ]


class _Sources:
    """Compares the source files of archives with their checksums; each is read once."""

    def __init__(self, campaign: Campaign, folder: Path) -> None:
        self._campaign = campaign
        self._folder = folder
        self._seen: dict[Path, Source | LogError] = {}
        self.not_fetched: dict[str, None] = {}

    @property
    def n_read(self) -> int:
        """Number of files read."""
        return sum(isinstance(one, Source) for one in self._seen.values())

    def faults(self, archive: str, attributes: Mapping[str, Any]) -> Iterator[_Finding]:
        """Sources of an archive that have changed."""
        product = f"{archive}.nc"
        names, sums, sizes = (
            str(attributes.get(key, "")).splitlines()
            for key in ("raw_file", "raw_file_sha256", "raw_file_bytes")
        )
        if not names or not len(names) == len(sums) == len(sizes):
            yield _Finding(product, "damaged", "it does not say what it was made from")
            return
        for name, *stated in zip(names, sums, sizes, strict=True):
            if not is_address(name) and (
                PurePath(name).is_absolute() or ".." in PurePath(name).parts
            ):
                problem = "it names a source outside of the folder of its campaign"
                yield _Finding(product, "damaged", problem, f"'{name}'")
                continue
            path = self._place(archive, name)
            if path is None:
                continue
            needed = "sha256 {:.16}... of {} bytes".format(*stated)
            found = self._read(path, name)
            if isinstance(found, LogError):
                problem = f"{name}, from which it was made, cannot be read"
                yield _Finding(product, "raw_file", problem, found.found or found.problem, needed)
            elif [found.sha256, str(found.size)] != stated:
                yield _Finding(
                    product, "raw_file", f"{name} is not the file from which it was made",
                    f"sha256 {found.sha256:.16}... of {found.size} bytes", needed,
                    f"If {name} should not have changed, restore the original; if it should, run "
                    "the campaign again.",
                )  # fmt: skip

    def _place(self, archive: str, name: str) -> Path | None:
        """Location of a source; None if remote and not fetched."""
        if is_address(name):
            if name not in self._campaign.copies:
                self.not_fetched[name] = None
            return self._campaign.copies.get(name)
        if archive in OF_CAMPAIGN and name.endswith(".nc"):
            return self._folder / name
        if name == self._campaign.path.name:
            return self._campaign.path
        return self._campaign.copies.get(name, self._campaign.folder / name)

    def _read(self, path: Path, name: str) -> Source | LogError:
        if path not in self._seen:
            try:
                self._seen[path] = hash_source(path, name)
            except LogError as error:
                self._seen[path] = error
        return self._seen[path]


def _of_settings(
    campaign: Campaign,
    folder: Path,
    archives: Mapping[str, Mapping[str, Any]],
    wanted: ReductionInputs,
) -> Iterator[_Finding]:
    """Archives that a run would remake from the same files; logs are read as in a run."""
    for survey in wanted.first.surveys:
        if survey.plan.id in archives:
            yield from _of_test(survey, wanted, folder, archives[survey.plan.id])
    of_surfaces = settings_of_experiments(campaign.experiments) if campaign.experiments else None
    for name in OF_CAMPAIGN:
        if name in archives:
            now = of_surfaces if name == "surfaces" else None
            yield from _made_otherwise(f"{name}.nc", archives[name], now)


def _of_test(
    survey: Survey, wanted: ReductionInputs, folder: Path, attributes: Mapping[str, Any]
) -> Iterator[_Finding]:
    product = f"{survey.plan.id}.nc"
    try:
        error = survey.error or wanted.errors.get(survey.plan.id)
        if error is not None:
            raise error
        basis = wanted.basis(survey)
    except ReductionError as failure:
        yield _Finding(product, "settings", "the test cannot be reduced now", str(failure))
        return
    stands = reusable_product(folder / product, survey, basis.settings, remarks=basis.remarks)
    if stands is None:
        told = list(_made_otherwise(product, attributes, basis.settings))
        yield from told or [_Finding(product, "settings", "a run would make it again")]


def _made_otherwise(
    product: str, attributes: Mapping[str, Any], settings: str | None
) -> Iterator[_Finding]:
    version = str(attributes.get("software_version", ""))
    before = str(attributes.get("settings", ""))
    if version != __version__:
        problem = "another version of the software made it"
        yield _Finding(product, "settings", problem, version, __version__)
    elif settings is not None and before != settings:
        problem = "it was made with other settings, marks or earlier tests than there are now"
        pair = json.loads(before or "{}"), json.loads(settings)
        yield _Finding(product, "settings", problem, "; ".join(_differing(*pair)))


def _differing(before: Any, now: Any, place: str = "") -> Iterator[str]:
    """Differing places of two documents, each with both values."""
    if isinstance(before, dict) and isinstance(now, dict):
        for key in sorted({*before, *now}):
            yield from _differing(before.get(key), now.get(key), f"{place}.{key}".lstrip("."))
    elif before != now:
        yield f"{place} {json.dumps(before):.40}, now {json.dumps(now):.40}"


def _of_tables(
    folder: Path, archives: list[Path], products: Mapping[str, Any]
) -> tuple[int, list[_Finding]]:
    """Make the tables again elsewhere, and compare them byte for byte."""
    with TemporaryDirectory(prefix="reduction-verify-") as place:
        made = write_tables(archives, Path(place), opener=ReadOnce(), **products)
        names = [path.name for path in made]
        _, other, missing = filecmp.cmpfiles(place, folder / "tables", names, shallow=False)
    findings = [
        _Finding(f"tables/{name}", "table", "it differs from the archives") for name in other
    ]
    findings += [
        _Finding(f"tables/{name}", "missing", "it is missing, but the archives fill it")
        for name in missing
    ]
    return len(made), findings

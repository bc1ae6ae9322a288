"""Global attributes: what the file is, where it came from, what was done to it.

Every attribute is text and none is a list: a list of one does not survive netCDF.
Several raw files stand one a line, and so do the stages in ``history``.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from typing import Literal

from reduction.archive.version import SCHEMA_VERSION
from reduction.errors import ArchiveError
from reduction.product import ReducedTest
from reduction.provenance import Origin, Source, Step

PartName = Literal["surfaces", "outcomes", "predictions", "comparisons", "change_in_length"]

CONVENTIONS = "CF-1.11 ACDD-1.3"
_SOFTWARE = "mooring-reduction"
_PROPAGATION = "first order (JCGM 100:2008)"
# a line bends where E' comes near K_0: each test says by which of both its uncertainty is
_OF_LINE = "; K_1, tau and K_1 tau as test_line_uncertainty_method says (JCGM 101:2008)"
_KEYWORDS = "mooring, tension test, elastic modulus, hysteresis"
_OF_PART: dict[PartName, tuple[str, str]] = {
    "surfaces": (
        "Response surfaces and effects of experiment {names}.",
        "mooring, designed experiment, response surface, spring constant",
    ),
    "outcomes": (
        "Strength, strain at failure and life of lines, without logs.",
        "mooring, tensile strength, fatigue, abrasion, exposure",
    ),
    "predictions": (
        "Load and fill pressure of {names}, from construction alone.",
        "mooring, stretch hose, tire cord, load elongation, prediction",
    ),
    "comparisons": (
        "Measured curves against their predictions: {names}.",
        "mooring, stretch hose, validation, measured against predicted",
    ),
    "change_in_length": (
        "Change-in-length properties of {names}.",
        "mooring, rope, stiffness, change in length, creep",
    ),
}
_LEGAL = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def global_attributes(
    test: ReducedTest, *, version: str, command: str, samples: str = "all"
) -> dict[str, str]:
    """Return the global attributes in a fixed order; empty ones are left out.

    ``samples`` says which samples of the record are stored.
    """
    about = test.description
    names = " and ".join(one.name for one in test.specimens)
    return _complete(
        about.attributes,
        {
            "summary": f"Reduced {about.kind} test {about.test_id} of specimen {names}.",
            "keywords": _KEYWORDS,
            "id": f"{about.campaign_id}/{about.test_id}",
            "campaign": about.campaign_id,
            "test": about.test_id,
            "test_kind": about.kind,
            "control": about.control,
            "waveform": about.waveform,
            "test_order": "" if about.order is None else str(about.order),
            **_raw_files(test.sources),
            "uncertainty_propagation": _PROPAGATION
            + ("" if test.line_spread is None else _OF_LINE),
            "raw_metadata": "" if test.record is None else _as_json(test.record.metadata),
            "stored_samples": "" if test.record is None else samples,
            "settings": test.settings_json,
            "key": key_of(test.settings_json),
        },
        steps=test.stage_lines,
        version=version,
        command=command,
    )


def part_attributes(part: PartName, names: Sequence[str] = (), *, origin: Origin) -> dict[str, str]:
    """Return the global attributes of an archive of a part of a campaign, in the same order.

    Parameters
    ----------
    part : {"surfaces", "outcomes", "predictions", "comparisons", "change_in_length"}
        Which archive, as its file is called.
    names : sequence of str
        What it holds; not said of outcomes.
    origin : Origin
        Where it came from.

    Returns
    -------
    attributes : dict
        Texts; empty ones are left out.

    Raises
    ------
    ArchiveError
        If the laboratory gave an attribute a name that the archive keeps, or that CF refuses.
    """
    summary, keywords = _OF_PART[part]
    return _complete(
        origin.attributes,
        {
            "summary": summary.format(names=" and ".join(names)),
            "keywords": keywords,
            "id": f"{origin.campaign_id}/{part}",
            "campaign": origin.campaign_id,
            **_raw_files(origin.sources),
            "uncertainty_propagation": _PROPAGATION,
            "settings": origin.settings_json,
            "key": key_of(origin.settings_json),
        },
        steps=origin.steps,
        version=origin.version,
        command=origin.command,
    )


def key_of(settings_json: str) -> str:
    """What a product is known by beside its raw files and version: SHA-256 of its settings."""
    return hashlib.sha256(settings_json.encode()).hexdigest()


def _raw_files(sources: Sequence[Source]) -> dict[str, str]:
    return {
        "raw_file": "\n".join(one.name for one in sources),
        "raw_file_sha256": "\n".join(one.sha256 for one in sources),
        "raw_file_bytes": "\n".join(str(one.size) for one in sources),
    }


def _complete(
    attributes: Mapping[str, str],
    product: dict[str, str],
    *,
    steps: Sequence[Step],
    version: str,
    command: str,
) -> dict[str, str]:
    """What the laboratory gave and what the product is, with what every product says."""
    given = dict(attributes)
    title = given.pop("title", f"Campaign {product['campaign']}")
    source = given.pop("source", "")
    if given.get("synthetic") == "yes":
        # a reader who sees only the title or only the source has to see it too
        title = title if "synthetic" in title.lower() else f"{title} (synthetic data)"
        source = source if "synthetic" in source.lower() else f"synthetic; {source}".rstrip("; ")
    own = {
        "Conventions": CONVENTIONS,
        "schema_version": SCHEMA_VERSION,
        "title": title,
        "summary": given.pop("summary", product.pop("summary")),
        "keywords": given.pop("keywords", product.pop("keywords")),
        "source": source,
        **product,
        "command": command,
        "history": "\n".join(step.line(version) for step in steps),
        "software": _SOFTWARE,
        "software_version": version,
        "processing_level": "reduced",
    }
    _refuse_names(given, own)
    return {name: text for name, text in (own | given).items() if text}


def _as_json(metadata: dict[str, str]) -> str:
    return json.dumps(metadata, ensure_ascii=False) if metadata else ""


def _refuse_names(given: dict[str, str], own: dict[str, str]) -> None:
    taken = sorted(set(given) & set(own))
    if taken:
        raise ArchiveError(
            "attributes of the test have names that the archive keeps for itself",
            found=", ".join(taken),
            hint="Give them another name in campaign.toml.",
        )
    illegal = sorted(name for name in given if not _LEGAL.fullmatch(name))
    if illegal:
        raise ArchiveError(
            "attributes of the test have names that CF does not allow",
            found=", ".join(illegal),
            needed="letters, digits and underscores, a letter first",
            hint="Give them another name in campaign.toml.",
        )

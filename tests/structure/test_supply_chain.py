"""Dependencies are listed with their licences, locked with hashes, and bounded from below."""

import re
import tomllib
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]
ASKED = [*PROJECT["dependencies"], *(text for extra in EXTRAS.values() for text in extra)]
LISTED = {
    canonicalize_name(name.split()[0]): licence.strip()
    for name, licence in re.findall(
        r"^\| ([\w.-]+(?: \(Windows\))?) \| ([^|]+)\|",
        (ROOT / "docs" / "supply-chain.md").read_text(encoding="utf-8"), re.M,
    )
}  # fmt: skip


def locked(name):
    """Each requirement of a locked file, with its number of hashes."""
    text = (ROOT / "docs" / "environment" / name).read_text(encoding="utf-8").replace("\\\n", "")
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    return [
        (Requirement(line.partition("--hash")[0].strip()), line.count("--hash=sha256:"))
        for line in lines
    ]


def test_the_licence_of_every_dependency_is_listed():
    asked = [Requirement(one).name for one in ASKED]
    asked += [one.name for one, _ in locked("locked.txt")]
    assert not {canonicalize_name(name) for name in asked} - LISTED.keys()
    assert all(LISTED.values())


def test_every_locked_version_is_exact_and_has_hashes():
    for name in ("locked.txt", "build.txt"):
        for requirement, n_hashes in locked(name):
            assert str(requirement.specifier).startswith("=="), requirement
            assert n_hashes >= 1, requirement


def test_the_locked_environment_holds_every_dependency_within_its_bounds():
    found = {}
    for requirement, _ in locked("locked.txt"):
        (pin,) = requirement.specifier
        found.setdefault(canonicalize_name(requirement.name), []).append(Version(pin.version))
    for text in {*PROJECT["dependencies"], *EXTRAS["cluster"], *EXTRAS["remote"]}:
        asked = Requirement(text)
        versions = found[canonicalize_name(asked.name)]
        assert all(asked.specifier.contains(one, prereleases=True) for one in versions), text


def test_every_dependency_has_a_lower_bound_and_no_other():
    # `.ci/lowest` makes "==" of ">="
    for text in ASKED:
        (bound,) = Requirement(text).specifier
        assert bound.operator == ">=", text


def test_a_package_in_two_extras_has_one_bound():
    bounds = {}
    for text in ASKED:
        bounds.setdefault(canonicalize_name(Requirement(text).name), set()).add(text)
    assert not {name for name, texts in bounds.items() if len(texts) > 1}


def test_the_promises_on_security_lead_to_pages_that_exist():
    text = (ROOT / "SECURITY.md").read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#]+)", text):
        assert (ROOT / target).is_file(), target

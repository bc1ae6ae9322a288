"""What docs/ shows works, what it links to is there, and no key is left out."""

import ast
import re
import shutil
import tomllib
from dataclasses import asdict, fields
from pathlib import Path
from typing import get_args

import pytest

from reduction.batch.campaign_status import Status, status_csv
from reduction.campaign import model
from reduction.campaign import model as numbers
from reduction.campaign.load import load_campaign
from reduction.readers.layout import Channel, Layout
from reduction.readers.read_log import read_log
from reduction.record.settings import Limits, ReductionSettings

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
MADE = {"_build", "gallery", "reference", "tutorial"}  # by a build, where one was made in the place
PAGES = [
    ROOT / "README.md",
    *(path for path in sorted(DOCS.rglob("*.md")) if not MADE & set(path.relative_to(DOCS).parts)),
]
DEFINITIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CAMPAIGN, LAYOUTS = (
    (DOCS / name).read_text(encoding="utf-8") for name in ("campaign.md", "layouts.md")
)
SECTIONS = (
    model.CampaignFile, model._CampaignSection, model.SpecimenSection, model._StrainSection,
    model._FilePiece, model.Defaults, model.TestSection, model.StepSection,
    model.ExperimentSection,
)  # fmt: skip


def blocks(text, kind):
    return [body for language, body in FENCE.findall(text) if language == kind]


def keys(models):
    return {item.alias or name for one in models for name, item in one.model_fields.items()}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_toml_is_toml(page):
    assert all(tomllib.loads(body) for body in blocks(page.read_text(encoding="utf-8"), "toml"))


def test_the_complete_campaign_loads(tmp_path):
    for name in ("campaign.toml", "tests.csv", "marks.csv"):
        (body,) = re.findall(rf"^`{name}`:\n\n```\w+\n(.*?)^```$", CAMPAIGN, re.M | re.S)
        (tmp_path / name).write_text(body, encoding="utf-8")
    for name in ("T-1.csv", "T-2.csv"):
        shutil.copy(ROOT / "raw" / "tmt-synthetic" / name, tmp_path)
    campaign = load_campaign(tmp_path / "campaign.toml")
    assert list(campaign.tests) == ["T-1", "T-2"]
    assert len(campaign.marks["new"].test) == 6


def test_parts_of_a_campaign_are_valid():
    whole, *parts = (tomllib.loads(body) for body in blocks(CAMPAIGN, "toml"))
    seen = set()
    for part in parts:
        for test in part.get("tests", {}).values():
            test.setdefault("file", "log.csv")
        file = model.CampaignFile.model_validate(whole | part)
        for section in (file.defaults, *(file.tests.values() if "tests" in part else ())):
            changed = numbers.apply_numbers(
                ReductionSettings(), section.reduction, control="position"
            )
            seen.update(
                group.name
                for group in fields(changed)
                if getattr(changed, group.name) != getattr(ReductionSettings(), group.name)
            )
    assert seen == {"cycles", "modulus", "holds", "rope"}


@pytest.mark.parametrize("part", re.split(r"^## ", LAYOUTS, flags=re.M), ids=lambda part: part[:9])
def test_layouts_are_valid_and_read_the_text_above_them(part, tmp_path):
    declared = [tomllib.loads(body)["layouts"]["log"] for body in blocks(part, "toml")]
    for table, shown in zip(declared, blocks(part, "text") or [None] * len(declared), strict=True):
        layout = Layout.model_validate(table)
        if shown is not None:
            (tmp_path / "log").write_text(shown, encoding="utf-8")
            assert read_log(tmp_path / "log", layout, name="log").n_rows_read == 3


def test_every_format_has_a_section():
    shown = {tomllib.loads(body)["layouts"]["log"]["format"] for body in blocks(LAYOUTS, "toml")}
    assert shown == set(Layout.model_fields["format"].annotation.__args__)


def test_every_key_is_explained():
    assert not {key for key in keys(SECTIONS) if f"`{key}`" not in CAMPAIGN} - {
        "campaign", "specimens", "layouts", "defaults", "tests", "experiments",
    }  # fmt: skip
    assert not {key for key in keys((Layout, Channel)) if f"`{key}`" not in LAYOUTS}


def test_every_number_is_listed_with_its_default():
    listed = dict(re.findall(r"^\| `(\w+\.\w+)` \| ([^|]*) \|", CAMPAIGN, re.M))
    expected = {
        f"{group.name}.{item.name}": item.default
        for group in fields(ReductionSettings)
        for item in fields(group.default_factory)
        if (group.name, item.name) not in numbers._KEY_OF_TEST
    }
    assert listed.keys() == expected.keys()
    for name, default in expected.items():
        values = default if isinstance(default, tuple) else (default,)
        missing = "by length" if name == "archive.samples" else "found"
        shown = missing if default is None else ", ".join(f"{value:.7g}" for value in values)
        assert listed[name] == shown, name


def test_every_limit_is_listed_with_its_default():
    part = CAMPAIGN.partition("## [limits]")[2].partition("\n## ")[0]
    listed = dict(re.findall(r'^\| `(\w+)` \| `?"?([^|"]*)"?`? \|', part, re.M))
    values = {name: int(text) if text.isdigit() else text for name, text in listed.items()}
    assert dict(model._LimitsSection.model_validate(values)) == asdict(Limits())


def test_columns_and_answers_of_the_status_table_are_explained():
    part = CAMPAIGN.partition("## status.csv")[2].partition("\n## ")[0]
    listed = dict(re.findall(r"^\| `(\w+)` \| ?\w* \| (.*) \|$", part, re.M))
    assert list(listed) == status_csv([]).strip().split(",")
    assert all(f"`{one}`" in listed["status"] for one in get_args(Status))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    for target in re.findall(r"\]\((?!https?:)([^)\s]+)\)", text):
        name, _, anchor = target.partition("#")
        there = (page.parent / name).resolve() if name else page
        assert there.exists(), target
        if anchor:
            heads = re.findall(r"^#+ (.*)$", there.read_text(encoding="utf-8"), re.M)
            slugs = {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}
            assert anchor in slugs, target


def defined_in(path):
    """Functions, classes, methods, and the names that the module itself gives."""
    module = ast.parse(path.read_text(encoding="utf-8"))
    names = {node.name for node in ast.walk(module) if isinstance(node, DEFINITIONS)}
    for node in module.body:
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        names |= {one.id for one in targets if isinstance(one, ast.Name)}
    return names


@pytest.mark.parametrize("page", [*PAGES, ROOT / "CONTRIBUTING.md"], ids=lambda page: page.name)
def test_a_linked_name_is_defined_in_the_linked_file(page):
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    missing = [
        f"{name} in {target}"
        for name, target in re.findall(r"\[`(\w+)`\]\((?!https?:)([^)\s#]+\.py)\)", text)
        if name not in defined_in((page.parent / target).resolve())
    ]
    assert not missing, "\n".join(missing)

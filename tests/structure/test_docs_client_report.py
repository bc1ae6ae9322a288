"""docs/client-report.md: its example is read, and every key of ``[report]`` is explained."""

import re
import tomllib
from pathlib import Path

from reduction.archive import report_details as laboratory
from reduction.campaign.model import _ReportSection

PAGE = (Path(__file__).parents[2] / "docs" / "client-report.md").read_text(encoding="utf-8")
SCHEMA = _ReportSection.model_json_schema()
SECTIONS = [SCHEMA, *SCHEMA["$defs"].values()]


def test_the_example_can_be_read():
    (example,) = re.findall(r"```toml\n(.*?)```", PAGE, re.S)
    found = _ReportSection.model_validate(tomllib.loads(example)["report"])
    assert found.issued == "2026-03-05" and found.limits[0].upper == "1.2 MPa"


def test_every_key_is_explained():
    assert len(SECTIONS) == 7
    keys = {name for section in SECTIONS for name in section["properties"]}
    assert not {key for key in keys if f"`{key}`" not in PAGE}


def test_both_rules_are_explained_as_they_are_written():
    assert set(re.findall(r'^- `"([\w ]+)"`:', PAGE, re.M)) == set(laboratory.DecisionRule.__args__)

"""Mistakes that people make with a campaign: `check` names the cause of each that can be seen.

The list (`mistakes.py`) was written without the checks, with what could show each of them.
"""

import re
from pathlib import Path

import pytest
from mistakes import AREAS, MISTAKES, area_of, make, names_the_cause, prepare
from typer.testing import CliRunner

from reduction.cli.main import app

pytestmark = pytest.mark.slow

RAW = Path(__file__).parents[2] / "raw"

# from cycles that are reduced, which `check` does not do
SEEN_BY_A_RUN = {"rope-extensometer-slips", "tether-load-late-100ms"}
EACH = 6  # of the list, in the continuous integration; all of it at night
# one of each check that no other test reaches
ALWAYS = {
    "hose-cords-one-layer", "hose-dynamic-as-static", "hose-length-ft-for-in",
    "hose-wrong-specimen", "rope-accumulator-leaks", "rope-one-run-gain-2",
    "tether-stretch-of-readings-swapped", "tether-delimiter", "tether-second-header",
}  # fmt: skip

PLAIN = {}


def lines_of(folder, monkeypatch, command="check"):
    """Status of a command, and its lines."""
    monkeypatch.chdir(folder)
    done = CliRunner().invoke(app, [command, "campaign.toml"], env={"COLUMNS": "4000"})
    text = (done.output + "\n" + done.stderr).replace(str(folder), "")
    return done.exit_code, {re.sub(r"\s+", " ", line).strip() for line in text.splitlines()}


@pytest.mark.parametrize(
    "mistake",
    [
        pytest.param(
            one,
            id=one.name,
            marks=[] if place % EACH == 0 or one.name in ALWAYS else [pytest.mark.nightly],
        )
        for place, one in enumerate(MISTAKES)
    ],
)  # fmt: skip
def test_a_mistake_that_can_be_seen_is_named(mistake, tmp_path, monkeypatch):
    key = mistake.of, mistake.keep
    if key not in PLAIN:
        folder = tmp_path / "plain"
        folder.mkdir()
        prepare(mistake.of, RAW, folder, mistake.keep)
        status, PLAIN[key] = lines_of(folder, monkeypatch)
        assert status == 0
    folder = tmp_path / "mistaken"
    folder.mkdir()
    make(mistake, RAW, folder)
    status, lines = lines_of(folder, monkeypatch)
    assert status not in (1, 6)
    if mistake.visible == "no":
        return
    if mistake.name in SEEN_BY_A_RUN:
        status, lines = lines_of(folder, monkeypatch, "run")
    new = lines - PLAIN[key]
    assert names_the_cause(mistake, "\n".join(sorted(new))), (mistake.cause, sorted(new))


def test_the_list_is_long_and_its_exceptions_are_of_it():
    names = [one.name for one in MISTAKES]
    assert len(names) == len(set(names))
    count = {kind: sum(one.of == kind for one in MISTAKES) for kind in ("tether", "rope", "hose")}
    assert count["tether"] >= 60 and count["rope"] >= 25 and count["hose"] >= 15
    assert set(names) > SEEN_BY_A_RUN | ALWAYS


def test_the_page_counts_every_mistake_and_lists_those_that_nothing_shows():
    page = (RAW.parent / "docs" / "robustness.md").read_text(encoding="utf-8")
    rows = {
        area: [int(cell) for cell in cells.split(" | ")]
        for area, cells in re.findall(r"(?m)^\| ([^|]+) \| [^|]* \| ((?:\d+ \| ){6}\d+) \|$", page)
    }
    expected = {
        area: [
            *(sum(one.of == kind for one in there) for kind in ("tether", "rope", "hose")),
            *(
                sum(one.visible == by for one in there)
                for by in ("statement", "band", "data", "no")
            ),
        ]
        for area, there in (
            *((area, [one for one in MISTAKES if area_of(one) == area]) for area in AREAS),
            ("all", MISTAKES),
        )
    }
    assert rows == expected
    for one in MISTAKES:
        assert (f"| {area_of(one)} | {one.cause} |" in page) == (one.visible == "no"), one.name
        assert (f"\n- {one.cause}\n" in page) == (one.name in SEEN_BY_A_RUN), one.name

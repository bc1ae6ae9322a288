"""The design-value page shows, to the last digit, what the look-up of the command line shows."""

from pathlib import Path

import numpy as np
import pytest
from design_queries import (
    SHOWN_LINES,
    page_lines,
    questions,
    same_text,
    shown_by_command,
    type_by_command,
    types_of,
)
from odd_lines import odd_lines

from reduction.batch import run as batch_run
from reduction.campaign.load import load_campaign
from reduction.cli.lookupsource import lines_of
from reduction.cli.numbers import as_given, within
from reduction.cli.thousands import grouped
from reduction.designpage.campaigns import CampaignLines
from reduction.designpage.linedata import line_data
from reduction.designpage.page import render_design_page, write_design_page
from reduction.digits import fixed_number, plain_number
from reduction.lookup.product import LineCurve, LineSource
from reduction.published.linesource import published_sources
from reduction.uncertainty.combine import coverage_factor

SEED = 20_261_122
ASKED, BY_HAND, TYPES, ODD = 500, 30, 60, 300
RAW = Path(__file__).parents[2] / "raw"
ANSWERS = """questions => questions.map((one) => {
  const { headline, row, said, refused } = answer(one);
  return refused ? { refused } : { headline, row, said };
})"""
FILES = """questions => questions.map((one) => {
  const of = LINES.find((line) => line.key === one.line);
  const levels = Object.fromEntries(Object.entries(one.levels).map(([name, [number, unit]]) => (
    [name, levelInSi(name, number, unit, of.rated_break_strength)])));
  const stated = Object.fromEntries(Object.entries(one.stated).filter((pair) => pair[1] !== null));
  const isShare = Object.values(one.levels).some((given) => given[1] === "%RBS");
  try {
    return { files: moordynFiles({ ...one, stated, levels, isShare }) };
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    return { refused: error.message };
  }
})"""


@pytest.fixture(scope="module")
def made(campaigns, tmp_path_factory):
    """A page of the nylon campaign and of a tether: its path, its products, and its lines."""
    folder = tmp_path_factory.mktemp("design")
    processed = folder / "processed"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(batch_run, "write_report", lambda *_, **__: None)
        batch_run.run_campaign(
            load_campaign(RAW / "tmt-synthetic" / "campaign.toml"), processed=processed,
            reports=folder, clock=lambda: 0.0, tests=("T-1",),
        )  # fmt: skip
    name = "nylon-synthetic"
    (processed / name).symlink_to(campaigns(name).processed, target_is_directory=True)
    page = write_design_page(processed, folder / "reports")
    return page, processed, page_lines(processed, lines_of)


@pytest.fixture
def shown(made, visit):
    return visit(made[0])


def test_random_questions_have_the_answers_of_the_command(made, shown, monkeypatch):
    lines = {key: (line, own) for key, line, own in made[2]}
    asked = questions([(key, line) for key, line, _ in made[2]], ASKED, SEED)
    wanted = [shown_by_command(one, lines[one["line"]][1], monkeypatch) for one in asked]
    found = shown.page.evaluate(ANSWERS, asked)
    wrong = [triple for triple in zip(asked, wanted, found, strict=True) if triple[1] != triple[2]]
    assert wrong == []
    # no line that has a value and no unit is left out, and most questions have an answer
    assert {one["line"] for one in asked} == {
        key for key, (line, _) in lines.items() if line.quantities
    }
    assert {one["system"] for one in asked} == {"si", "us"}
    assert 10 < sum("refused" in one for one in wanted) < ASKED / 4
    assert shown.errors == []
    assert shown.beyond == []


def test_questions_put_into_the_form_are_answered_in_the_same_words(made, shown, monkeypatch):
    lines = {key: (line, own) for key, line, own in made[2]}
    page = shown.page
    for one in questions([(key, line) for key, line, _ in made[2]], BY_HAND, SEED + 1):
        page.locator(f"input[name=units][value={one['system']}]").check()
        page.locator("#line").select_option(one["line"])
        page.locator("#quantity").select_option(one["quantity"])
        if one["branch"]:
            page.locator("#branch").select_option(one["branch"])
        page.locator("#flag").set_checked(one["flag"])
        for name, (number, unit) in one["levels"].items():
            page.locator(f"#unit-{name}").select_option(unit)
            page.locator(f"#level-{name}").fill(repr(number))
        wanted = shown_by_command(one, lines[one["line"]][1], monkeypatch)
        if "refused" in wanted:
            told = page.locator("#said .refused").inner_text()
            assert wanted["refused"].split(";")[0] in told
        else:
            cells = page.locator("[data-head]").evaluate_all(
                "all => Object.fromEntries(all.map(one => [one.dataset.head, one.textContent]))"
            )
            # a blank between thousands is for eyes alone
            cells = {head: text.replace("\u202f", "") for head, text in cells.items()}
            row = {head: text for head, text in wanted["row"] if head != "remark"}
            assert cells == row
            remarks = dict(wanted["row"])["remark"]
            assert page.locator(".flags li").all_inner_texts() == (
                remarks.split("; ") if remarks else []
            )
            notes = page.locator("#notes").inner_text()
            for said in wanted["said"]:
                assert " ".join(said.removeprefix("note: ").split()) in " ".join(notes.split())
    assert shown.errors == []


def test_line_types_are_those_of_the_export(made, shown):
    asked = types_of(shown.page.evaluate(SHOWN_LINES), published_sources(), TYPES, SEED)
    found = shown.page.evaluate(FILES, asked)
    n_written = 0
    for one, ours in zip(asked, found, strict=True):
        theirs = type_by_command(one, made[1])
        assert ours.keys() == theirs.keys(), (one, ours, theirs)
        if "refused" in theirs:
            assert ours == theirs, one
            continue
        n_written += 1
        assert [name for name, _ in ours["files"]] == [name for name, _ in theirs["files"]]
        for (_, shown_text), (_, text) in zip(ours["files"], theirs["files"], strict=True):
            assert same_text(shown_text, text), one
    assert n_written > TYPES / 4


def test_lines_with_everything_at_once_have_the_answers_of_the_command(
    visit, tmp_path, monkeypatch
):
    lines = odd_lines()
    none = {"": {"refused": "made up"}}
    files = {
        "odd": {"state": "", "lines": [line_data(one) | {"export": none} for one in lines.values()]}
    }
    page = tmp_path / "design-values.html"
    page.write_text(render_design_page([CampaignLines("odd", files)]), encoding="utf-8")
    shown = visit(page)
    asked = questions([(f"odd/{name}", line) for name, line in lines.items()], ODD, SEED)
    wanted = [shown_by_command(one, list(lines.values()), monkeypatch) for one in asked]
    found = shown.page.evaluate(ANSWERS, asked)
    wrong = [triple for triple in zip(asked, wanted, found, strict=True) if triple[1] != triple[2]]
    assert wrong == []
    remarks = {
        part for one in wanted if "row" in one for part in dict(one["row"])["remark"].split("; ")
    }
    assert {"OUTSIDE what was tested", "untested corner", "peak above the rule"} < remarks


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """A page of the published lines, and of one line whose name is made to break a page."""
    at = np.array([0.5, 1.0, 1.5])
    name = "<img src=x onerror=alert(1)> \"'&amp;\n</script><b>" + "x" * 500
    line = LineSource(
        name, "a <i>source</i>", "<u>rubber</u>", "", "", 0.026, 3500.0, kind="rubber tether",
        curves=(
            LineCurve("branch_tension", "strain", 0.5, 1.5, at=at, value=100 * at,
                      branch="ascending", notes=("<b>note</b>",)),
        ),
        notes=("synthetic data",),
    )  # fmt: skip
    refused = {"mean": {"refused": "<s>no</s> curve"}}
    files = {"T<1>": {"state": "", "lines": [line_data(line) | {"export": refused}]}}
    campaign = CampaignLines("<h1>campaign</h1>", files, {"T-2.nc": "<b>no</b> archive"})
    page = tmp_path_factory.mktemp("small") / "design-values.html"
    page.write_text(render_design_page([campaign]), encoding="utf-8")
    return page, name


def open_type(page):
    """Open the part of the line type, and wait until it is written."""
    page.locator("#type summary").click()
    page.locator("#type-text > *").first.wait_for()


def test_numbers_are_written_by_the_rules_of_python(small, visit):
    chance = np.random.default_rng(SEED)
    ties = [0.5, 1.5, 2.5, 0.125, 0.375, 1234.5, 1235.5, 12345.5, 100002.5, 99999.5, 2.0**-20, 1e22]
    near = [2.675, 9.9995, 0.00099995, 9.9999995e-5, 1e-5, 123456.0, 999995.0, 0.0, -0.0, -2.5]
    values = [
        *ties,
        *near,
        *(10 ** chance.uniform(-8, 12, 300)).tolist(),
        *(-chance.random(50)).tolist(),
    ]
    # halves of the last digit that a power of two makes exact
    values += [
        (2 * int(one) + 1) / 2**power for one in chance.integers(1, 1e5, 200) for power in (1, 2, 3)
    ]
    page = visit(small[0]).page
    for script, form, digits in (
        ("general", "g", (2, 3, 4, 5, 6, 15)), ("fixed", "f", (0, 1, 2)), ("scientific", "e", (2, 4)),
    ):  # fmt: skip
        for count in digits:
            found = page.evaluate(f"values => values.map((one) => {script}(one, {count}))", values)
            assert found == [f"{one:.{count}{form}}" for one in values]
    for count in (2, 3, 4, 5, 6):
        found = page.evaluate(f"values => values.map((one) => plainNumber(one, {count}))", values)
        assert found == [plain_number(one, count) for one in values]
    for places in range(-6, 4):
        found = page.evaluate(f"values => values.map((one) => fixedNumber(one, {places}))", values)
        assert found == [fixed_number(one, places, mark="") for one in values]
    halves = [*(10 ** chance.uniform(-6, 10, len(values) - 3)).tolist(), 0.0, 1000.0, 999.9999999]
    pairs = list(zip(values, halves, strict=True))
    found = page.evaluate("pairs => pairs.map(([one, half]) => within(one, half, 7 * half))", pairs)
    assert found == [within(one, half, 7 * half) for one, half in pairs]
    found = page.evaluate("values => values.map(asGiven)", values)
    assert found == [as_given(one) for one in values]
    texts = [*found, *(f"{one} to {one}" for one in found)]
    shown = page.evaluate("texts => texts.map(grouped)", texts)
    assert [one.replace("\u202f", " ") for one in shown] == [grouped(one) for one in texts]
    found = page.evaluate("[NaN, Infinity, -Infinity, 0.26].map((one) => fixed(one, 1, '+'))")
    assert found == [f"{one:+.1f}" for one in (np.nan, np.inf, -np.inf, 0.26)]


def test_the_factor_of_an_interval_is_that_of_the_package(small, visit):
    freedom = [*np.geomspace(0.5, 1e10, 400), 1.0, 2.0, 5.0, 1999.0, 2001.0]
    found = visit(small[0]).page.evaluate("all => all.map(coverageFactor)", freedom)
    assert found == pytest.approx(coverage_factor(freedom), rel=1e-12)


def link(page, **state):
    text = "&".join(f"{name}={value}" for name, value in state.items())
    return f"{page.as_uri()}#{text}"


@pytest.mark.parametrize("width", [1280, 390])
@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_the_page_is_sound_for_everybody(small, visit, width, dark):
    shown = visit(small[0], width=width, dark=dark)
    open_type(shown.page)
    assert shown.faults() == []
    assert shown.page.evaluate("document.documentElement.scrollWidth") <= width
    assert shown.page.locator("#charts svg").count() == 3
    assert shown.errors == []
    assert shown.beyond == []


def test_names_stand_as_text(small, visit):
    page, name = small
    shown = visit(page, width=390)
    shown.page.locator("#filter-group").select_option("<h1>campaign</h1>")
    assert name in shown.page.locator("#line option").first.text_content()
    assert name in shown.page.locator("#answer-title").text_content()
    open_type(shown.page)
    assert "<s>no</s> curve" in shown.page.locator("#type-text").inner_text()
    assert "<b>note</b>" in shown.page.locator("#notes").inner_text()
    assert "<h1>campaign</h1>: T-2.nc cannot be read: <b>no</b> archive" in (
        shown.page.locator("#faults").inner_text()
    )
    assert shown.page.locator("main b, main i, main u, main s, main img, header b").count() == 0
    assert shown.page.evaluate("document.documentElement.scrollWidth") <= 390
    assert shown.page.locator("#synthetic").is_visible()
    # the state of such a line is held by its link too
    again = visit(shown.page.url)
    assert name in again.page.locator("#answer-title").text_content()
    assert shown.errors == again.errors == []


def test_a_link_holds_the_question(small, visit):
    asked = {
        "line": "nylon-double-braid-0.5in-new", "quantity": "relaxation_time", "frequency": "0.2 Hz",
        "mean_tension": "1500 lbf", "tension_amplitude": "10 %25RBS", "outside": "flag",
        "units": "us",
    }  # fmt: skip
    shown = visit(link(small[0], **asked))
    wanted = shown.page.locator("#said").inner_text()
    assert "1500 lbf" in wanted
    assert "10 %RBS" in wanted
    again = visit(shown.page.url)
    assert again.page.locator("#said").inner_text() == wanted
    shown.page.locator("#level-frequency").fill("0.4")
    again.page.goto(shown.page.url)
    assert again.page.locator("#level-frequency").input_value() == "0.4"
    assert again.page.locator("#said").inner_text() == shown.page.locator("#said").inner_text()


def test_a_link_to_a_line_that_is_not_here_says_so(small, visit):
    shown = visit(link(small[0], line="no-such-line"))
    assert "The link names a line that is not on this page: no-such-line" in (
        shown.page.locator("#said").inner_text()
    )


def test_outside_what_was_tested_is_refused_with_what_was_tested(small, visit):
    shown = visit(link(small[0], line="nylon-double-braid-0.5in-new"))
    shown.page.locator("#level-frequency").fill("0.7")
    told = shown.page.locator("#said").inner_text()
    assert "Refused" in told
    assert "frequency 0.7 Hz, tested 0.1 to 0.5 Hz" in told
    assert shown.page.locator("[data-head]").count() == 0
    shown.page.locator("#flag").check()
    assert "OUTSIDE what was tested" in shown.page.locator(".flags").inner_text()
    shown.page.locator("#level-frequency").fill("fast")
    assert "frequency is no number" in shown.page.locator("#said").inner_text()


def test_the_search_leaves_the_lines_that_are_so(small, visit):
    shown = visit(small[0])
    shown.page.locator("#find").fill("NYLON plait 5 years")
    assert shown.page.locator("#line option").all_inner_texts() == [
        "nylon-8-strand-plaited-0.5in-5-years"
    ]
    shown.page.locator("#find").fill("")
    shown.page.locator("#filter-material").select_option("nylon")
    shown.page.locator("#filter-diameter").select_option("25.4 mm")
    assert shown.page.locator("#line option").all_inner_texts() == ["nylon-double-braid-1in-new"]
    shown.page.locator("#find").fill("rubber")
    assert "No line has all of these" in shown.page.locator("#said").inner_text()


def test_the_form_is_reached_and_used_by_keys(small, visit):
    shown = visit(small[0])
    seen = []
    for _ in range(16):
        shown.page.keyboard.press("Tab")
        seen.append(
            shown.page.evaluate("document.activeElement.id || document.activeElement.className")
        )
    for name in ("skip", "find", "filter-group", "line", "quantity", "level-frequency", "flag"):
        assert name in seen
    before = shown.page.locator("#answer-title").inner_text()
    shown.page.locator("#line").focus()
    shown.page.keyboard.press("ArrowDown")
    assert shown.page.locator("#answer-title").inner_text() != before


def test_a_line_type_is_copied(small, visit):
    shown = visit(
        link(small[0], line="nylon-double-braid-0.5in-new"),
        permissions=["clipboard-read", "clipboard-write"],
    )
    open_type(shown.page)
    assert "needed linear_density above zero" in shown.page.locator("#type-text").inner_text()
    shown.page.locator("#stated-linear_density").fill("0.12")
    shown.page.locator("select#type-form").select_option("static-dynamic")
    shown.page.get_by_role("button", name="Copy nylon").click()
    shown.page.get_by_text("nylon_double_braid_0_5in_new_line.dat copied").wait_for()
    text = shown.page.evaluate("navigator.clipboard.readText()")
    assert text.startswith("MoorDyn input file with one line type")
    assert "found at frequency 0.3, mean tension 5978.4, tension amplitude 2419.8 (SI)" in text
    # a mass a length is that of one line
    shown.page.locator("#line").select_option("nylon-double-braid-1in-new")
    assert shown.page.locator("#stated-linear_density").input_value() == ""
    assert "needed linear_density above zero" in shown.page.locator("#type-text").inner_text()
    assert shown.errors == []

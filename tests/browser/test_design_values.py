"""The design-value page shows, to the last digit, what the look-up of the command line shows."""

import shlex
import shutil
from pathlib import Path

import numpy as np
import pytest
from commandruns import reduction
from design_queries import page_lines, questions, same_answer, same_text, shown_by_command
from nopage import NO_ANSWERS
from odd_lines import odd_lines
from scipy import stats

from reduction.batch import run_campaign as batch_run
from reduction.campaign.load import load_campaign
from reduction.cli.lookup import lines_of_source
from reduction.cli.printed_numbers import as_given, within
from reduction.cli.usage import grouped
from reduction.lines.lookup_product import LineCurve, LineSource
from reduction.pages.design_values import (
    _CampaignLines,
    _line_data,
    _render_design_page,
    write_design_page,
)
from reduction.quantities.digits import fixed_number, plain_number
from reduction.record.contributions import coverage_factor

SEED = 20_261_122
ASKED, BY_HAND, ODD = 500, 30, 300
RAW = Path(__file__).parents[2] / "raw"
ANSWERS = """questions => questions.map((one) => {
  const { headline, warnings, row, tables, said, refused, found } = answer(one);
  if (refused) return { refused };
  const names = ["value", "low", "high", "surface_low", "surface_high", "line_low", "line_high"];
  const values = [...names, "peak_share", "minimum_share"].map((name) => found[name]);
  return { headline, warnings, row, tables, said, values: values.map((value) => (Number.isFinite(value) ? value : null)) };
})"""
COMMANDS = """keys => keys.map(([key, levels, branch]) => exportCommandsOf(
  LINES.find((line) => line.key === key), { levels, branch, flag: false }))"""


@pytest.fixture(scope="module")
def made(campaigns, tmp_path_factory):
    """A page of the nylon campaign and of a tether: its path, its products, and its lines."""
    folder = tmp_path_factory.mktemp("design")
    processed = folder / "processed"
    with pytest.MonkeyPatch.context() as patch:
        nothing = None, NO_ANSWERS
        patch.setattr(batch_run.CampaignPage, "write", lambda *_, **__: nothing)
        batch_run.run_campaign(
            load_campaign(RAW / "tmt-synthetic" / "campaign.toml"), processed=processed,
            reports=folder, clock=lambda: 0.0, tests=("T-1",),
        )  # fmt: skip
    name = "nylon-synthetic"
    (processed / name).symlink_to(campaigns(name).processed, target_is_directory=True)
    page = write_design_page(processed, folder / "reports")
    return page, processed, page_lines(processed, lines_of_source)


def assert_same(asked, wanted, found):
    """Every answer is that of the command; next to all of them are letter by letter."""
    triples = list(zip(asked, wanted, found, strict=True))
    assert [one for one in triples if not same_answer(one[2], one[1])] == []
    texts = [
        [{name: one[name] for name in one if name != "values"} for one in triple[1:]]
        for triple in triples
    ]
    assert sum(one != other for one, other in texts) <= len(asked) / 100


@pytest.fixture
def shown(made, visit):
    return visit(made[0])


def test_random_questions_have_the_answers_of_the_command(made, shown, monkeypatch):
    lines = {key: (line, own) for key, line, own in made[2]}
    asked = questions([(key, line) for key, line, _ in made[2]], ASKED, SEED)
    wanted = [shown_by_command(one, lines[one["line"]][1], monkeypatch) for one in asked]
    found = shown.page.evaluate(ANSWERS, asked)
    assert_same(asked, wanted, found)
    # no line that has a value and no unit is left out, and most questions have an answer
    assert {one["line"] for one in asked} == {
        key for key, (line, _) in lines.items() if line.quantities
    }
    assert {one["system"] for one in asked} == {"si", "us"}
    assert 10 < sum("refused" in one for one in wanted) < ASKED / 4
    assert shown.errors == []
    assert shown.beyond == []


@pytest.mark.parametrize("n_asked", [2, BY_HAND])
def test_questions_put_into_the_form_are_answered_in_the_same_words(
    n_asked, made, shown, monkeypatch
):
    lines = {key: (line, own) for key, line, own in made[2]}
    page = shown.page
    for one in questions([(key, line) for key, line, _ in made[2]], n_asked, SEED + 1):
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
            assert cells.keys() == row.keys()
            assert all(same_text(cells[head], text) for head, text in row.items())
            remarks = dict(wanted["row"])["remark"]
            assert page.locator(".flags li").all_inner_texts() == (
                remarks.split("; ") if remarks else []
            )
            assert page.locator(".warnings li").all_inner_texts() == wanted["warnings"]
            assert page.locator("#said table").count() == len(wanted["tables"])
            notes = page.locator("#notes").inner_text()
            for said in wanted["said"]:
                assert " ".join(said.removeprefix("note: ").split()) in " ".join(notes.split())
    assert shown.errors == []


def test_the_commands_of_a_deck_write_it(made, shown):
    cycle = {
        "frequency": [0.3, "Hz"], "mean_tension": [21, "%RBS"], "tension_amplitude": [8.5, "%RBS"],
    }  # fmt: skip
    of_test = next(key for key, _, _ in made[2] if key.startswith("tmt-synthetic/"))
    asked = [
        ("nylon-double-braid-0.5in-new", cycle, None),
        ("rubber-tether-new-T-1", {"strain": [100, "%"]}, "ascending"),
        (of_test, {"strain": [100, "%"]}, "descending"),
    ]
    found = shown.page.evaluate(COMMANDS, asked)
    assert [len(one) for one in found] == [3, 1, 1]
    for text in (one for several in found for one in several):
        words = shlex.split(text.replace("... kg/m", "0.12 kg/m"))
        assert words[:2] == ["reduction", "export"]
        done = reduction(*words[1:], cwd=made[1].parent)
        if "load-dependent" in text:
            # the stiffness of this line does not grow with its tension: the command says so
            assert done.returncode == 2 and "Use --form static-dynamic" in done.stderr
            continue
        assert done.returncode == 0, (text, done.stderr)
        deck = (made[1].parent / words[-1]).read_text(encoding="utf-8")
        assert deck.startswith("MoorDyn input file with one line type")
    for key, line, _ in made[2]:
        if "/" in key and line.surfaces:
            shown.page.locator("#line").select_option(key)
            assert not shown.page.locator("#decks").is_visible()
            break
    else:
        pytest.fail("no line of surfaces of a campaign is on the page")


def test_lines_with_everything_at_once_have_the_answers_of_the_command(
    visit, tmp_path, monkeypatch
):
    lines = odd_lines()
    files = {"odd": {"state": "", "lines": [_line_data(one) for one in lines.values()]}}
    page = tmp_path / "design-values.html"
    page.write_text(_render_design_page([_CampaignLines("odd", files)]), encoding="utf-8")
    shown = visit(page)
    asked = questions([(f"odd/{name}", line) for name, line in lines.items()], ODD, SEED)
    wanted = [shown_by_command(one, list(lines.values()), monkeypatch) for one in asked]
    found = shown.page.evaluate(ANSWERS, asked)
    assert_same(asked, wanted, found)
    remarks = {
        part for one in wanted if "row" in one for part in dict(one["row"])["remark"].split("; ")
    }
    assert {"OUTSIDE the tested range", "untested corner", "peak above the rule"} < remarks


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
    files = {"T<1>": {"state": "", "lines": [_line_data(line)]}}
    campaign = _CampaignLines("<h1>campaign</h1>", files, {"T-2.nc": "<b>no</b> archive"})
    page = tmp_path_factory.mktemp("small") / "design-values.html"
    page.write_text(_render_design_page([campaign]), encoding="utf-8")
    return page, name


def test_numbers_are_written_as_the_command_writes_them(small, visit):
    chance = np.random.default_rng(SEED)
    near = [2.675, 9.9995, 0.00099995, 9.9999995e-5, 1e-5, 123456.0, 999995.0, 0.0, 1e22, 1e-300]
    values = [
        *near,
        *(10 ** chance.uniform(-8, 12, 600)).tolist(),
        *(-chance.random(50)).tolist(),
    ]
    page = visit(small[0]).page
    for count in (2, 3, 4, 5, 6):
        found = page.evaluate(f"values => values.map((one) => plainNumber(one, {count}))", values)
        assert found == [plain_number(one, count) for one in values]
    for places in range(-6, 4):
        found = page.evaluate(f"values => values.map((one) => fixedNumber(one, {places}))", values)
        wanted = [fixed_number(one, places, mark="") for one in values]
        # the language writes no powers of ten out, and a number that large has no places
        pairs = [pair for pair in zip(found, wanted, strict=True) if "e" not in pair[0]]
        assert len(pairs) >= len(values) - 1
        assert [one for one, _ in pairs] == [one for _, one in pairs]
    halves = [*(10 ** chance.uniform(-6, 10, len(values) - 3)).tolist(), 0.0, 1000.0, 999.9999999]
    pairs = list(zip(values, halves, strict=True))
    found = page.evaluate("pairs => pairs.map(([one, half]) => within(one, half, 7 * half))", pairs)
    assert found == [within(one, half, 7 * half) for one, half in pairs]
    found = page.evaluate("values => values.map(asGiven)", values)
    assert found == [as_given(one) for one in values]
    texts = [*found, *(f"{one} to {one}" for one in found)]
    shown = page.evaluate("texts => texts.map(grouped)", texts)
    assert [one.replace("\u202f", " ") for one in shown] == [grouped(one) for one in texts]
    # a half goes to the even digit at the command and up here: no more than the last digit
    ties = [0.5, 1.5, 2.5, 0.125, 0.375, 1234.5, 1235.5, 12345.5, 100002.5, 99999.5]
    for count in (2, 3, 4, 5):
        found = page.evaluate(f"values => values.map((one) => plainNumber(one, {count}))", ties)
        for one, value in zip(found, ties, strict=True):
            assert float(one) == pytest.approx(value, rel=0.51 * 10.0 ** (1 - count))


def test_the_factor_of_an_interval_is_that_of_the_package(small, visit):
    freedom = [*np.geomspace(0.5, 1e10, 400), 1.0, 2.0, 5.0, 1999.0, 2001.0]
    found = visit(small[0]).page.evaluate("all => all.map(coverageFactor)", freedom)
    assert found == pytest.approx(coverage_factor(freedom), rel=1e-8)
    beyond = np.maximum(freedom, 1.0)
    assert found == pytest.approx(stats.t.ppf(0.975, beyond), rel=1e-7)


def link(page, **state):
    text = "&".join(f"{name}={value}" for name, value in state.items())
    return f"{page.as_uri()}#{text}"


@pytest.mark.parametrize("width", [1280, 390])
@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_the_page_is_sound_for_everybody(small, visit, width, dark):
    shown = visit(small[0], width=width, dark=dark)
    shown.page.locator("#decks summary").click()
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
    shown.page.locator("#decks summary").click()
    assert "'processed/<h1>campaign</h1>/T<1>.nc'" in shown.page.locator("#export").inner_text()
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
    assert "OUTSIDE the tested range" in shown.page.locator(".flags").inner_text()
    shown.page.locator("#level-frequency").fill("fast")
    assert "frequency is not a number" in shown.page.locator("#said").inner_text()


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
    assert "No line matches all filters" in shown.page.locator("#said").inner_text()


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


def test_the_commands_of_a_deck_are_copied(small, visit):
    shown = visit(
        link(small[0], line="nylon-double-braid-0.5in-new"),
        permissions=["clipboard-read", "clipboard-write"],
    )
    shown.page.locator("#decks summary").click()
    shown.page.locator("#copy-export").click()
    shown.page.get_by_text("commands copied").wait_for()
    first, second, third = shown.page.evaluate("navigator.clipboard.readText()").splitlines()
    assert first.startswith("reduction export nylon-double-braid-0.5in-new --to moordyn ")
    assert "--form static-dynamic" in second and '--mean-tension "21 %RBS"' in second
    assert "--form load-dependent" in third
    shown.page.locator("#flag").check()
    shown.page.locator("#level-frequency").fill("0.4")
    changed = shown.page.locator("#export").inner_text().splitlines()
    assert '--frequency "0.4 Hz"' in changed[1] and "--extrapolate flag" in changed[1]
    assert changed[0] == first
    assert shown.errors == []


def test_levels_of_an_own_rope_are_the_table_of_the_command(campaigns, tmp_path, visit):
    """Without its experiment the nylon line is known where it was tested."""
    made = campaigns("nylon-synthetic").processed
    rope = tmp_path / "processed" / "rope"
    rope.mkdir(parents=True)
    for name in ("R01.nc", "R02.nc", "R05.nc", "R11.nc", "status.csv"):
        shutil.copy(made / name, rope)
    said = reduction("lookup", rope, "--list", "--units", "us").stdout
    heading = "Levels of line-1, known at tested levels and between two of them"
    _, _, table = said.partition(heading)
    wanted = [row.split() for row in table.splitlines() if row.startswith("R")]
    assert len(wanted) == 4
    shown = visit(write_design_page(tmp_path / "processed", tmp_path / "reports"))
    page = shown.page
    page.locator("input[name=units][value=us]").check()
    page.locator("#line").select_option("rope/R05 line-1")
    rows = page.get_by_role("region", name=heading).locator("tbody tr, table > tr")
    cells = rows.evaluate_all("all => all.map(one => [...one.cells].map(cell => cell.textContent))")
    found = [[cell.replace("\u202f", "") for cell in row] for row in cells[1:]]
    assert found == wanted
    assert shown.errors == []

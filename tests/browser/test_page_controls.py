"""The page under the fingers: folds, links, the filter of the contents, keys."""

import pytest

FOCUSED = """() => {
  const own = document.activeElement, look = getComputedStyle(own);
  return [own === document.body ? null : own.outerHTML.slice(0, 200),
          own.getClientRects().length > 0, look.outlineStyle, parseFloat(look.outlineWidth)];
}"""
CONTROLS = "a[href], button:not([disabled]), input, summary, [tabindex='0']"


@pytest.fixture
def shown(small, visit):
    return visit(small.page)


@pytest.mark.nightly
def test_every_control_is_reached_by_the_key_and_seen_when_it_is(shown):
    shown.open_section("T02.a")
    wanted = shown.page.evaluate(
        "controls => [...document.querySelectorAll(controls)]"
        ".filter(one => one.checkVisibility()).map(one => one.outerHTML.slice(0, 200))",
        CONTROLS,
    )
    reached, left = set(), 0
    # from where the link led to the end of the page, and from its top
    while left < 2:
        shown.page.keyboard.press("Tab")
        name, is_there, style, width = shown.page.evaluate(FOCUSED)
        if name is None:
            left += 1
            continue
        reached.add(_unmarked(name))
        assert is_there, name
        assert style != "none" and width >= 2, name
    assert len(wanted) > 40
    assert set(map(_unmarked, wanted)) <= reached


def _unmarked(control):
    """Without the mark of where a reader is, which follows the page as it moves."""
    return control.replace(' aria-current="true"', "")


@pytest.mark.nightly
def test_no_control_of_a_figure_sends_it_anywhere(shown):
    shown.drawn("campaign-moduli-0")
    names = shown.page.locator("#campaign-moduli-0 .modebar-btn").evaluate_all(
        "all => all.map(one => one.dataset.title)"
    )
    assert "Zoom in" in names
    assert not [name for name in names if "hare" in name or "loud" in name or "ownload" in name]


@pytest.mark.nightly
def test_a_fold_opens_by_its_link_by_an_address_and_by_a_key(shown, small, visit):
    fold = shown.page.locator("details.chapter", has=shown.page.locator("#test-1"))
    assert fold.get_attribute("open") is None
    fold.locator("> summary").press("Enter")
    assert fold.get_attribute("open") == ""
    fold.locator("> summary").press("Enter")
    shown.page.get_by_role("link", name="T02.a", exact=True).first.click()
    assert fold.get_attribute("open") == ""
    addressed = visit(f"{small.page.as_uri()}#test-2").page
    assert addressed.locator("details.chapter[open]").count() == 1
    assert addressed.locator("#test-2").is_visible()


@pytest.mark.nightly
def test_an_address_inside_a_fold_opens_it(small, visit):
    page = visit(f"{small.page.as_uri()}#test-1-record").page
    page.locator(
        "#test-1-record .js-plotly-plot, #test-1-record .plot.js-plotly-plot"
    ).first.wait_for()
    assert page.locator("#test-1-record").is_visible()


@pytest.mark.nightly
def test_one_button_opens_and_closes_all(shown):
    shown.page.get_by_role("button", name="Open all sections").click()
    assert shown.page.locator("details.chapter:not([open])").count() == 0
    shown.page.get_by_role("button", name="Close all sections").click()
    assert shown.page.locator("details.chapter[open]").count() == 0


@pytest.mark.nightly
def test_the_contents_mark_where_a_reader_is(shown):
    shown.open_section("T02.b")
    marked = shown.page.locator("nav [aria-current]")
    marked.filter(has_text="T02.b").wait_for()
    assert marked.count() == 1


@pytest.mark.nightly
def test_the_contents_of_a_long_page_are_searched(campaigns, visit):
    page = visit(campaigns("nylon-synthetic").page).page
    box = page.get_by_role("searchbox", name="Filter")
    box.fill("r1")
    links = page.locator("#contents a:visible")
    assert links.all_inner_texts() == [f"R{number}" for number in range(10, 16)]
    assert page.locator("#found").inner_text() == f"6 of {page.locator('#contents li').count()}"
    box.fill("quasi-static")
    assert links.all_inner_texts() == ["Q01"]
    box.press("Enter")
    assert page.locator("details.chapter[open] #test-0").is_visible()


@pytest.mark.nightly
def test_figures_follow_the_colours_of_the_screen(shown):
    plot = shown.drawn("campaign-moduli-0")
    shown.page.emulate_media(color_scheme="dark")
    shown.page.locator("#campaign-moduli-0 .main-svg[style*='rgb(20, 24, 28)']").first.wait_for()
    assert plot.evaluate("plot => plot.layout.paper_bgcolor") == "#14181c"
    assert shown.errors == []

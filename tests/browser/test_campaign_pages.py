"""The page of each campaign, as a browser shows it."""

import netCDF4
import numpy as np
import pytest
from pagefigures import figures_of

FIRST = {
    "tmt-synthetic": "T-1", "nylon-synthetic": "R01", "hose-synthetic": "Comparison H64-static",
    "buoy-technology-1997": "static",
}  # fmt: skip
LOOKS = {
    "tmt-synthetic": (1280, False), "nylon-synthetic": (390, True), "hose-synthetic": (1280, True),
    "buoy-technology-1997": (390, False),
}  # fmt: skip
# the smallest page by default; the others nightly
OFTEN = "buoy-technology-1997"
NAMES = [
    OFTEN,
    *(pytest.param(name, marks=pytest.mark.nightly) for name in FIRST if name != OFTEN),
]


@pytest.mark.parametrize("name", NAMES)
def test_a_page_opens_without_an_error_a_request_or_a_fault_for_those_who_see_less(
    name, campaigns, visit
):
    width, dark = LOOKS[name]
    shown = visit(campaigns(name).page, width=width, dark=dark)
    section = shown.open_section(FIRST[name])
    assert section.locator(".js-plotly-plot .trace, .js-plotly-plot .bars").count() > 0
    assert shown.page.evaluate("document.documentElement.scrollWidth") <= width
    assert shown.faults() == []
    assert shown.errors == []
    assert shown.beyond == []


@pytest.mark.parametrize("name", NAMES)
def test_every_figure_has_a_trace_with_points_and_the_page_stays_small(name, campaigns):
    page = campaigns(name).page
    assert page.stat().st_size < 15e6
    figures = figures_of(page)
    assert page.read_text(encoding="utf-8").count("data-figure=") == len(figures) > 0
    for key, figure in figures.items():
        points = [value for trace in figure["data"] for value in np.ravel(trace["y"]).tolist()]
        assert any(value is not None for value in points), key


@pytest.mark.nightly
def test_figures_in_space_are_drawn_and_make_room_for_others(campaigns, visit):
    shown = visit(campaigns("nylon-synthetic").page)
    spaces = shown.page.locator(".plot:has(canvas)")
    plot = shown.drawn("experiment-0-apparent_spring_constant-surface")
    plot.locator("canvas").first.wait_for()
    shown.page.evaluate("scrollTo({top: 0, behavior: 'instant'})")
    spaces.first.wait_for(state="detached")
    assert shown.errors == []


@pytest.mark.nightly
def test_sections_of_one_kind_are_folded_and_a_single_one_is_not(campaigns, visit):
    folded = visit(campaigns("tmt-synthetic").page).page
    assert folded.locator("details.chapter").count() == 10
    assert folded.locator("details.chapter[open]").count() == 0
    assert (
        "10 cycles, strain 77.3 to 128.9 %"
        in folded.locator("summary", has_text="T-1").first.inner_text()
    )
    assert folded.evaluate("document.documentElement.scrollHeight") < 20_000
    single = visit(campaigns("buoy-technology-1997").page).page
    assert single.locator("details.chapter").count() == 0
    assert single.locator("h3:visible").count() > 0


def test_the_answer_is_that_of_the_archives(campaigns, visit):
    made = campaigns("tmt-synthetic")
    rows = visit(made.page).page.evaluate(
        """[...document.querySelectorAll("section[aria-labelledby=answer] .table")][0]
           .querySelectorAll("tbody tr").values().map(row => [...row.cells].map(
             cell => [cell.textContent, cell.dataset.value])).toArray()"""
    )
    assert len(rows) >= 12
    for (specimen, _), (test, _), _, _, constant, _, whole, *branches, _, _ in rows:
        with netCDF4.Dataset(made.processed / f"{test}.nc") as archive:
            names = list(archive["specimen"][:])
            own = names.index(specimen)
            modulus = float(archive["cycles/test_dynamic_modulus"][own])
            force = float(archive["cycles/test_apparent_spring_constant"][own])
            middle = float(np.mean(archive["cycles/mean_strain"][own]))
            curves = np.ma.filled(archive["tangent_modulus"][own], np.nan)
            bins = archive["strain_bin"][:]
        assert float(constant[1]) == pytest.approx(force, rel=1e-12)
        assert float(whole[1]) == pytest.approx(modulus, rel=1e-12)
        assert shown_as(modulus / 1e6, whole[0])
        for (text, exact), curve in zip(branches, curves, strict=True):
            expected = float(np.interp(middle, bins, curve))
            assert np.isfinite(expected) == bool(exact)
            if exact:
                assert float(exact) == pytest.approx(expected, rel=2e-3)
                assert shown_as(float(exact) / 1e6, text)


def shown_as(value, text):
    """Whether a cell shows a value, to half of its last digit."""
    number, _, uncertainty = text.partition(" ± ")
    decimals = len(number.partition(".")[2])
    assert len(uncertainty.partition(".")[2]) == decimals
    return abs(float(number) - value) <= 0.5000001 * 10**-decimals

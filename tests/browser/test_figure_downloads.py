"""What a reader takes away from a figure: its data, a drawing, a picture."""

from xml.etree import ElementTree

import netCDF4
import numpy as np
import pytest
from pagefigures import figures_of, table_of, take

KEY = "test-0"


@pytest.fixture
def shown(small, visit):
    found = visit(small.page)
    found.open_section("T01")
    return found


def test_the_data_of_a_figure_have_units_and_the_numbers_of_the_archive(shown, small):
    name, content = take(shown, f"{KEY}-spring-constant", "CSV")
    assert name == "many_T01_spring-constant.csv"
    first, columns, rows = table_of(content)
    assert first[0].startswith("# SYNTHETIC DATA. T01: apparent spring constant. Many small tests")
    assert columns == ["line", "cycle number [1]", "apparent spring constant [N]"]
    with netCDF4.Dataset(small.processed / "T01.nc") as data:
        values = data["cycles/apparent_spring_constant"][0]
    lines = [row for row in rows if row[0] == "one"]
    assert [int(row[1]) for row in lines] == list(range(1, 13))
    assert [float(row[2]) for row in lines] == pytest.approx(values, rel=1e-5)
    upper, lower = (
        np.array([float(row[2]) for row in rows if row[0] == f"one, {edge} edge"])
        for edge in ("upper", "lower")
    )
    assert (upper + lower) / 2 == pytest.approx(np.array(values), rel=1e-5)


@pytest.mark.nightly
def test_everything_that_a_record_draws_is_in_its_data(shown, small):
    _, content = take(shown, f"{KEY}-record", "CSV")
    _, columns, rows = table_of(content)
    assert columns[:1] == ["line"]
    assert all("[" in name for name in columns[1:])
    figure = figures_of(small.page)[f"{KEY}-record"]
    points = sum(len(trace["x"]) for trace in figure["data"])
    assert len(rows) == points + 2 * len(figure["layout"]["shapes"])
    assert {row[0] for row in rows} >= {"crosshead position", "tension, one", "shading: cycling"}


@pytest.mark.nightly
def test_a_figure_is_saved_as_a_drawing_and_as_a_picture(shown):
    name, content = take(shown, f"{KEY}-modulus-0", "SVG")
    assert name == "many_T01_modulus-0.svg"
    drawing = ElementTree.fromstring(content)  # noqa: S314
    assert drawing.tag == "{http://www.w3.org/2000/svg}svg"
    words = " ".join(drawing.itertext())
    assert "T01: modulus, one" in words and "SYNTHETIC DATA" in words and "[MPa]" in words
    name, content = take(shown, f"{KEY}-modulus-0", "PNG")
    assert name == "many_T01_modulus-0.png"
    assert content[:8] == b"\x89PNG\r\n\x1a\n"
    width = int.from_bytes(content[16:20])
    assert width == 2 * 640
    assert shown.errors == []
    assert shown.beyond == []


@pytest.mark.nightly
def test_a_figure_that_was_not_drawn_yet_is_saved_too_and_what_was_switched_off_stays_off(shown):
    name, content = take(shown, "campaign-moduli-0", "SVG")
    assert name == "many_campaign-moduli-0.svg"
    assert content.startswith(b"<svg ")
    shown.drawn(f"{KEY}-spring-constant")
    _, whole = take(shown, f"{KEY}-spring-constant", "SVG")
    shown.page.evaluate(
        f"Plotly.restyle(document.querySelector('#{KEY}-spring-constant .plot'), {{visible: false}}, [1])"
    )
    _, content = take(shown, f"{KEY}-spring-constant", "SVG")
    assert [text.count(b'class="trace scatter') for text in (whole, content)] == [2, 1]


@pytest.mark.nightly
def test_a_figure_in_space_is_saved_as_all_others(campaigns, visit):
    shown = visit(campaigns("nylon-synthetic").page)
    key = "experiment-0-apparent_spring_constant-surface"
    name, content = take(shown, key, "CSV")
    assert name == "nylon-synthetic_Experiment-nylon_apparent_spring_constant-surface.csv"
    _, columns, rows = table_of(content)
    assert [one.partition(" [")[2] for one in columns[1:4]] == ["N]", "N]", "N]"]
    assert len(rows) > 100 and all(row[3] for row in rows[:50])
    # a surface in space is a picture inside its drawing, and says so; contours are lines
    button = shown.page.locator(f"#{key}").get_by_role("button", name="SVG: ")
    assert button.get_attribute("aria-label").startswith("SVG: picture inside a drawing of ")
    assert "(holds a picture)" in shown.page.locator(f"#{key} .save").inner_text()
    flat = key.replace("-surface", "-contour-1")
    assert "picture" not in shown.page.locator(f"#{flat} .save").inner_text()
    drawings = [take(shown, one, "SVG")[1] for one in (key, flat)]
    assert [one.count(b"<image") for one in drawings] == [1, 0]
    _, content = take(shown, key, "PNG")
    assert content[:8] == b"\x89PNG\r\n\x1a\n" and len(content) > 10_000
    assert shown.errors == []

"""A cycle chosen in one figure of a test is shown in the others."""

import pytest
from manytests import wait_for

from reduction.archive.open import open_archive

TEST = "T01"
KEY = "test-0"


@pytest.fixture
def shown(small, visit):
    found = visit(small.page)
    found.section = found.open_section(TEST)
    found.state = found.section.get_by_role("status")
    found.input = found.section.get_by_role("spinbutton", name="Cycle")
    return found


def layout(shown, figure):
    shown.drawn(f"{KEY}-{figure}")
    return shown.page.evaluate(
        "key => { const {shapes, annotations} = document.querySelector(key).layout;"
        " return {shapes: shapes ?? [], annotations: annotations ?? []}; }",
        f"#{KEY}-{figure} .plot",
    )


def marks(shown, figure):
    return [one for one in layout(shown, figure)["shapes"] if "cycle" in one.get("name", "")]


def choose(shown, number):
    shown.input.fill(str(number))
    shown.input.press("Enter")


def archive(small, *names):
    with open_archive(small.processed / f"{TEST}.nc") as data:
        return [data[name].to_numpy() for name in names]


@pytest.mark.nightly
def test_no_cycle_is_chosen_at_first_and_the_page_says_so(shown):
    assert shown.state.inner_text() == "No cycle selected (1 to 12)"
    assert shown.section.get_by_role("button", name="Clear").is_disabled()
    assert marks(shown, "record") == []


@pytest.mark.nightly
def test_a_cycle_typed_by_keyboard_is_shown_in_every_figure(shown, small):
    choose(shown, 6)
    start, last, time, stiffness = archive(
        small, "cycle_start_time", "cycle_last_sample", "time", "apparent_spring_constant"
    )
    begun, ended = start[0, 5], time[int(last[5])]
    assert shown.state.inner_text().startswith("Cycle 6 of 12, from ")
    (span,) = marks(shown, "record")
    assert [span["x0"], span["x1"]] == pytest.approx([begun, ended], abs=0.11)
    (line,) = marks(shown, "spring-constant")
    assert line["x0"] == line["x1"] == 6
    point = shown.page.evaluate(
        f"document.querySelector('#{KEY}-spring-constant .plot').data.at(-1)"
    )
    assert point["x"] == [6]
    assert point["y"] == pytest.approx([stiffness[0, 5]], rel=1e-5)
    shown.drawn(f"{KEY}-loops-0")
    widths = shown.page.evaluate(
        f"document.querySelector('#{KEY}-loops-0 .plot').data.map("
        "trace => [trace.meta.cycle, trace.line.width, trace.opacity ?? 1])"
    )
    assert {(cycle, width, opacity) for cycle, width, opacity in widths} == {
        (1, 1.6, 0.25), (6, 3, 1), (12, 1.6, 0.25),
    }  # fmt: skip
    assert shown.errors == []


@pytest.mark.nightly
def test_a_figure_says_when_the_chosen_cycle_is_not_drawn_in_it(shown):
    choose(shown, 5)
    shown.drawn(f"{KEY}-loops-0")
    lacks = shown.page.locator(f"#{KEY}-loops-0 .lacks")
    assert lacks.inner_text() == "Cycle 5 is not drawn here; drawn: 1, 6, 12."
    choose(shown, 12)
    lacks.wait_for(state="hidden")


def test_a_point_that_is_clicked_chooses_its_cycle_and_the_button_lets_it_go(shown):
    plot = shown.drawn(f"{KEY}-spring-constant")
    place = plot.evaluate(
        """plot => { const {xaxis, yaxis} = plot._fullLayout;
             const trace = plot.data.find(one => one.mode === "lines+markers");
             return {x: xaxis._offset + xaxis.c2p(trace.x[2]), y: yaxis._offset + yaxis.c2p(trace.y[2])}; }"""
    )
    plot.hover(position=place)
    plot.click(position=place)
    assert shown.state.inner_text().startswith("Cycle 3 of 12")
    assert shown.input.input_value() == "3"
    wait_for(lambda: len(marks(shown, "record")) == 1)
    shown.section.get_by_role("button", name="Clear").press("Enter")
    assert shown.state.inner_text() == "No cycle selected (1 to 12)"
    wait_for(lambda: marks(shown, "record") == [])


@pytest.mark.nightly
def test_the_span_that_is_clicked_in_the_record_chooses_its_cycle(shown, small):
    start, end = (archive(small, "cycle_start_time")[0][0, place] for place in (7, 8))
    plot = shown.drawn(f"{KEY}-record")
    # anywhere at that time, not at a point alone
    place = plot.evaluate(
        """(plot, time) => { const {xaxis, yaxis} = plot._fullLayout;
             return {x: xaxis._offset + xaxis.c2p(time), y: yaxis._offset + 5}; }""",
        float(start + end) / 2,
    )
    plot.hover(position=place)
    plot.click(position=place)
    assert shown.state.inner_text().startswith("Cycle 8 of 12")


@pytest.mark.nightly
def test_a_number_without_a_cycle_chooses_the_nearest_and_says_so(shown):
    choose(shown, 99)
    assert shown.state.inner_text().startswith("Cycle 12 of 12, from ")
    assert shown.state.inner_text().endswith("; 99 cannot be chosen here")


@pytest.mark.nightly
def test_another_test_keeps_its_own_choice(shown):
    choose(shown, 6)
    other = shown.open_section("T02.a")
    assert other.get_by_role("status").inner_text() == "No cycle selected (1 to 6)"
    assert shown.state.inner_text().startswith("Cycle 6 of 12")

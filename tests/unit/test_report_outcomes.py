"""Strength and life on the page: what stands in it, and that nothing stands without data."""

import pytest
from pagefigures import figures_of

from reduction.archive.campaign_products import outcomes_to_dataset
from reduction.archive.write import write_archive
from reduction.experiments.outcome_groups import Group
from reduction.experiments.outcomes import Outcome
from reduction.record.measurement import Origin, Source, Step
from reduction.report.campaign_page import write_report
from reduction.report.campaign_sections import _make_outcome_section
from reduction.report.outcome_tables import (
    draw_exposure,
    draw_lives,
    exposure_table,
    fatigue_table,
    load_life_table,
    snap_sentences,
    snap_table,
    strength_table,
)
from reduction.report.product_views import OutcomeView, group_names, line_of
from reduction.report.text_style import NOT_GIVEN

LBF = 4.4482216152605
# 6500 lbf - 600 lbf a year, and 100 lbf about it
BREAKS = [
    Outcome("tensile_strength", LBF * (6500 - 600 * years + about), line="PD", exposure=years,
            condition="worn" if years else "new")
    for years in (0.0, 2.0, 4.0)
    for about in (-100.0, 100.0)
]  # fmt: skip
SPLICE = Outcome("tensile_strength", 5000 * LBF, line="PD", exposure=2.0, condition="worn",
                 place="splice", is_valid=False)  # fmt: skip
CYCLES = [
    Outcome("cycles_to_failure", lives, line="N8", minimum_load_ratio=0.0, peak_load_ratio=load)
    for load, of_load in {0.7: (4e3, 5e3, 7e3), 0.5: (3e4, 4e4, 5e4)}.items()
    for lives in of_load
]
SURVIVED = [
    Outcome("cycles_to_failure", 2e5, line="N8", minimum_load_ratio=0.0, peak_load_ratio=0.27,
            is_suspended=True)
] * 3  # fmt: skip


def view(outcomes, synthetic="", units="us"):
    return OutcomeView(tuple(outcomes), {"synthetic": synthetic}, units)


def column(table, heading):
    place = next(i for i, name in enumerate(table.columns) if name.startswith(heading))
    return [row[place].text for row in table.rows]


def test_strength_has_its_change_against_new_with_an_interval():
    table = strength_table(view([*BREAKS, SPLICE]), "tensile_strength")
    assert column(table, "group") == ["PD, new, 0 years", "PD, worn, 2 years", "PD, worn, 4 years"]
    # two breaks 100 to either side of their mean: 100 of it, times 12.71 for one degree of freedom
    assert column(table, "mean tensile strength [lbf]")[0] == "6,500 ± 1,300"
    assert "k = " in table.remarks[0] and "12.71)" in table.remarks[0]
    assert column(table, "change against new [%]")[1].startswith("-18.5 ± ")
    assert " to " in column(table, "interval of the change")[1]
    assert column(table, "lower bounds") == [NOT_GIVEN, "1", NOT_GIVEN]


def test_a_column_in_which_nothing_stands_is_left_out():
    table = strength_table(view(BREAKS[:2]), "tensile_strength")
    assert not [name for name in table.columns if "change" in name or "bounds" in name]
    assert strength_table(view(BREAKS), "strain_at_failure") is None
    assert exposure_table(view(BREAKS[:2])) is None
    assert fatigue_table(view(BREAKS), "cycles_to_failure") is None
    assert load_life_table(view(BREAKS)) is None and snap_table(view(BREAKS)) is None


def test_what_is_missing_is_told_below_with_its_group():
    table = strength_table(view([BREAKS[0], *BREAKS[2:4]]), "tensile_strength")
    assert any(
        remark.startswith("PD, new, 0 years: fewer than two values") for remark in table.remarks
    )
    lives = fatigue_table(view([*CYCLES, *SURVIVED]), "cycles_to_failure")
    assert "N8 at 27 %: no failure: only a lower bound can be given." in lives.remarks


def test_a_level_without_failure_has_a_count_and_no_life():
    lives = fatigue_table(view([*CYCLES, *SURVIVED]), "cycles_to_failure")
    assert column(lives, "its interval")[0] == NOT_GIVEN
    assert " to " in column(lives, "its interval")[1]
    assert column(lives, "stopped") == ["3", NOT_GIVEN, NOT_GIVEN]


def test_strength_against_exposure_is_points_a_line_and_its_band():
    (figure,) = draw_exposure(view([*BREAKS, SPLICE], synthetic="yes"))
    names = [trace["name"] for trace in figure.data]
    assert names == ["95 % interval", "fitted line", "breaks", "at least"]
    line, breaks, bound = figure.data[1:]
    assert (line["x"][0], line["x"][-1]) == (0.0, 4.0)
    assert line["y"][0] == pytest.approx(6500) and line["y"][-1] == pytest.approx(4100)
    assert len(breaks["x"]) == 6 and bound["y"] == [5000.0]
    assert figure.layout["title"]["subtitle"]["text"] == "SYNTHETIC DATA"
    table = exposure_table(view(BREAKS))
    assert column(table, "change per year [lbf/year]")[0].startswith("-600 ± ")


def test_breaks_without_a_line_are_shown_and_the_reason_told():
    few = [BREAKS[0], BREAKS[2]]
    (figure,) = draw_exposure(view(few))
    assert [trace["name"] for trace in figure.data] == ["breaks"]
    assert (
        "PD: two exposures with one break each leave no scatter."
        in exposure_table(view(few)).remarks
    )


def test_run_outs_are_arrows_and_the_line_ends_at_the_loads_tested():
    (figure,) = draw_lives(view([*CYCLES, *SURVIVED]))
    traces = {trace["name"]: trace for trace in figure.data}
    assert list(traces) == ["95 % bounds", "median life", "failed", "at least"]
    assert traces["at least"]["marker"]["symbol"] == "arrow-up"
    assert traces["at least"]["x"] == [27.0] * 3 and traces["at least"]["y"] == [2e5] * 3
    assert (traces["median life"]["x"][0], traces["median life"]["x"][-1]) == (27.0, 70.0)
    assert figure.layout["yaxis"]["type"] == "log"


def test_conditions_of_a_line_share_a_figure_and_lines_do_not():
    worn = [Outcome("cycles_to_failure", 9e3, line="N8", condition="worn", peak_load_ratio=0.5)]
    other = [Outcome("cycles_to_failure", 9e3, line="PD", peak_load_ratio=0.5)]
    first, second = draw_lives(view([*CYCLES, *worn, *other]))
    assert "N8, worn: failed" in [trace["name"] for trace in first.data]
    assert [trace["name"] for trace in second.data] == ["failed"]


def test_where_failures_begin_is_said_for_lines_that_go_slack():
    table = snap_table(view([*CYCLES, *SURVIVED]))
    assert column(table, "peak load") == ["27.0", "50.0", "70.0"]
    # 1 - 0.05^(1/3)
    assert column(table, "share failing") == ["63", NOT_GIVEN, NOT_GIVEN]
    (sentence,) = snap_sentences(view([*CYCLES, *SURVIVED]))
    assert sentence.startswith("N8: no failure up to 27 %, the first at 50 %")
    below = [Outcome("cycles_to_failure", 9e3, line="N8", minimum_load_ratio=0.0,
                     peak_load_ratio=0.2)]  # fmt: skip
    only, note = snap_sentences(view([*SURVIVED, *below]))
    assert only.startswith("N8: the first at 20 %")
    assert note.startswith("N8: a line failed at 20 %")


def test_names_say_in_what_groups_differ():
    one = Group("", "nylon", "plaited", 0.0127, "new", None)
    two = Group("", "nylon", "plaited", 0.0254, "new", 1.0)
    assert group_names([one, two], "us") == ["nylon, 0.5 in", "nylon, 1 in, 1 year"]
    assert group_names([Group("", "", "", None, "", None)], "si") == ["not named"]
    assert group_names([], "si") == []
    assert line_of(two) == Group("", "nylon", "plaited", 0.0254, "", None)


def test_parts_without_data_are_left_out():
    section = _make_outcome_section(view(BREAKS[:2]))
    assert [part.heading for part in section.parts] == ["Strength"]
    assert section.subtitle == "2 outcomes without a log: 2 used as values"
    everything = _make_outcome_section(
        view([*BREAKS, SPLICE, *CYCLES, Outcome("abrasion_cycles", 7e3)])
    )
    assert [part.heading for part in everything.parts] == [
        "Strength", "Strength against exposure", "Cycles to failure", "Lines that go slack",
        "Abrasion",
    ]  # fmt: skip


@pytest.fixture
def page(tmp_path):
    dataset = outcomes_to_dataset(
        [*BREAKS, SPLICE, *CYCLES, *SURVIVED],
        origin=Origin(
            campaign_id="lines", attributes={"title": "Lines <b>&", "synthetic": "yes"},
            sources=(Source("results.csv", "ab" * 32, 1),), steps=(Step("outcomes", "rows"),),
            settings_json='{"results": "results.csv"}', version="1", command="",
        ),
    )  # fmt: skip
    write_archive(dataset, tmp_path / "lines" / "outcomes.nc")
    return lambda: write_report(tmp_path / "lines", tmp_path / "out", units="us")


def test_outcomes_alone_are_a_page_without_parts_of_tests(page):
    html = page().read_text(encoding="utf-8")
    assert '<h2 id="outcomes">Strength and life</h2>' in html
    assert 'id="tested"' not in html and 'href="#tested"' not in html
    assert "Lines &lt;b&gt;&amp;" in html and "Lines <b>" not in html
    assert "SYNTHETIC DATA" in html and "16 outcomes without a log" in html.replace(
        "<strong>16</strong>", "16"
    )
    assert "ab" * 32 in html  # the hash of the table of results


def test_the_same_archive_gives_the_same_page(page):
    assert page().read_bytes() == page().read_bytes()


def test_an_archive_that_cannot_be_read_is_told_and_not_shown(page, tmp_path):
    page()
    (tmp_path / "lines" / "outcomes.nc").write_bytes(b"no netCDF")
    html = page().read_text(encoding="utf-8")
    assert "outcomes.nc" in html and 'id="outcomes"' not in html


def test_figures_are_on_the_page_as_a_script_reads_them(page):
    assert figures_of(page())["outcomes-lives-0"]["data"]

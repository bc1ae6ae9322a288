"""What the page says of uncertainty: expanded, by source, and what is stated of the instruments."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from experiment_views import law_experiment, view_of
from reportparts import texts
from scipy import stats

from reduction.report.answer_tables import answer_budgets, budget_sentences, budget_table
from reduction.report.experiment_tables import (
    _expanded_of_coefficients,
    _interval_of_surfaces,
    _shared_by_runs,
    answer_table,
    surface_coefficient_table,
)
from reduction.report.figures.budget_figures import draw_budgets
from reduction.report.figures.cycle_figures import draw_amplitude_pairs
from reduction.report.figures.modulus_figures import draw_moduli
from reduction.report.product_views import expanded_of_runs
from reduction.report.test_section import _line_table, _summary_table, make_section, segment_table
from reduction.report.test_view import (
    NORMAL,
    NOTHING_STATED,
    TestView,
    expand,
    instrument_sentences,
    instrument_table,
    plus_minus_of_tests,
    shared_sources,
)
from reduction.report.text_style import NOT_GIVEN, Shown, bar_look, factors_of, in_order

STATED = {"tension_gain": 0.0025, "tension_offset": 2.0, "diameter": 1e-4, "lag": 0.005}
SOURCES = ("diameter", "strain_calibration", "strain_calibration", "tension_gain")
S, B, G = "specimen", "branch_name", "segment"
T_OF_9 = 2.2622  # of a table: 95 %, two-sided, nine degrees of freedom


def make_view(stated=STATED, *, is_old=False, units="si", test="T-1", sources=SOURCES):
    """Ten cycles; a segment of 1 MPa, scatter 3 kPa, diameter 4 kPa, tape 0 and 12 kPa."""
    modulus = np.array([[[1e6, np.nan], [2e6, 3e6]]])
    contribution = np.zeros((4, 1, 2, 2))
    contribution[:, 0, 0, 0] = [4e3, 0.0, 12e3, 0.0]
    contribution[:, 0, 1, 0] = [0.0, 0.0, 0.0, 4e3]
    random = np.full(modulus.shape, 3e3)
    both = np.sqrt(random**2 + np.sum(contribution**2, axis=0))
    dims, of_source = (S, B, G), "uncertainty_component"
    data = {
        "segment_modulus": (dims, modulus, {"units": "Pa"}),
        "segment_modulus_standard_uncertainty": (dims, random if is_old else both),
        "test_apparent_spring_constant": (S, [585.0], {"units": "N"}),
        "test_apparent_spring_constant_standard_uncertainty": (S, [5.0]),
        "peak_tension_per_decade": (S, [7.0]),
        "peak_tension_per_decade_standard_uncertainty": (S, [1.0]),
    }
    if not is_old:
        data |= {
            "segment_modulus_random_standard_uncertainty": (dims, random),
            "segment_modulus_uncertainty_contribution": ((of_source, *dims), contribution),
            "test_apparent_spring_constant_random_standard_uncertainty": (S, [3.0]),
            "test_apparent_spring_constant_uncertainty_contribution": (
                (of_source, S), [[0.0], [0.0], [0.0], [-4.0]],
            ),
            "uncertainty_source": (of_source, list(sources)),
            "uncertainty_source_of": (of_source, ["new", "new", "new", "load cell"]),
            "uncertainty_source_number": (of_source, [0, 0, 1, 0]),
        }  # fmt: skip
    return TestView(
        "test-0",
        xr.Dataset(
            data,
            coords={S: ["new"], B: ["ascending", "descending"], "cycle": np.arange(1, 11)},
            attrs={
                "test": test, "test_kind": "cyclic", "synthetic": "yes",
                "settings": json.dumps({} if stated is None else {"uncertainty": stated}),
            },
        ),
        units,
    )  # fmt: skip


def test_scatter_has_the_factor_of_its_degrees_of_freedom_and_what_is_shared_that_of_known_things():
    found = expand([1.0, 1.0, np.nan], random=[1.0, 0.0, 1.0], degrees_of_freedom=9.0)
    assert found.factor[:2] == pytest.approx([T_OF_9, 1.95996], abs=1e-4)
    assert found.half[:2] == pytest.approx([T_OF_9, 1.95996], abs=1e-4)
    assert len(found.factors) == 2


def test_a_segment_is_shown_with_its_expanded_uncertainty_and_k():
    table = segment_table([make_view()])
    # sqrt(3^2 + 4^2 + 12^2) = 13; 9 (13/3)^4 degrees of freedom are as good as many
    place = table.columns.index("segment modulus [MPa]")
    assert texts(table)[0][place] == "1.000 ± 0.025"
    # sqrt(3^2 + 4^2) = 5, of 9 (5/3)^4 = 69.4 degrees of freedom
    assert texts(table)[1][place] == "2.0000 ± 0.0100"
    assert factors_of(table.rows[:2]) == pytest.approx(
        stats.t.ppf(0.975, [9 * (13 / 3) ** 4, 9 * (5 / 3) ** 4]), rel=1e-9
    )
    assert table.remarks == (
        "±: expanded uncertainty, 95 % (k = 1.96 to 2.26): scatter between cycles, noise,"
        " regression; and errors common to all samples: tension gain, strain calibration, diameter.",
    )


def test_an_archive_that_keeps_no_shared_errors_still_renders_and_says_what_it_holds():
    old = make_view(None, is_old=True)
    table = segment_table([old])
    assert texts(table)[0][4] == "1.0000 ± 0.0068"  # 2.2622 times 3 kPa
    assert table.remarks[0].endswith(NOTHING_STATED.replace(" and tape readings", ""))
    assert answer_budgets(old) == [] and budget_sentences(old, []) == []
    assert budget_table([]) is None
    assert all("uncertainty" not in part.heading for part in make_section(old).parts)


def test_the_words_under_a_table_are_true_of_what_is_stated_and_of_what_reaches_it():
    only_tape = make_view(None, sources=("splice_method", *["strain_calibration"] * 3))
    said = segment_table([only_tape]).remarks[0]
    assert said.endswith(f"all samples: strain calibration, splice method. {NOTHING_STATED}")
    stated = make_view()
    zero = stated.data["test_apparent_spring_constant_uncertainty_contribution"] * 0.0
    nothing = TestView(
        "k", stated.data.assign(test_apparent_spring_constant_uncertainty_contribution=zero)
    )
    name = "test_apparent_spring_constant"
    assert plus_minus_of_tests([2.0], [nothing], [name]).endswith(
        "No stated instrument error affects it."
    )
    assert plus_minus_of_tests([2.0], [stated], ["peak_tension_per_decade"]).endswith(
        "Not included: errors of the instruments."
    )
    assert shared_sources([stated], [name]) == ["tension_gain"]


def test_means_say_which_of_them_hold_scatter_alone():
    table = _summary_table(make_view())
    assert table.remarks[1] == "For peak tension per decade of cycles, ± is the scatter alone."
    # a line over ten cycles: t of eight degrees of freedom is 2.306
    assert texts(table)[1] == ["peak tension per decade of cycles [N]", "7.0 ± 2.3"]


def test_the_budget_of_each_answer_adds_up_and_one_source_is_one_piece():
    answers = answer_budgets(make_view())
    assert [one.words for one in answers] == [
        "segment 1, ascending", "segment 1, descending", "segment 2, descending", "K_ap",
    ]  # fmt: skip
    # 169 = 9 of scatter + 16 of the diameter + 144 of the tape
    assert answers[0].share("strain_calibration") == pytest.approx(144 / 169)
    assert answers[0].in_words() == "strain calibration 85 %, diameter 9 %, random 5 %"
    assert answers[3].share("tension_gain") == pytest.approx(16 / 25)
    for one in answers:
        assert sum(one.share(name) for name in in_order(set(SOURCES) | {"random"})) == (
            pytest.approx(1)
        )


def test_where_linear_propagation_bends_the_interval_by_monte_carlo_stands_instead():
    view = make_view()
    name = "test_relaxation_time"
    data = view.data.assign({
        name: (S, [4.81], {"units": "s"}),
        f"{name}_standard_uncertainty": (S, [0.68]),
        f"{name}_random_standard_uncertainty": (S, [0.01]),
        f"{name}_uncertainty_contribution": (("uncertainty_component", S), [[0], [0], [0], [0.6]]),
        f"{name}_low": (S, [3.816]),
        f"{name}_high": (S, [6.482]),
        "test_line_uncertainty_method": (S, [2]),
    })  # fmt: skip
    drawn = TestView("test-0", data)
    table = _line_table(drawn)
    place = next(k for k, text in enumerate(table.columns) if text.startswith("tau"))
    assert texts(table)[0][place] == "4.8 (3.8 to 6.5)"
    assert any("Monte Carlo" in text for text in table.remarks)
    answers = answer_budgets(drawn)
    assert answers[-1].text == "4.8 (3.8 to 6.5) s"
    budget = budget_table(answers)
    assert texts(budget)[-1][1:4] == ["4.8 (3.8 to 6.5)", "s", NOT_GIVEN]
    assert any("Shares are of first order" in text for text in budget.remarks)
    linear = TestView("test-0", data.assign(test_line_uncertainty_method=(S, [1])))
    assert "±" in texts(_line_table(linear))[0][place]
    assert not any("Monte Carlo" in text for text in _line_table(linear).remarks)


def test_bars_are_stacked_in_one_order_with_one_look_a_source_and_can_be_heard():
    view = make_view()
    (figure,) = draw_budgets(view, answer_budgets(view))
    assert [trace["name"] for trace in figure.data] == [
        "random", "tension gain", "strain calibration", "diameter",
    ]  # fmt: skip
    total = np.sum([trace["x"] for trace in figure.data], axis=0)
    assert total == pytest.approx([100, 100, 100, 100], abs=0.1)
    assert figure.data[1]["marker"]["color"] == bar_look("tension_gain")["color"]
    assert figure.layout["yaxis"]["ticktext"][0] == "segment 1, ascending<br>1.000 ± 0.025 MPa"
    assert "K_ap: tension gain 64 %, random 36 %." in figure.label
    assert "SYNTHETIC" in figure.layout["title"]["subtitle"]["text"]
    assert "Hatched" not in figure.caption
    looks = {(bar_look(name)["color"], bar_look(name)["pattern"]["shape"]) for name in SOURCES}
    assert len(looks) == len(set(SOURCES))


def test_hatching_is_explained_where_it_is_and_an_unknown_source_has_a_look_and_a_place():
    view = make_view(sources=("diameter", "tension_offset", "what_is_new", "tension_gain"))
    (figure,) = draw_budgets(view, answer_budgets(view))
    assert [trace["name"] for trace in figure.data][-1] == "what is new"
    assert "Hatched" in figure.caption


def test_the_numbers_of_the_bars_stand_in_a_table_with_their_meanings():
    view = make_view(units="us")
    table = budget_table(answer_budgets(view))
    assert table.columns[:5] == ("number", "value", "unit", "k", "random [%]")
    assert texts(table)[3] == ["K_ap, new", "131.5 ± 2.2", "lbf", "1.99", "36.0", "64.0", "0.0",
                               "0.0"]  # fmt: skip
    assert "fit to the readings at the splice marks" in table.remarks[1]
    part = next(one for one in make_section(view).parts if "uncertainty" in one.heading)
    assert part.folded is not None and part.folded.tables
    assert part.sentences == ()


def test_a_bar_without_instruments_says_that_nothing_is_stated_of_them():
    view = make_view({"tension_gain": 0.0, "has_one_load_cell": True})
    assert budget_sentences(view, answer_budgets(view)) == [NOTHING_STATED]
    assert instrument_sentences([view]) == [NOTHING_STATED]
    assert instrument_sentences([]) == []
    assert instrument_table([view], "si") is None


def test_what_is_stated_of_the_instruments_stands_in_the_units_of_the_page():
    table = instrument_table([make_view(), make_view(test="T-2")], "us")
    assert texts(table) == [
        ["gain of tension [%]", "0.250"],
        ["zero of tension [lbf]", "0.450"],
        ["lag between the channels [ms]", "5.00"],
        ["mean diameter [in]", "0.00394"],
    ]
    assert "treated as exact" in table.remarks[0]
    assert instrument_sentences([make_view()]) == []


def test_tests_that_were_reduced_with_other_statements_have_a_column_each():
    other = make_view(STATED | {"tension_gain": 0.01, "has_one_load_cell": True}, test="T-2")
    silent = make_view(None, test="T-3")
    table = instrument_table([make_view(), other, silent], "si")
    assert table.columns == ("error", "T-1", "T-2")
    assert texts(table)[0] == ["gain of tension [%]", "0.250", "1.00"]
    assert "All tension channels share one load cell." in table.remarks
    assert any(text.startswith("Nothing is stated for T-3") for text in table.remarks)


def with_curve(view, *, is_old=False):
    modulus = np.full((1, 2, 3), 1e6)
    name, dims = "tangent_modulus", (S, B, "strain_bin")
    data = {
        name: (dims, modulus),
        f"{name}_standard_uncertainty": (dims, np.full(modulus.shape, 3e4 if is_old else 5e4)),
        f"{name}_count": (dims, np.full(modulus.shape, 10)),
        f"{name}_minimum": (dims, modulus - 1e5),
        f"{name}_maximum": (dims, modulus + 1e5),
    }
    if not is_old:
        rows = np.zeros((4, 1, 2, 3))
        rows[0] = 4e4
        data |= {
            f"{name}_random_standard_uncertainty": (dims, np.full(modulus.shape, 3e4)),
            f"{name}_uncertainty_contribution": (("uncertainty_component", *dims), rows),
        }
    bins = {"strain_bin": [0.9, 1.0, 1.1]}
    return TestView("test-0", view.data.assign(data).assign_coords(bins), view.units)


def test_the_inner_band_is_scatter_the_outer_one_all_and_the_caption_says_so():
    (figure,) = draw_moduli(with_curve(make_view()))
    traces = {trace["name"]: trace for trace in figure.data}
    inner, outer = (traces[f"ascending: mean ± {kind}"] for kind in ("scatter", "all"))
    assert max(y for y in inner["y"] if y is not None) == pytest.approx(1 + 0.03 * T_OF_9, abs=1e-4)
    k = stats.t.ppf(0.975, 9 * (5 / 3) ** 4)
    assert max(y for y in outer["y"] if y is not None) == pytest.approx(1 + 0.05 * k, abs=1e-5)
    assert (
        "Inner band: scatter between cycles, noise, regression alone (k = 2.26)" in figure.caption
    )
    assert "outer band, ±: expanded uncertainty, 95 % (k = 1.99)" in figure.caption
    assert "diameter" in figure.caption
    assert traces["ascending: least to greatest"]["visible"] == "legendonly"


def test_where_scatter_is_all_there_is_one_band():
    (figure,) = draw_moduli(with_curve(make_view(None, is_old=True), is_old=True))
    assert "Inner" not in figure.caption
    assert "Band, ±: expanded uncertainty, 95 % (k = 2.26)" in figure.caption
    traces = {trace["name"]: trace for trace in figure.data}
    ends = [traces[f"ascending: mean ± {kind}"]["y"] for kind in ("scatter", "all")]
    assert ends[0] == ends[1]


def test_upright_bars_are_expanded():
    view = make_view()
    data = view.data.assign(
        test_mean_strain=(S, [1.0]), test_strain_amplitude=(S, [0.2]),
        test_loss_factor=(S, [0.1]), test_loss_factor_standard_uncertainty=(S, [0.01]),
    )  # fmt: skip
    (figure,) = draw_amplitude_pairs([TestView("k", data)])
    assert figure.data[0]["error_y"]["array"] == pytest.approx([0.01 * T_OF_9], rel=1e-4)
    assert "(k = 2.26)" in figure.caption


def test_a_coefficient_holds_what_the_runs_share_and_shows_it_beside():
    result = law_experiment({"apparent_spring_constant": lambda f, m, a: 1000 + 50 * f + 200 * m})
    plain = view_of(result)
    surfaces = plain.surfaces
    random = surfaces.coefficient_standard_uncertainty[0]
    n_terms = random.size
    name = "apparent_spring_constant_coefficient"
    rows = np.zeros((1, 2, n_terms))
    rows[0, 0, 0], rows[0, 1, 0] = 3.0, -4.0
    view = shared_view(plain, {name: rows})
    spread = _expanded_of_coefficients(view, surfaces, 0)
    freedom = float(surfaces.term_degrees_of_freedom[0, 0])
    total = np.hypot(random[0], 5.0)
    k = stats.t.ppf(0.975, freedom * (total / random[0]) ** 4)
    assert spread.all.half[0] == pytest.approx(k * total)
    assert spread.shared[0] == pytest.approx(k * 5.0)
    assert spread.shared[1:].max() == 0
    assert spread.all.half[1] == pytest.approx(stats.t.ppf(0.975, freedom) * random[1])
    assert _shared_by_runs(view, surfaces) == ["tension_gain", "lag"]
    table = surface_coefficient_table(view, surfaces, 0)
    assert table.columns[3] == "shared part of ±, coded [N]"
    assert any("tension gain, lag" in text for text in table.remarks)
    low, high = _interval_of_surfaces(view, surfaces, np.zeros((1, 3)))
    assert (high - low)[0, 0] / 2 == pytest.approx(k * total, rel=1e-6)
    answer = answer_table(view, surfaces)
    ends = [float(end) for end in answer.rows[0][2].value.split()]
    assert ends == [low[0, 0], high[0, 0]]
    assert "tension gain, lag. Not included: differences between lines" in answer.remarks[0]


def test_surfaces_that_know_nothing_shared_have_no_such_column():
    view = view_of(law_experiment({"apparent_spring_constant": lambda f, m, a: 1000 + 50 * f}))
    bare = shared_view(view, {})
    table = surface_coefficient_table(bare, bare.surfaces, 0)
    assert not any("shared" in name for name in table.columns)
    low, high = _interval_of_surfaces(bare, bare.surfaces, np.zeros((1, 3)))
    k = stats.t.ppf(0.975, bare.surfaces.term_degrees_of_freedom[0].min())
    random = bare.surfaces.coefficient_standard_uncertainty[0, 0]
    assert (high - low)[0, 0] / 2 == pytest.approx(k * random, rel=1e-6)
    assert "errors common to all runs: calibration" in answer_table(bare, bare.surfaces).remarks[0]


def shared_view(view, rows):
    """The same experiment with contributions of a gain and of a lag, or with none."""
    kept = [
        name for name in view.data.variables
        if "contribution" not in str(name) and not str(name).startswith("uncertainty_")
    ]  # fmt: skip
    data = view.data[kept]
    for name, values in rows.items():
        data[f"{name}_uncertainty_contribution"] = (
            ("experiment", "uncertainty_component", "term"), values,
        )  # fmt: skip
    if rows:
        data["uncertainty_source"] = (
            ("experiment", "uncertainty_component"), [["tension_gain", "lag"]],
        )  # fmt: skip
    return type(view)(view.key, data, view.index, view.units)


def test_a_run_that_is_a_test_has_the_uncertainty_of_its_archive():
    view = view_of(law_experiment({"apparent_spring_constant": lambda f, m, a: 1000 + 50 * f}))
    names = view.texts("run_name")
    specimen = view.texts("run_specimen")[0]
    own = make_view().data.assign_coords({S: [specimen]})
    found = expanded_of_runs(view, "apparent_spring_constant", {names[0]: TestView("k", own)})
    # 3 of scatter and 4 of the gain are 5
    assert found.half[0] == pytest.approx(5 * stats.t.ppf(0.975, 9 * (5 / 3) ** 4))
    given = view.per_run("apparent_spring_constant_measured_standard_uncertainty")
    assert found.half[1:] == pytest.approx(NORMAL * given[1:], nan_ok=True)
    elsewhere = SimpleNamespace(array=lambda _: np.array([1.0]), specimens=("another",))
    same = expanded_of_runs(view, "apparent_spring_constant", {names[0]: elsewhere})
    assert same.half[0] == pytest.approx(NORMAL * given[0], nan_ok=True)


def test_words_of_a_bar_are_broken_and_the_figure_grows_with_their_lines():
    answers = answer_budgets(make_view())
    (short,) = draw_budgets(make_view(), answers)
    long = [replace(one, words=f"B9, {one.words} by tension amplitude") for one in answers]
    (tall,) = draw_budgets(make_view(), long)
    assert all(text.count("<br>") == 2 for text in tall.layout["yaxis"]["ticktext"])
    assert tall.height - short.height == 17 * len(answers)


def test_a_number_without_a_unit_has_none_behind_it():
    (one, *_) = answer_budgets(make_view())
    assert replace(one, unit=Shown("1", 1.0)).text.split(" ± ")[1].count(" ") == 0
    assert one.text.endswith(f" {one.unit.unit}")

"""Pieces of a composite from archives that are made here, variable by variable."""

import numpy as np
import pytest
import xarray as xr
from refusals import refusals

from reduction.archive.variables import note_values
from reduction.lines.archive_pieces import (
    _pieces_of_test,
    check_words,
    source_of_tests,
    specimens_of,
)
from reduction.lines.composite import CompositeRule, compose, used_of
from reduction.record.errors import DataError, SettingsError
from reduction.record.notes import Note

BINS = np.array([0.5, 0.6, 0.7, 0.8])
COEFFICIENTS = {
    "relaxed_free_length": 2.5, "relaxed_splice_length": 1.2, "splice_compliance": 1e-3,
    "splice_exponent": 0.8,
}  # fmt: skip


def cyclic(test="T-1", order=1, specimens=("new",), factor=1.0, coefficients=None, **more):
    """A test with cycles and a first rise, straight lines of 100 and 120 N per unit strain."""
    n = len(specimens)
    load = factor * np.stack([110 * BINS, 90 * BINS])
    early = np.array([0.1, 0.2, 0.3])
    rise = np.stack([120 * early, np.full(3, np.nan)])
    branch = ("specimen", "branch_name", "strain_bin")
    first = ("specimen", "branch_name", "first_loading_strain_bin")
    known = COEFFICIENTS | (coefficients or {})
    return xr.Dataset(
        {
            "specimen": ("specimen", list(specimens)),
            "strain_bin": BINS,
            "first_loading_strain_bin": early,
            "branch_tension": (branch, np.stack([load] * n)),
            "branch_tension_standard_uncertainty": (branch, np.ones((n, 2, 4))),
            "branch_tension_first_loading": (first, np.stack([rise] * n)),
            "branch_tension_first_loading_standard_uncertainty": (first, np.ones((n, 2, 3))),
            "diameter": ("specimen", np.full(n, more.get("diameter", 0.02))),
            "n_slips": ("specimen", np.full(n, more.get("slips", 0))),
            "strain_method": ("specimen", ["tension-driven"] * n),
            "strain_marks_from": ("specimen", ["this test"] * n),
            **{name: ("specimen", np.full(n, value)) for name, value in known.items()},
        },
        attrs={
            "test": test, "id": f"{more.get('campaign', 'c')}/{test}", "test_order": str(order),
            "campaign": more.get("campaign", "c"), "test_kind": "cyclic", "synthetic": "yes",
        } | ({"part_of": more["part_of"]} if "part_of" in more else {}),
    )  # fmt: skip


def hold():
    return xr.Dataset(
        {"specimen": ("specimen", ["new"])},
        attrs={"test": "held", "id": "c/held", "test_kind": "relaxation", "campaign": "c"},
    )


def pull(n=3):
    """Strain 0.01 per 100 N, known to 1e-4."""
    load = 100.0 * np.arange(1, n + 1)
    over = ("specimen", "tension_grid")
    early = ("specimen", "branch_name", "first_loading_strain_bin")
    return xr.Dataset(
        {
            "specimen": ("specimen", ["new"]),
            "tension_grid": load,
            "quasi_static_strain": (over, [1e-4 * load]),
            "quasi_static_strain_standard_uncertainty": (over, [np.full(n, 1e-4)]),
            "first_loading_strain_bin": [0.01, 0.02],
            "branch_tension_first_loading": (early, np.full((1, 2, 2), 150.0)),
            "branch_tension_first_loading_standard_uncertainty": (early, np.ones((1, 2, 2))),
        },
        attrs={"test": "Q", "id": "c/Q", "test_kind": "quasi-static", "campaign": "c"},
    )


@pytest.mark.parametrize(
    ("branch", "slope"), [("ascending", 110), ("descending", 90), ("mean", 100)]
)
def test_a_test_with_cycles_gives_its_branch_and_its_first_rise(branch, slope):
    found = _pieces_of_test(cyclic(), "new", branch=branch, name="T-1")
    assert found[0].tension == pytest.approx(slope * BINS)
    assert [one.kind for one in found] == ["cyclic"] + (branch != "descending") * ["first-loading"]
    for rise in found[1:]:
        assert rise.branch == "ascending"
        assert rise.tension == pytest.approx([12, 24, 36])


def test_a_slow_pull_is_static_and_its_first_rise_is_not_taken_twice():
    (found,) = _pieces_of_test(pull(), "new", branch="mean", name="Q")
    assert (found.kind, found.branch) == ("static", "ascending")
    assert found.tension == pytest.approx([100, 200, 300])
    assert found.random_standard_uncertainty == pytest.approx([1.0] * 3)
    assert _pieces_of_test(pull(), "new", branch="descending", name="Q") == ()


def weights(branch):
    """100 N per unit strain on the way up, 80 N on the way down; the third row contradicts itself."""
    n = len(branch)
    strain = np.array([0.5, 1.0, 1.2, 1.5, 1.0, 0.5])[:n]
    slope = np.where(np.array(branch) == 1, 100.0, 80.0)
    reading = {"secant_modulus": slope, "secant_modulus_standard_uncertainty": 0.01 * slope}
    same = {name: np.zeros(n) for name in
            ("time", "gauge_length", "eye_to_eye_length", "printed_strain")}  # fmt: skip
    between = {name: np.zeros(n - 1) for name in
               ("interval_strain", "interval_modulus", "interval_modulus_standard_uncertainty")}  # fmt: skip
    return xr.Dataset(
        {
            "specimen": ("specimen", ["new"]),
            "clock": ("step", ["1200"] * n),
            "strain": ("step", strain),
            "tension": ("step", slope * strain),
            "branch": ("step", np.array(branch)),
            "step_flag": ("step", np.array([0, 0, 1, 0, 0, 0])[:n]),
            **{name: ("step", values) for name, values in (reading | same).items()},
            **{name: ("interval", values) for name, values in between.items()},
            "interval_branch": ("interval", np.ones(n - 1, dtype=int)),
            "relaxed_gauge_length": 0.15,
            "relaxed_gauge_length_standard_uncertainty": 0.001,
        },
        attrs={"test": "S", "id": "c/S", "test_kind": "stepwise", "campaign": "c"},
    )


def with_cell(dataset, name, table, random, sources=("tension_gain", "lag")):
    """The same archive with rows of shared errors to one curve, of half the random part."""
    dims = dataset[name].dims
    one = "uncertainty_component"
    return dataset.assign(
        {
            f"{name}_uncertainty_contribution": ((one, *dims), table),
            f"{name}_random_standard_uncertainty": (dims, random),
            "uncertainty_source": (one, list(sources)),
            "uncertainty_source_of": (one, ["cell A"] * len(sources)),
            "uncertainty_source_number": (one, np.zeros(len(sources), dtype=int)),
        }
    )


def test_both_branches_of_a_test_share_the_gain_of_its_cell_and_not_its_scatter():
    plain = cyclic()
    load = plain["branch_tension"].values
    lag = np.broadcast_to(np.array([-2.0, 2.0])[:, None], load.shape[1:])[None]
    found = with_cell(
        plain, "branch_tension", np.stack([0.1 * load, lag]), np.full(load.shape, 0.4)
    )
    pieces = _pieces_of_test(found, "new", branch="mean", name="T-1")
    mean, first = pieces
    assert [(one.source, one.of) for one in mean.component] == [
        ("tension_gain", "cell A"), ("lag", "cell A"),
    ]  # fmt: skip
    assert mean.contribution == pytest.approx(np.stack([0.1 * mean.tension, np.zeros(4)]))
    assert mean.random_standard_uncertainty == pytest.approx(np.full(4, 0.4 / np.sqrt(2)))
    # the first rise of this archive has none: its whole uncertainty is its own
    assert first.component == ()
    assert first.random_standard_uncertainty == pytest.approx(np.ones(3))
    assert source_of_tests([found], "new", branch="mean").notes == ()


def test_a_slow_pull_and_weights_bring_what_they_share():
    plain = pull()
    strain = plain["quasi_static_strain"].values
    found = with_cell(
        plain,
        "quasi_static_strain",
        -0.01 * strain[None],
        np.full(strain.shape, 1e-5),
        ["tension_gain"],
    )
    (piece,) = _pieces_of_test(found, "new", branch="mean", name="Q")
    assert piece.contribution == pytest.approx(0.01 * piece.tension[None])
    assert piece.random_standard_uncertainty == pytest.approx([0.1] * 3)
    plain = weights([1, 1, 1, 1, 2, 2])
    slope = plain["secant_modulus"].values
    found = with_cell(
        plain, "secant_modulus", np.stack([0.01 * slope, 0.05 * slope]), 0.002 * slope,
        ["tension_gain", "diameter"],
    )  # fmt: skip
    (mean,) = _pieces_of_test(found, "new", branch="mean", name="S")
    assert [one.source for one in mean.component] == ["tension_gain"]
    assert mean.contribution == pytest.approx(0.01 * mean.tension[None])


def test_weights_give_either_branch_and_the_mean_where_both_were_read():
    found = weights([1, 1, 1, 1, 2, 2])
    (up,) = _pieces_of_test(found, "new", branch="ascending", name="S")
    assert (up.kind, up.strain.tolist()) == ("static", [0.5, 1.0, 1.5])
    assert up.tension == pytest.approx([50, 100, 150])
    assert up.random_standard_uncertainty == pytest.approx([0.5, 1.0, 1.5])
    (mean,) = _pieces_of_test(found, "new", branch="mean", name="S")
    assert mean.branch == "mean"
    assert mean.tension == pytest.approx(90 * mean.strain)
    assert (mean.strain[0], mean.strain[-1]) == (0.5, 1.0)


def test_weights_that_were_never_taken_off_stand_for_the_mean_by_their_own_name():
    (only,) = _pieces_of_test(weights([1, 1, 1, 1]), "new", branch="mean", name="S")
    assert only.branch == "ascending"


def test_tests_come_in_the_order_in_which_they_were_run():
    tests = [cyclic("T-2", 10), cyclic("T-1", 9)]
    found = source_of_tests(tests, "new", branch="ascending")
    assert [one.name for one in found.pieces] == ["T-1", "T-1", "T-2", "T-2"]
    assert [text.split(",")[0] for text in found.sources] == ["archive c/T-1", "archive c/T-2"]
    assert found.is_synthetic and found.diameter == 0.02
    assert np.isnan(found.rated_break_strength)
    assert found.model.coefficients == COEFFICIENTS


def test_what_is_left_out_is_said():
    tests = [cyclic(), cyclic("T-1-end", 2, part_of="T-1"), hold(), cyclic("T-2", 3, slips=2)]
    found = source_of_tests(tests, "new", branch="mean")
    assert {one.name for one in found.pieces} == {"T-1", "T-2"}
    assert set(found.notes) == {
        "T-1-end is left out: it is a part of T-1",
        "held (relaxation) has no mean curve",
        "T-2: the splices slipped 2 times, and the strain includes the slip",
    }


def test_one_synthetic_test_makes_the_curve_synthetic():
    real = cyclic("T-2", 2)
    real.attrs["synthetic"] = "no"
    assert source_of_tests([cyclic(), real], "new", branch="mean").is_synthetic
    assert not source_of_tests([real], "new", branch="mean").is_synthetic


def test_a_part_whose_whole_is_not_there_is_taken():
    found = source_of_tests([cyclic("T-1-end", part_of="T-1")], "new", branch="mean")
    assert found.pieces[0].name == "T-1-end"


def test_strain_models_that_differ_are_told():
    tests = [cyclic(), cyclic("T-2", 2, coefficients={"splice_exponent": 0.9})]
    found = source_of_tests(tests, "new", branch="mean")
    assert found.model.coefficients["splice_exponent"] == 0.8
    assert "different strain models; lengths follow that of c/T-1" in found.notes[-1]


def test_tests_of_two_campaigns_keep_their_campaigns_names():
    found = source_of_tests([cyclic(), cyclic("T-1", 2, campaign="d")], "new", branch="descending")
    assert [one.name for one in found.pieces] == ["c/T-1", "d/T-1"]


def test_one_log_in_two_campaigns_is_doubted():
    other = cyclic("again", 2, campaign="d")
    for one, log in ((other, "ab12"), (first := cyclic(), "ab12"), (third := cyclic("T-3", 3), "")):
        one.attrs["raw_file_sha256"] = log
    notes = source_of_tests([first, other, third], "new", branch="mean").notes
    assert [one for one in notes if "same log" in one] == [notes[0]]
    assert notes[0].startswith("DOUBTFUL: c/T-1 and d/again come from the same log")
    other.attrs["campaign"] = "c"  # a log with several tests is one campaign's
    assert source_of_tests([first, other], "new", branch="mean").notes == ()


def test_archives_without_the_specimen_are_passed_over():
    tests = [cyclic(), cyclic("T-2", 2, specimens=("used",))]
    assert specimens_of(tests[1]) == ("used",)
    assert specimens_of(xr.Dataset()) == ()
    found = source_of_tests(tests, "new", branch="mean")
    assert {one.name for one in found.pieces} == {"T-1"}
    assert found.notes == ("of other specimens: c/T-2",)


def stated(dataset, **words):
    return dataset.assign({f"specimen_{name}": ("specimen", [one]) for name, one in words.items()})


def test_specimens_of_one_name_and_two_makes_are_refused_and_two_conditions_are_doubted():
    """Two campaigns may each have a specimen of this name."""
    pair = cyclic(), cyclic("T-2", 2)
    ropes = [
        stated(one, material=name) for one, name in zip(pair, ("nylon", "polyester"), strict=True)
    ]
    with pytest.raises(SettingsError, match="another material of 'new'; found nylon in c/T-1"):
        source_of_tests(ropes, "new", branch="mean")
    aged = [stated(pair[0], condition="new"), stated(pair[1], condition="4 years")]
    doubt = source_of_tests(aged, "new", branch="mean").notes[0]
    assert doubt.startswith("DOUBTFUL: the archives state another condition of 'new', new in c/T-1")
    alike = source_of_tests([stated(pair[0], condition="new"), pair[1]], "new", branch="mean")
    assert not any("another condition" in note for note in alike.notes)


def test_mass_a_length_is_that_of_all_its_tests():
    tests = [
        one.assign(linear_density=("specimen", [0.1]), wet_linear_density=("specimen", [wet]))
        for one, wet in ((cyclic(), -0.01), (cyclic("T-2", 2), -0.01))
    ]
    found = source_of_tests([*tests, cyclic("T-3", 3)], "new", branch="mean")
    assert (found.linear_density, found.wet_linear_density) == (0.1, -0.01)
    tests[1]["wet_linear_density"][0] = -0.02
    with pytest.raises(SettingsError, match="another wet linear density of 'new'"):
        source_of_tests(tests, "new", branch="mean")


def test_only_tests_with_a_piece_in_the_curve_are_its_sources():
    cycles = cyclic("T-2", 3)
    found = source_of_tests([pull(), cyclic(), cycles], "new", branch="mean")
    curve = compose(found, CompositeRule(precedence=("static",)))
    used = used_of(found, curve)
    assert used.sources == ("archive c/Q",)
    assert used.notes[-1] == "of other kinds, not used: T-1, T-2"
    assert used.pieces == found.pieces
    assert used_of(used, curve) is used
    whole = compose(found, CompositeRule())
    assert used_of(found, whole) is found


def doubted(*texts, severity="warning", **fields):
    """A test with notes, as an archive keeps them."""
    notes = [Note("a-code", severity, stage="test", text=text) for text in texts]
    values = note_values(notes)
    return cyclic(**fields).assign({name: ("note", value) for name, value in values.items()})


def test_why_a_test_has_the_status_check_goes_on_with_its_curve():
    test = doubted("new: its zero drifts", "old: its zero drifts", specimens=("new", "old"))
    assert check_words(test, "new") == ("T-1 has the status check: new: its zero drifts",)
    said = [one for one in source_of_tests([test], "old", branch="mean").notes if "zero" in one]
    assert said == ["DOUBTFUL: T-1 has the status check: old: its zero drifts"]
    assert check_words(doubted("a hint", severity="note"), "new") == ()
    assert check_words(cyclic(), "new") == ()


REFUSED = {
    "one test twice is refused": (
        lambda: source_of_tests([cyclic(), cyclic()], "new", branch="mean"),
        SettingsError,
        "test c/T-1 is listed twice",
    ),
    "specimens of one name and two diameters are refused": (
        lambda: source_of_tests([cyclic(), cyclic("T-2", 2, diameter=0.03)], "new", branch="mean"),
        SettingsError,
        "another diameter of 'new'; found 0.02 in c/T-1, 0.03",
    ),
    "tests without a curve are refused": (
        lambda: source_of_tests([hold()], "new", branch="mean"),
        DataError,
        "no test of 'new' gives a mean curve.*held .relaxation",
    ),
}


test_refusals = refusals(REFUSED)

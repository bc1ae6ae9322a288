"""`reduction experiment` and `reduction surface`: from a plan to a form to a surface, and refusals."""

import csv

import numpy as np
import pytest
from commandruns import answered
from csvrows import csv_rows

SPEC = """
[experiment]
kind = "box-behnken"
rated_break_strength = "6400 lbf"
sigma = "2 %"

[factors]
frequency = ["0.1 Hz", "0.5 Hz"]
mean_tension = ["12 %RBS", "30 %RBS"]
tension_amplitude = ["5 %RBS", "12 %RBS"]

[responses]
apparent_spring_constant = { unit = "lbf" }
"""
LBF = 4.4482216152605


def stiffness(coded):
    """A law with every term, in pounds-force."""
    f, mean, amplitude = np.asarray(coded, dtype=float).T
    return 1e5 * (5 + 0.2 * f + mean - 0.4 * amplitude - 0.1 * f**2 + 0.3 * mean * amplitude)


@pytest.fixture
def plan(tmp_path, command):
    """A SPEC.toml, changed at will, and the command on it."""

    def run(*arguments, kind="box-behnken", spec=SPEC):
        (tmp_path / "SPEC.toml").write_text(spec)
        return command("experiment", kind, "SPEC.toml", *arguments, cwd=tmp_path)

    return run


@pytest.fixture
def fit(tmp_path, command):
    """A table of runs, with or without a SPEC.toml, and the command on it."""

    def run(table, spec=None, *options):
        (tmp_path / "runs.csv").write_text(table)
        names = ["runs.csv"]
        if spec is not None:
            (tmp_path / "SPEC.toml").write_text(spec)
            names.append("SPEC.toml")
        return command("surface", *names, *options, cwd=tmp_path)

    return run


def told(done, status, *texts):
    assert done.returncode == status, done.stdout + done.stderr
    line = " ".join(done.stderr.split())
    for text in texts:
        assert text in line, line
    assert "Traceback" not in line and not done.stdout


def test_the_fifteen_runs_of_the_report_by_rising_peak_load(plan):
    answer = answered(plan("--json"))
    runs = answer["runs"]
    assert [run["run_order"] for run in runs] == list(range(1, 16))
    # CG-D-39-80: peaks of 17 to 42 % of the break strength
    peaks = [run["peak_share"] for run in runs]
    assert peaks == sorted(peaks) and peaks[0] == pytest.approx(0.17)
    assert runs[0]["coded"] == [0, -1, -1]
    assert runs[0]["levels"] == pytest.approx([0.3, 768 * LBF, 320 * LBF])
    assert [factor["level_unit"] for factor in answer["factors"]] == ["Hz", "N", "N"]
    kinds = {caution["kind"]: caution["runs"] for caution in answer["cautions"]}
    assert kinds["slack"] == [11] and "pure-error-excludes-drift" in kinds
    expected = answer["expected_precision"]
    # t(0.975, 5) = 2.571 times 2 % times the root of 1/3
    assert expected["term_half_width"][0] == pytest.approx(2.5706 * 0.02 / 3**0.5, rel=1e-4)
    assert expected["unit"] == "1" and expected["degrees_of_freedom"] == 5


def test_a_person_reads_pounds_where_asked_for(plan):
    done = plan("--units", "us")
    assert done.returncode == 0, done.stderr
    assert "[lbf]" in done.stdout and "[%RBS]" in done.stdout
    assert "768" in done.stdout and "goes slack" in done.stdout
    assert "corner (beyond the runs)" in done.stdout
    assert not plan("--quiet").stdout


def test_limits_repeats_and_an_amplitude_of_the_mean(plan):
    spec = SPEC.replace('["5 %RBS", "12 %RBS"]', '["20 % of mean", "60 % of mean"]').replace(
        "sigma", 'repeats = "spread"\nload_limit = "40 %RBS"\nsigma'
    )
    answer = answered(plan("--json", spec=spec))
    kinds = {caution["kind"] for caution in answer["cautions"]}
    assert "slack" not in kinds and "pure-error-excludes-drift" not in kinds
    assert "share-over-limit" in kinds
    highest = max(answer["runs"], key=lambda run: run["peak_tension"])
    assert highest["levels"][2] == pytest.approx(0.6 * highest["levels"][1])


def test_a_screening_has_dummies_and_the_smallest_effect_to_expect(plan, tmp_path):
    spec = SPEC.replace('kind = "box-behnken"\n', "")
    answer = answered(plan("--json", "--out", "sheet.csv", kind="plackett-burman", spec=spec))
    assert len(answer["runs"]) == 12 and len(answer["runs"][0]["dummy"]) == 8
    # t(0.95, 8) = 1.860 times 2 sigma / sqrt(12)
    smallest = answer["expected_precision"]["smallest_significant_effect"]
    assert smallest == pytest.approx(1.8595 * 0.04 / 12**0.5, rel=1e-4)
    with (tmp_path / "sheet.csv").open(newline="") as file:
        assert "dummy_8" in next(csv.reader(file))


def test_a_form_that_was_filled_in_gives_the_law_back(plan, fit, tmp_path):
    done = plan("--out", "sheet.csv")
    assert done.returncode == 0 and "run sheet: sheet.csv" in done.stdout
    rows = csv_rows(tmp_path / "sheet.csv")
    coded = [[float(row[f"{name} [coded]"]) for name in (
        "frequency", "mean_tension", "tension_amplitude")] for row in rows]  # fmt: skip
    for row, value in zip(rows, stiffness(coded), strict=True):
        row["apparent_spring_constant [lbf]"] = repr(float(value))
    lines = [",".join(rows[0]), *(",".join(row.values()) for row in rows)]
    answer = answered(fit("\n".join(lines), SPEC, "--json"))
    found = answer["responses"]["apparent_spring_constant"]
    assert found["unit"] == "N"
    expected = np.array([5, -0.1, 0, 0, 0.2, 1, -0.4, 0, 0, 0.3]) * 1e5 * LBF
    np.testing.assert_allclose(found["coefficient"], expected, atol=1e-3)
    engineering = dict(
        zip(found["engineering"]["terms"], found["engineering"]["unit"], strict=True)
    )
    assert engineering["frequency^2"] == "N Hz-2"
    assert engineering["mean_tension*tension_amplitude"] == "N-1"
    assert any("columns that are not used: peak_tension [N]" in note for note in answer["notes"])


def table(header, response=stiffness, scale=((0.3, 0.2), (1344, 576), (544, 224)), extra=None):
    """Fifteen runs in the units of the plan, in pounds-force."""
    edges = [(a, b, 0) for b in (-1, 1) for a in (-1, 1)]
    coded = [np.roll(edge, turn).tolist() for turn in range(3) for edge in edges]
    coded += [[0, 0, 0]] * 3
    rng = np.random.default_rng(3)
    lines = [header]
    for number, levels in enumerate(coded):
        shown = [centre + half * level for level, (centre, half) in zip(levels, scale, strict=True)]
        value = float(response([levels])[0]) * (1 + 0.01 * rng.normal())
        cells = [*map(repr, map(float, shown)), repr(value)]
        lines.append(",".join([*cells, *([] if extra is None else [extra(number)])]))
    return "\n".join(lines)


UNITS = "frequency [Hz],mean_tension [lbf],tension_amplitude [lbf],apparent_spring_constant"


def test_levels_in_the_units_of_the_header_and_in_those_of_the_plan_are_the_same(fit):
    in_header = answered(fit(table(UNITS), SPEC, "--json"))
    shares = table(
        "frequency,mean_tension,tension_amplitude,apparent_spring_constant",
        scale=((0.3, 0.2), (21, 9), (8.5, 3.5)),
    )
    coded = table(
        "frequency [coded],mean_tension [coded],tension_amplitude [coded],apparent_spring_constant",
        scale=((0, 1),) * 3,
    )
    bare = table(
        "frequency,mean_tension,tension_amplitude,apparent_spring_constant", scale=((0, 1),) * 3
    )
    stated = SPEC.replace("[experiment]", '[experiment]\nlevels = "coded"')
    for other, spec in ((shares, SPEC), (coded, SPEC), (bare, stated)):
        found = answered(fit(other, spec, "--json"))
        for name in ("coefficient", "standard_error"):
            np.testing.assert_allclose(
                found["responses"]["apparent_spring_constant"][name],
                in_header["responses"]["apparent_spring_constant"][name], rtol=1e-9,
            )  # fmt: skip


def test_what_a_person_reads_of_a_surface(fit):
    done = fit(table(UNITS), SPEC, "--units", "us")
    assert done.returncode == 0, done.stderr
    assert "apparent_spring_constant [lbf]" in done.stdout and "lbf Hz-2" in done.stdout
    assert "B1" in done.stdout and "lack of fit" in done.stdout and "eigenvalues" in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= 160
    in_si = fit(table(UNITS), SPEC).stdout
    assert "apparent_spring_constant [N]" in in_si
    assert not fit(table(UNITS), SPEC, "--quiet").stdout


def test_a_log_surface_and_one_that_goes_below_zero(fit):
    def steep(coded):
        return 1e3 * np.exp(2.5 * np.sum(coded, axis=1))

    straight = answered(fit(table(UNITS, steep), SPEC, "--json"))
    assert any("falls below zero within the levels" in note for note in straight["notes"])
    assert any('State transform = "log" for it' in note for note in straight["notes"])
    bent = SPEC.replace('unit = "lbf"', 'unit = "lbf", transform = "log"')
    answer = answered(fit(table(UNITS, steep), bent, "--json"))
    found = answer["responses"]["apparent_spring_constant"]
    assert found["coefficient_unit"] == "ln(N)" and found["r2"] > 0.999
    np.testing.assert_allclose(found["coefficient"][4:7], 2.5, atol=0.02)
    assert not any("below zero" in note or "State" in note for note in answer["notes"])
    assert "apparent_spring_constant [ln(N)]" in fit(table(UNITS, steep), bent).stdout


def test_specimens_are_blocks_or_draws(fit):
    both = table(UNITS + ",specimen", extra=lambda number: "one")
    other = table(UNITS + ",specimen", lambda coded: 1.1 * stiffness(coded),
                  extra=lambda number: "two").partition("\n")[2]  # fmt: skip
    found = answered(fit(f"{both}\n{other}", SPEC, "--json"))["responses"]
    blocks = found["apparent_spring_constant"]["blocks"]
    assert blocks["names"] == ["one", "two"] and blocks["treatment"] == "fixed"
    assert "r2 within blocks 0.99" in fit(f"{both}\n{other}", SPEC).stdout
    assert "within" not in fit(table(UNITS), SPEC).stdout
    assert found["apparent_spring_constant"]["anova"][0]["source"] == "blocks"
    random = SPEC.replace("sigma", 'specimens_as = "random"\nsigma')
    drawn = answered(fit(f"{both}\n{other}", random, "--json"))
    blocks = drawn["responses"]["apparent_spring_constant"]["blocks"]
    assert blocks["treatment"] == "random" and blocks["standard_deviation"] > 0


def test_a_run_off_the_others_is_the_first_line(fit):
    rows = table(UNITS).splitlines()
    assert not fit("\n".join(rows), SPEC).stdout.startswith("warning")
    cells = rows[13].split(",")  # a centre run, a digit too many
    rows[13] = ",".join([*cells[:3], repr(10 * float(cells[3]))])
    said = fit("\n".join(rows), SPEC).stdout
    assert said.startswith("warning: run 13 ") and said.count("is off the surface") == 1


def test_drift_over_the_order_is_told(fit):
    order = np.random.default_rng(5).permutation(15) + 1
    rows = table(UNITS + ",run_order", extra=lambda number: str(order[number])).splitlines()
    for place, row in enumerate(rows[1:], start=1):
        cells = row.split(",")
        cells[3] = repr(float(cells[3]) * float(1 - 0.02 * order[place - 1]))
        rows[place] = ",".join(cells)
    answer = answered(fit("\n".join(rows), SPEC, "--json"))
    assert any("drifts with run order" in note for note in answer["notes"])
    assert answer["responses"]["apparent_spring_constant"]["drift"]["per_run"] < 0


def test_a_missing_run_and_a_run_not_done_are_notes(fit):
    rows = table(UNITS).splitlines()
    rows[3] = ",".join([*rows[3].split(",")[:3], ""])
    answer = answered(fit("\n".join(rows), SPEC, "--json"))
    assert answer["responses"]["apparent_spring_constant"]["degrees_of_freedom"] == 4
    assert any("runs without any value: 3" in note for note in answer["notes"])


def cell(rows, row, column, text):
    cells = rows[row - 1].split(",")
    cells[column] = text
    return "\n".join([*rows[: row - 1], ",".join(cells), *rows[row:]])


def test_what_cannot_be_fitted_is_told_with_file_row_and_column(fit):
    rows = table(UNITS).splitlines()
    told(fit("\n".join(rows[:9]), SPEC), 5, "runs.csv: ", "needed")
    told(fit(cell(rows, 4, 1, "heavy"), SPEC), 3, "runs.csv:4 [mean_tension [lbf]]: a value is not")
    told(fit(cell(rows, 4, 1, "1,2").replace("1,2", '"1,2"'), SPEC), 3, "decimal point")
    told(
        fit(cell(rows, 4, 1, ""), SPEC),
        4,
        "runs.csv:4 [mean_tension]: a run has a value but no level",
    )
    told(fit(cell(rows, 4, 3, "?"), SPEC), 2, "1 value is still '?'", "runs.csv:4 [apparent")
    told(
        fit("\n".join(rows).replace("[lbf]", "[furlongs_x]"), SPEC), 2, "'furlongs_x' is not known"
    )
    told(fit("\n".join(rows).replace("[Hz]", "[lbf]"), SPEC), 2, "does not fit frequency")
    still = [rows[0], *(",".join(["0.3", *row.split(",")[1:]]) for row in rows[1:])]
    told(fit("\n".join(still), SPEC), 4, "runs.csv: frequency never moves")
    told(fit("\n".join([*rows, rows[1] + ",1"]), SPEC), 3, "runs.csv:17: the number of cells")
    told(fit("\n".join(rows).replace("frequency", "freqency"), SPEC), 3, "is it freqency?")


def test_a_run_that_stands_twice_is_refused_and_a_twin_is_a_note(fit):
    named = table(UNITS + ",run", extra=lambda number: f"R{min(number, 13):02d}")
    told(fit(named, SPEC), 4, "runs.csv:16 [run]: a run is listed twice", "'R13', also in row 15")
    rows = table(UNITS).splitlines()
    answer = answered(fit("\n".join([*rows, rows[-1]]), SPEC, "--json"))
    assert any("repeats or one run entered twice" in note for note in answer["notes"])


def test_levels_beside_the_plan_ask_for_the_unit(fit):
    coded = table(
        "frequency,mean_tension,tension_amplitude,apparent_spring_constant", scale=((0, 1),) * 3
    )
    told(fit(coded, SPEC), 4, "are far off the plan", 'levels = "coded"')
    told(fit(table(UNITS.replace(" [lbf]", "").replace(" [Hz]", ""))), 4, "need a SPEC.toml")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (('"6400 lbf"', '"?"'), "experiment.rated_break_strength"),
        (('"6400 lbf"', '"6400 ft"'), "experiment.rated_break_strength: unit 'ft' is not a unit"),
        (('"6400 lbf"', '"-1 lbf"'), "experiment.rated_break_strength: is not positive"),
        (('"2 %"', '"0 %"'), "experiment.sigma: sigma is not above zero"),
        (('"0.1 Hz"', '"0.1 furlongs_x"'), "factors.frequency: the two levels"),
        (('"0.1 Hz"', '"0.9 Hz"'), "factors.frequency: the levels of frequency do not rise"),
        (('["0.1 Hz", "0.5 Hz"]', '["1 lbf", "2 lbf"]'), "factors.frequency: unit 'lbf' is not"),
        (('unit = "lbf"', 'unit = "s"'), "responses.apparent_spring_constant: unit 's' is not"),
        (('unit = "lbf"', 'unti = "s"'), "responses.apparent_spring_constant.unti"),
        (("sigma", "n_runs = 12\nsigma"), "n_runs applies only to plackett-burman"),
        (('rated_break_strength = "6400 lbf"\n', ""), "rated break strength, which is not given"),
        (('kind = "box-behnken"', 'kind = "plackett-burman"'), "the design in the file differs"),
        (("[responses]", "[responses]\nfrequency = {}"), "a name is both a factor and a response"),
        (("[experiment]", "[experiment"), "the experiment is not TOML"),
    ],
)
def test_a_spec_that_cannot_be_used_is_told_with_its_key(plan, change, message):
    told(plan(spec=SPEC.replace(*change)), 2, "SPEC.toml: ", message)


def test_an_experiment_needs_factors_and_a_screening_no_centre(plan):
    told(plan(spec="[experiment]\n"), 2, "there are no factors")
    spec = SPEC.replace('kind = "box-behnken"', "n_centre = 3")
    told(plan(kind="plackett-burman", spec=spec), 2, "n_centre applies only to box-behnken")
    told(plan(kind="latin-square"), 2, "latin-square")
    told(plan("--out", "no/such/folder/../.."), 6, "cannot be written")


def screening(extra=""):
    """Twelve runs of five factors and six dummies, as the design gives them."""
    first = "++-+++---+-"
    lines = ["A,B,C,D,E,dummy_1,dummy_2,dummy_3,dummy_4,dummy_5,dummy_6,y"]
    rows = [first[11 - turn :] + first[: 11 - turn] for turn in range(11)] + ["-" * 11]
    rng = np.random.default_rng(7)
    for row in rows:
        levels = [1 if sign == "+" else -1 for sign in row]
        value = 10 + 3 * levels[1] + 0.1 * rng.normal()
        lines.append(",".join([*map(str, levels), repr(value)]))
    return "\n".join(lines)


def test_dummies_give_the_error_of_a_screening(fit):
    spec = '[experiment]\nkind = "plackett-burman"\n'
    answer = answered(fit(screening(), spec, "--json"))
    found = answer["responses"]["y"]
    assert answer["error_from"] == "dummy" and answer["degrees_of_freedom"] == 6
    assert found["effect"][1] == pytest.approx(6.0, abs=0.2)
    assert found["is_significant"][1] is True
    assert "standard error by the dummies" in fit(screening(), spec).stdout
    middle = screening().replace("\n1,", "\n0.5,", 1)
    told(fit(middle, spec), 4, "a level of A is neither low nor high")
    near = [screening().replace("\n1,", f"\n{level},", 1) for level in ("1.0000000002", "1.02")]
    said = ["off the plan" in fit(table, spec).stdout for table in near]
    assert said == [False, True]  # of the rounding of a unit nothing is said


def test_a_surface_is_written_with_its_analysis_of_variance_and_figures(tmp_path, command):
    # by definition: total about the mean, residual of least squares on ten terms
    coded = np.array([[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, 1, 0], [-1, 0, -1], [1, 0, -1],
                      [-1, 0, 1], [1, 0, 1], [0, -1, -1], [0, 1, -1], [0, -1, 1], [0, 1, 1],
                      [0, 0, 0], [0, 0, 0], [0, 0, 0]])  # fmt: skip
    y = stiffness(coded) + 1e3 * np.sin(np.arange(15.0))
    rows = [",".join(map(str, row)) for row in np.column_stack([coded, y]).tolist()]
    (tmp_path / "runs.csv").write_text("\n".join(["a,b,c,=stiffness", *rows]) + "\n")
    done = command("surface", "runs.csv", "--out", "made", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    tables = tmp_path / "made" / "tables"
    f, mean, amplitude = coded.T
    terms = np.column_stack(
        [np.ones(15), coded, coded**2, f * mean, f * amplitude, mean * amplitude]
    )
    wanted, residual, *_ = np.linalg.lstsq(terms, y)
    squares = {row["source"]: row for row in csv_rows(tables / "anova.csv")}
    assert float(squares["residuals"]["sum_of_squares"]) == pytest.approx(residual[0], rel=1e-9)
    assert float(squares["residuals"]["degrees_of_freedom"]) == 5
    total = float(np.sum((y - y.mean()) ** 2))
    assert float(squares["total"]["sum_of_squares"]) == pytest.approx(total, rel=1e-9)
    found = {row["label"]: row for row in csv_rows(tables / "coefficients.csv")}
    assert float(found["B1"]["coefficient"]) == pytest.approx(wanted[0], rel=1e-9)
    assert found["B1"]["response"] == "'=stiffness"
    runs = csv_rows(tables / "runs.csv")
    assert [float(row["'=stiffness fitted"]) for row in runs] == pytest.approx(terms @ wanted)
    page = (tmp_path / "made" / "index.html").read_text(encoding="utf-8")
    assert page.count("contour-0-") >= 3
    assert "Analysis of variance" in page


def test_an_energy_per_length_keeps_its_unit_in_print_and_tables(tmp_path, command):
    pairs = [(one, other) for one in (-1.0, 1.0) for other in (-1.0, 1.0)]
    coded = np.array(
        [np.insert(pair, at, 0.0) for at in range(3) for pair in pairs] + [[0.0] * 3] * 3
    )
    value = 500 + coded @ [10.0, 20.0, 30.0] + 40 * coded[:, 0] ** 2
    value = value + np.resize([1.0, -2.0, 1.5, 0.5], len(value))
    numbers = np.column_stack([coded, value, value]).tolist()
    lines = [",".join(map(repr, row)) for row in numbers]
    head = "frequency [coded],mean_tension [coded],tension_amplitude [coded],loss [J/m],force [N]"
    (tmp_path / "runs.csv").write_text("\n".join([head, *lines]), encoding="utf-8")
    (tmp_path / "SPEC.toml").write_text(
        '[factors]\nfrequency = ["0.1 Hz", "0.5 Hz"]\nmean_tension = ["1 kN", "3 kN"]\n'
        'tension_amplitude = ["0.4 kN", "0.9 kN"]\n[responses]\nloss = {}\nforce = {}\n',
        encoding="utf-8",
    )
    done = command("surface", "runs.csv", "SPEC.toml", "--out", "made", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "loss [J m-1]" in done.stdout
    assert "J m-1 Hz-2" in done.stdout
    rows = [
        row
        for row in csv_rows(tmp_path / "made" / "tables" / "coefficients.csv")
        if row["term"] == "mean_tension^2"
    ]
    assert [row["unit"] for row in rows] == ["J m-1", "N"]
    assert [row["unit_engineering"] for row in rows] == ["J m-1 N-2", "N-1"]
    head = (tmp_path / "made" / "tables" / "runs.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "loss [J m-1],loss fitted [J m-1]" in head


def test_the_printed_equation_gives_the_surface_over_a_range_small_beside_its_level(fit):
    # eight digits of terms a hundred thousand times their sum leave an error of 0.9 uncertainties
    pairs = [(one, other) for one in (-1.0, 1.0) for other in (-1.0, 1.0)]
    coded = np.array([np.insert(pair, at, 0.0) for at in range(3) for pair in pairs] + [[0.0] * 3])
    coded = np.vstack([coded, coded[-1:], coded[-1:]])
    middle, half = np.array([0.3, 278.65, 8500.0]), np.array([0.2, 0.5, 3500.0])
    values = 5e4 * np.exp(coded @ [0.05, 0.5, -0.2]) * (1 + 0.01 * np.sin(7.0 * np.arange(15)))
    numbers = np.column_stack([middle + half * coded, values]).tolist()
    lines = [",".join(map(repr, row)) for row in numbers]
    head = "frequency [Hz],temperature [K],tension_amplitude [N],K [N]"
    spec = (
        '[factors]\nfrequency = ["0.1 Hz", "0.5 Hz"]\ntemperature = ["278.15 K", "279.15 K"]\n'
        'tension_amplitude = ["5 kN", "12 kN"]\n[responses]\nK = {}\n'
    )
    text = "\n".join([head, *lines]) + "\n"
    printed = fit(text, spec).stdout.split("in units")[-1].splitlines()
    equation = [float(line.split()[2]) for line in printed if line.startswith("B")]
    answer = answered(fit(text, spec, "--json"))["responses"]["K"]
    at = np.random.default_rng(1).uniform(-1, 1, (50, 3))

    def terms(level):
        f, mean, swing = level.T
        squares = [f**2, mean**2, swing**2]
        return np.column_stack(
            [np.ones(len(f)), *squares, f, mean, swing, f * mean, f * swing, mean * swing]
        )

    missed = terms(middle + half * at) @ equation - terms(at) @ answer["coefficient"]
    assert np.abs(missed).max() < 0.1 * answer["standard_error"][0]

"""A rope programme from its logs to archives and tables, each number against what made it."""

import re

import numpy as np
import pandas as pd
import programme as made
import pytest
from rulesofcf import held_against_cf

from reduction.archive.open import open_archive
from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign

pytestmark = pytest.mark.slow

POSITION = 'control = "position"'


def run(folder, *parts):
    path = made.write_campaign(folder, *parts)
    return run_campaign(
        load_campaign(path), processed=folder / "p", reports=folder / "r", clock=lambda: 0.0
    )


def table(result, name):
    frame = pd.read_csv(result.processed / "tables" / f"{name}.csv")
    return frame.rename(columns=lambda column: column.partition(" [")[0])


def row(result, test, name="rope_programme"):
    frame = table(result, name)
    return frame[frame["test"] == test].iloc[0]


def notes(result, test):
    with open_archive(result.processed / f"{test}.nc") as archive:
        return archive["note"].to_numpy().tolist()


def near(found, name, truth, *, floor=0.0):
    """Within three of its standard uncertainties, and of a stated floor."""
    spread = found[f"{name}_standard_uncertainty"]
    assert spread >= 0
    assert found[name] == pytest.approx(truth, abs=3 * spread + floor), name


@pytest.fixture(scope="module")
def log():
    return made.programme_log()


@pytest.fixture(scope="module")
def whole(log, tmp_path_factory):
    """One log in steps, and a pull to the end of another specimen."""
    folder = tmp_path_factory.mktemp("programme")
    made.write(log, folder / "P-7.csv")
    made.write(made.tensile_log(), folder / "B-1.csv", seed=6)
    return run(
        folder, made.ONE_LOG, made.steps_of(log),
        made.single("B-1", "tensile", POSITION, specimen="R-2"),
    )  # fmt: skip


def test_every_step_is_a_row(whole):
    assert whole.exit_status == 0
    found = table(whole, "rope_programme").set_index("test")["programme_step"]
    assert found.to_dict() == {
        "B-1": "tensile strength",
        "P-7.bedding-in": "bedding-in",
        "P-7.quasi-static": "quasi-static stiffness",
        **{f"P-7.dynamic-{level}": "dynamic stiffness" for level in (1, 2, 3)},
        "P-7.creep": "creep",
        "P-7.life": "cycles to failure",
    }


def test_bedding_in_has_the_stiffness_of_its_ends_and_the_permanent_strain(whole):
    found = row(whole, "P-7.bedding-in")
    first, last = made.bedding_stiffness(1), made.bedding_stiffness(made.N_BEDDING)
    assert found["bedding_cycles"] == made.N_BEDDING
    near(found, "bedding_first_stiffness", first)
    near(found, "bedding_last_stiffness", last)
    near(found, "bedding_first_stiffness_over_strength", first / made.STRENGTH)
    near(found, "bedding_last_stiffness_over_strength", last / made.STRENGTH)
    near(found, "bedding_stiffening", last / first)
    permanent = made.bedding_foot(made.N_BEDDING) - made.bedding_foot(1)
    assert found["bedding_permanent_strain"] == pytest.approx(permanent, abs=1e-4)


def test_stiffness_between_holds_falls_with_the_logarithm_of_time(whole):
    found = row(whole, "P-7.quasi-static", "static_stiffness")
    assert (found["held_pair_low_hold"], found["held_pair_high_hold"]) == (1, 2)
    assert found["held_pair_low_tension"] == pytest.approx(1e4, abs=10)
    assert found["held_pair_high_tension"] == pytest.approx(3e4, abs=10)
    near(found, "static_stiffness", 5e5)
    near(found, "static_stiffness_over_strength", 5.0)
    near(found, "static_stiffness_per_decade", -1.5e4)
    near(found, "static_stiffness_per_decade_over_strength", -0.15)
    assert found["static_stiffness_standard_uncertainty"] < 5e2
    # the row of the step has the same
    of_step = row(whole, "P-7.quasi-static")
    assert of_step["static_stiffness"] == found["static_stiffness"]
    points = table(whole, "static_stiffness_times")
    assert points["static_elapsed_time"].iloc[-1] > 3000
    truth = made.static_stiffness(points["static_elapsed_time"].to_numpy())
    assert points["static_stiffness_at_time"].to_numpy() == pytest.approx(truth, rel=2e-3)


@pytest.mark.parametrize("level", range(3))
def test_dynamic_stiffness_of_each_level_is_that_of_its_last_cycles(whole, level):
    found = row(whole, f"P-7.dynamic-{level + 1}")
    last = np.arange(made.N_LEVEL - made.LAST, made.N_LEVEL) + 1
    truth = made.level_stiffness(level, last).mean()
    assert found["dynamic_cycles"] == made.LAST
    near(found, "dynamic_stiffness", truth)
    near(found, "dynamic_stiffness_over_strength", truth / made.STRENGTH)
    assert found["dynamic_stiffness_standard_uncertainty"] < 2e-3 * truth
    near(found, "dynamic_stiffness_drift", 0.0)
    assert found["dynamic_frequency"] == pytest.approx(1 / made.PERIOD, rel=1e-3)
    mean, amplitude = made.LEVELS[level]
    assert found["dynamic_mean_tension_over_strength"] == pytest.approx(mean, rel=2e-3)
    assert found["dynamic_tension_amplitude_over_strength"] == pytest.approx(amplitude, rel=2e-3)


def test_creep_a_decade_stands_alone_and_over_the_strength(whole):
    found = row(whole, "P-7.creep", "creep")
    near(found, "creep_rate_per_decade", made.CREEP, floor=0.001 * made.CREEP)
    near(found, "creep_compliance_per_decade", made.CREEP / 0.4, floor=0.001 * made.CREEP / 0.4)
    assert found["creep_tension_over_strength"] == pytest.approx(0.4, abs=1e-4)
    of_step = row(whole, "P-7.creep")
    assert of_step["creep_rate_per_decade"] == found["creep_rate_per_decade"]


def test_cycles_to_failure_are_those_before_the_one_in_which_it_parts(whole):
    found = row(whole, "P-7.life")
    assert found["cycles_to_failure"] == made.N_LIFE
    assert found["cycles_are_run_out"] == "no"
    assert found["failure_judged_by"] == "slack at a position at which it was taut"
    assert found["failure_peak_tension_over_strength"] == pytest.approx(0.5, abs=1e-3)
    assert found["failure_valley_tension"] == pytest.approx(0.05 * made.STRENGTH, rel=0.01)


def test_a_pull_to_the_end_has_a_strength_and_a_strain(whole):
    found = row(whole, "B-1", "tensile")
    assert found["pull_is_break"] == "yes"
    near(found, "tensile_strength", made.BREAK)
    near(found, "strain_at_failure", made.STRAIN_AT_BREAK)
    near(found, "pull_peak_tension_over_strength", made.BREAK / made.STRENGTH)


def test_a_level_that_has_not_settled_is_named(whole):
    last = np.arange(made.N_BEDDING - made.LAST, made.N_BEDDING) + 1
    slope = np.polyfit(last, made.bedding_stiffness(last), 1)[0]
    near(row(whole, "P-7.bedding-in"), "dynamic_stiffness_drift", slope)
    assert any("has not settled" in note for note in notes(whole, "P-7.bedding-in"))
    assert not any("settled" in note for note in notes(whole, "P-7.dynamic-1"))


@pytest.mark.nightly
def test_the_compliance_checker_finds_nothing(whole):
    products = sorted(whole.processed.glob("*.nc"))
    assert len(products) == 9  # each step, the pull, and change_in_length.nc
    done = held_against_cf(*products)
    assert done.returncode == 0, done.stdout


def properties(result, name):
    frame = table(result, "change_in_length").set_index("property_name").loc[[name]]
    return [one for _, one in frame.iterrows()]


def test_every_property_of_the_rope_is_a_row_with_a_number_or_a_reason(whole):
    found = table(whole, "change_in_length")
    # a pull to the end alone is no programme: R-2 has no row
    assert set(found["specimen"]) == {"R-1"}
    assert found["property_name"].value_counts().to_dict() == {
        "original stiffness": 1,
        "static stiffness": 1,
        "dynamic stiffness": 3,
        "construction strain": 1,
        "polymer strain": 3,
        "working strain": 1,
    }
    value = found["property_stiffness"].fillna(found["property_strain"])
    assert value.notna().all()
    assert (found["synthetic"] == "yes").all()


def chord_of_first_rise(one):
    """Of the law that made the log: to 5 % of the strength at 0.01, then the first cycle."""
    low, high = one["property_low_tension"], one["property_high_tension"]
    valley, at_valley = 0.05 * made.STRENGTH, 0.01
    assert low < valley < high
    strain = at_valley + (high - valley) / made.bedding_stiffness(1) - at_valley * low / valley
    return (high - low) / strain


def test_properties_are_those_of_the_law_that_made_the_log(whole):
    (original,) = properties(whole, "original stiffness")
    near(original, "property_stiffness", chord_of_first_rise(original))
    assert "paused in a hold" in original["property_remark"]
    (static,), (working,) = (
        properties(whole, "static stiffness"),
        properties(whole, "working strain"),
    )
    near(static, "property_stiffness", 5e5)
    near(static, "property_stiffness_over_strength", 5.0)
    near(working, "property_strain", 2e4 / 5e5)
    for level, one in enumerate(properties(whole, "dynamic stiffness")):
        last = np.arange(made.N_LEVEL - made.LAST, made.N_LEVEL) + 1
        near(one, "property_stiffness", made.level_stiffness(level, last).mean())
    (construction,) = properties(whole, "construction strain")
    near(construction, "property_strain", made.bedding_foot(made.N_BEDDING) - made.bedding_foot(1))
    *_, polymer = properties(whole, "polymer strain")
    near(polymer, "property_strain", made.CREEP * np.log10(7210 / made.REFERENCE_TIME))
    assert polymer["property_low_tension"] == polymer["property_high_tension"]
    assert polymer["property_reference_time"] == made.REFERENCE_TIME


def test_the_table_of_properties_is_explained(whole):
    about = pd.read_csv(whole.processed / "tables" / "columns.csv").set_index(["table", "column"])
    about = about.loc["change_in_length.csv"]
    header = (whole.processed / "tables" / "change_in_length.csv").read_text().splitlines()[0]
    assert about.index.tolist() == header.split(",")
    assert about.loc["property_stiffness [N]", "unit"] == "N"
    assert about.loc["property_reference_time [s]", "no_uncertainty"] == "setting"


def test_the_archive_of_properties_says_what_it_was_made_from(whole):
    with open_archive(whole.processed / "change_in_length.nc") as archive:
        assert archive.attrs["raw_file"].splitlines()[0] == "P-7.bedding-in.nc"
        assert "R-1: 10 of 10 properties have a number" in archive.attrs["history"]
        stiffness = archive["property_stiffness"]
        assert stiffness.attrs["units"] == "N"
        assert stiffness.attrs["ancillary_variables"] == "property_stiffness_standard_uncertainty"


def test_the_page_has_the_programme_and_its_steps_as_they_were_done(whole):
    html = whole.report.read_text(encoding="utf-8")
    assert "Programme of rope R-1" in html
    assert "Programme of rope R-2" not in html
    titles = re.findall(r'<h2 id="test-\d+">([^<]+)</h2>', html)
    steps = ["bedding-in", "quasi-static", "dynamic-1", "dynamic-2", "dynamic-3", "creep", "life"]
    assert titles == ["B-1", *(f"P-7.{step}" for step in steps)]


@pytest.fixture(scope="module")
def apart(log, tmp_path_factory):
    """Each step as a log of its own; the last one stops before the line parts."""
    folder = tmp_path_factory.mktemp("apart")
    made.write(log, folder / "P-7.csv")
    head, *lines = (folder / "P-7.csv").read_text().splitlines()
    at = np.array([float(line.partition(",")[0]) for line in lines])
    parts = []
    for step, (begin, end) in log.steps.items():
        name = step.replace(" ", "-")
        end = begin + 20 + made.N_LIFE * made.PERIOD if step == "life" else end
        kept = [line for line, time in zip(lines, at, strict=True) if begin <= time <= end]
        (folder / f"{name}.csv").write_text("\n".join([head, *kept]) + "\n")
        parts.append(made.single(name, made.KINDS.get(step, "cyclic")))
    return run(folder, *parts)


def test_several_logs_give_what_one_log_gives(whole, apart):
    of_steps = table(whole, "rope_programme").set_index("test")
    for _, found in table(apart, "rope_programme").iterrows():
        if found["test"] == "life":
            continue
        same = of_steps.loc[f"P-7.{found['test']}"]
        for name in found.index.drop("test"):
            assert found[name] == same[name] or (pd.isna(found[name]) and pd.isna(same[name])), name


def test_a_log_that_stops_before_the_failure_is_a_run_out(apart):
    found = row(apart, "life")
    assert (found["cycles_to_failure"], found["cycles_are_run_out"]) == (made.N_LIFE, "yes")


def test_the_word_of_the_laboratory_decides(log, tmp_path):
    made.write(log, tmp_path / "P-7.csv")
    begin = log.steps["life"][0]
    end = begin + 20 + made.N_LIFE * made.PERIOD
    result = run(
        tmp_path, made.ONE_LOG, "[[tests.P-7.steps]]", 'name = "life"', f'from = "{begin:g} s"',
        f'to = "{end:g} s"', 'kind = "fatigue"', "failed = true",
    )  # fmt: skip
    found = row(result, "P-7.life")
    assert (found["cycles_to_failure"], found["cycles_are_run_out"]) == (made.N_LIFE, "no")
    assert found["failure_judged_by"] == "as stated, after the last whole cycle"
    with open_archive(result.processed / "P-7.life.nc") as archive:
        assert archive.attrs["failed"] == "yes"


def test_a_pull_that_was_stopped_has_no_strength(tmp_path):
    made.write(made.stopped_log(), tmp_path / "B-2.csv")
    result = run(tmp_path, made.single("B-2", "tensile", POSITION))
    found = row(result, "B-2", "tensile")
    assert found["pull_is_break"] == "no"
    assert np.isnan(found["tensile_strength"]) and np.isnan(found["strain_at_failure"])
    near(found, "pull_peak_tension", 0.6 * made.STRENGTH)
    assert any("tensile strength not given" in note for note in notes(result, "B-2"))


def test_snap_loads_are_cycles_that_go_slack(tmp_path):
    made.write(made.snap_log(), tmp_path / "S-1.csv")
    made.write(made.snap_log(valley=0.1 * made.STRENGTH), tmp_path / "S-2.csv")
    result = run(
        tmp_path, made.single("S-1", "snap", POSITION), made.single("S-2", "snap", POSITION)
    )
    assert result.exit_status == 0
    found = row(result, "S-1")
    assert found["programme_step"] == "cycles to failure under snap loads"
    assert (found["cycles_to_failure"], found["cycles_are_run_out"]) == (made.N_SNAP, "yes")
    assert found["failure_peak_tension_over_strength"] == pytest.approx(0.3, abs=2e-3)
    assert not any("goes slack in" in note for note in notes(result, "S-1"))
    assert any("are not snap loads" in note for note in notes(result, "S-2"))


def test_without_a_break_strength_nothing_is_divided_by_it(log, tmp_path):
    made.write(log, tmp_path / "P-7.csv")
    path = made.write_campaign(tmp_path, made.ONE_LOG, made.steps_of(log))
    path.write_text(path.read_text().replace('rated_break_strength = "100 kN"\n', ""))
    result = run_campaign(
        load_campaign(path), processed=tmp_path / "p", reports=tmp_path / "r", clock=lambda: 0.0,
        tests=["P-7.dynamic-2", "P-7.creep"],
    )  # fmt: skip
    found = row(result, "P-7.dynamic-2")
    assert found["dynamic_stiffness"] == pytest.approx(1.3e6, rel=2e-3)
    assert np.isnan(found["dynamic_stiffness_over_strength"])
    assert any(
        "results relative to it are not given" in note for note in notes(result, "P-7.dynamic-2")
    )
    with open_archive(result.processed / "P-7.creep.nc") as archive:
        assert not [name for name in archive.variables if "over_strength" in str(name)]


@pytest.mark.parametrize(
    ("lines", "remark"),
    [
        (("order = 1", "order = 2"), ""),
        (("order = 2", "order = 1"), "it had been loaded in dynamic-1"),
        (("order = 1\nunlogged_cycles = 4", "order = 2"), "it had carried 4 cycles"),
    ],
)
def test_the_order_of_several_logs_decides_what_is_of_a_new_rope(log, tmp_path, lines, remark):
    made.write(log, tmp_path / "P-7.csv")
    head, *rows = (tmp_path / "P-7.csv").read_text().splitlines()
    parts = []
    for step, line in zip(("bedding-in", "dynamic 1"), lines, strict=True):
        begin, end = log.steps[step]
        kept = [row for row in rows if begin <= float(row.partition(",")[0]) <= end]
        name = step.replace(" ", "-")
        (tmp_path / f"{name}.csv").write_text("\n".join([head, *kept]) + "\n")
        parts.append(made.single(name, made.KINDS.get(step, "cyclic"), line))
    result = run(tmp_path, *parts)
    assert result.exit_status == 0
    found = table(result, "change_in_length").set_index("property_name")
    construction = found.loc["construction strain"]
    assert pd.isna(construction["property_strain"]) == bool(remark)
    assert remark in construction["property_remark"]


def test_properties_of_logs_without_an_order_are_those_that_need_none(apart):
    found = table(apart, "change_in_length").set_index("property_name")
    of_new = found.loc[["original stiffness", "construction strain", "working strain"]]
    assert of_new[["property_stiffness", "property_strain"]].isna().all(axis=None)
    assert of_new["property_remark"].str.contains("order of the tests is not stated").all()
    assert found.loc["dynamic stiffness", "property_stiffness"].notna().all()


def test_a_rope_that_was_loaded_before_has_no_original_stiffness(log, tmp_path):
    made.write(log, tmp_path / "P-7.csv")
    path = made.write_campaign(tmp_path, made.ONE_LOG, made.steps_of(log))
    text = path.read_text().replace("[specimens.R-2]", "earlier_cycles = 3\n[specimens.R-2]")
    path.write_text(text)
    result = run_campaign(
        load_campaign(path), processed=tmp_path / "p", reports=tmp_path / "r", clock=lambda: 0.0,
        tests=["P-7.dynamic-1"],
    )  # fmt: skip
    found = table(result, "change_in_length").set_index("property_name")
    assert "it had carried 3 cycles" in found.loc["original stiffness", "property_remark"]
    assert found.loc["dynamic stiffness", "property_stiffness"] > 0
    # what the run left out is told where a property may be in it
    assert "P-7.creep not reduced yet" in found.loc["polymer strain", "property_remark"]


def test_a_bedding_in_that_begins_above_slack_gives_the_first_cycle(log, tmp_path):
    made.write(log, tmp_path / "P-7.csv")
    begin, end = log.steps["bedding-in"]
    result = run(
        tmp_path, made.ONE_LOG, "[[tests.P-7.steps]]", 'name = "bedding-in"',
        f'from = "{begin + 25:g} s"', f'to = "{end:g} s"', 'kind = "bedding-in"',
    )  # fmt: skip
    (original,) = properties(result, "original stiffness")
    near(original, "property_stiffness", made.bedding_stiffness(1))
    assert "from the first cycle" in original["property_remark"]


@pytest.mark.parametrize("wave", ["sine", "ramps"])
def test_cycles_that_bed_a_rope_in_begin_with_the_first(wave, tmp_path):
    """A rope of 1 MN that is longer by 0.01 (1 - exp(-n)) after the rise of the nth cycle.

    Steps of a log share one waveform, and sines often follow bedding in by ramps.
    """
    ramp, cycle = np.arange(0, 1, 0.1), np.arange(0, 8, 0.0025)
    phase = np.cos(2 * np.pi * cycle)
    phase = phase if wave == "sine" else 1 - 2 / np.pi * np.arccos(phase)
    tension = np.concatenate([np.zeros(200), 2e3 * ramp, 21e3 - 19e3 * phase])
    before = 0.01 * (1 - np.exp(-np.floor(cycle)))
    risen = (1 - np.cos(2 * np.pi * np.minimum(cycle % 1, 0.5))) / 2
    longer = before + (0.01 - before) * (1 - np.exp(-1)) * risen
    strain = tension / 1e6 + np.concatenate([np.zeros(210), longer])
    noise = np.random.default_rng(8)
    tension = tension + noise.normal(0, 4.0, tension.size)
    strain = strain + noise.normal(0, 2e-6, strain.size)
    rows = np.column_stack([0.1 * np.arange(tension.size), 10 * strain, tension, strain])
    np.savetxt(tmp_path / "sine.csv", rows, fmt="%.7g", delimiter=",", header="t_s,x_m,F_N,e",
               comments="")  # fmt: skip
    result = run(tmp_path, made.single("sine", "bedding-in", 'waveform = "sinusoidal"'))
    assert [(one.status, one.message) for one in result.tests] == [("reduced", "")]
    found = row(result, "sine")
    assert found["bedding_cycles"] == 8
    near(found, "bedding_last_stiffness", 1e6)
    # between the feet of the first and the last cycle
    near(found, "bedding_permanent_strain", 0.01 * (1 - np.exp(-7)))


def log_of_loads(path, time, load, position=None):
    """A log of a rope of 1 MN that creeps by .0002 a decade after each time its load moves."""
    held = time - np.maximum.accumulate(np.where(np.gradient(load) != 0, time, 0.0))
    strain = load / 1e6 + 2e-4 * np.log10(1 + held)
    noise = np.random.default_rng(3)
    rows = np.column_stack([
        time, 10 * strain if position is None else position,
        load + noise.normal(0, 5.0, time.size), strain + noise.normal(0, 2e-6, time.size),
    ])  # fmt: skip
    np.savetxt(path, rows, fmt="%.7g", delimiter=",", header="t_s,x_m,F_N,e", comments="")


def test_a_rope_that_is_pulled_from_hold_to_hold_does_not_cycle(tmp_path):
    turns, loads = [0.0, 20.0, 60.0], [0.0, 0.0, 1e4]
    for high in (True, False) * 4:
        turns += [turns[-1] + 300, turns[-1] + 340]
        loads += [loads[-1], 3e4 if high else 1e4]
    time = np.arange(0.0, turns[-1] + 300)
    log_of_loads(tmp_path / "held.csv", time, np.interp(time, turns, loads))
    result = run(tmp_path, made.single("held", "quasi-static"))
    assert [(one.status, one.message) for one in result.tests] == [("reduced", "")]


@pytest.mark.parametrize(("n_after", "status"), [(0, "check"), (4, "reduced"), (80, "reduced")])
def test_a_pull_that_breaks_above_the_rated_strength_is_no_mistake(tmp_path, n_after, status):
    time = np.arange(0.0, 100.0, 0.2)
    load = np.concatenate([1.1e3 * time, np.zeros(n_after)])  # 110 kN; 100 kN are rated
    time = 0.2 * np.arange(load.size)
    log_of_loads(tmp_path / "pull.csv", time, load, position=time / 100)
    result = run(tmp_path, made.single("pull", "tensile"))
    assert [one.status for one in result.tests] == [status]
    assert ("rated_break_strength" in result.tests[0].message) == (status == "check")


@pytest.mark.parametrize(
    ("begins", "datum", "waits", "status"),
    [
        (10.0, '"pin-to-pin"', 8, "reduced"),
        (-0.6, '"displacement", reference_length = "10 m"', 8, "reduced"),
        (0.6, '"displacement", reference_length = "10 m"', 0, "check"),
    ],
)
def test_a_slow_log_begins_slack_with_fewer_readings_than_a_rest(
    tmp_path, begins, datum, waits, status
):
    time = np.arange(0.0, 240.0, 3.0)
    place = begins + np.clip(time - waits, 0, None) / 400  # up to three at slack, then 1 MN
    load = 1e5 * (place - begins)
    log_of_loads(tmp_path / "pull.csv", time, load, position=place)
    layout = "\n".join([
        '[layouts.pins]', 'format = "delimited"', '[layouts.pins.channels]',
        'time = { column = "t_s", unit = "s" }',
        f'crosshead_position = {{ column = "x_m", unit = "m", datum = {datum} }}',
        'tension.1 = { column = "F_N", unit = "N" }',
    ])  # fmt: skip
    rope = '[specimens.R-3]\nkind = "rope"\ngauge_length = "10 m"\ndiameter = ["20 mm"]'
    pull = ('layout = "pins"', 'strain = { method = "gauge-length" }')
    result = run(
        tmp_path, layout, rope, made.single("pull", "quasi-static", POSITION, *pull, specimen="R-3")
    )
    assert [one.status for one in result.tests] == [status]
    curve = table(result, "slow_pull").dropna()
    assert curve["quasi_static_strain"].to_numpy() == pytest.approx(
        curve["tension_grid"].to_numpy() / 1e6, abs=1e-5
    )


@pytest.mark.parametrize("readings", [(), (4e4,), (6e4, 2e4)])
def test_the_curve_of_a_first_loading_ends_where_the_specimen_breaks(tmp_path, readings):
    time = np.arange(0.0, 100.0, 0.05)
    place = np.clip(time - 10, 0, None) / 100  # 1 MN; the machine runs on after the break
    load = np.where(time < 70, 1e5 * place, 0.0)
    broke = int(np.argmax(time >= 70))
    load[broke : broke + len(readings)] = readings
    log_of_loads(tmp_path / "pull.csv", time, load, position=place)
    rope = 'kind = "rope"\ndiameter = ["20 mm"]\ngauge_length = "10 m"'
    gauge = 'strain = { method = "gauge-length" }'
    result = run(
        tmp_path, "[specimens.R-3]", rope,
        made.single("pull", "tensile", POSITION, gauge, specimen="R-3"),
    )  # fmt: skip
    assert [one.status for one in result.tests] == ["reduced"]
    curve = table(result, "first_loading").dropna(subset=["tangent_modulus_first_loading"])
    assert 0.0590 < curve["first_loading_strain_bin"].max() < 0.0600
    modulus = curve["tangent_modulus_first_loading"] * np.pi * 0.01**2
    assert modulus.to_numpy() == pytest.approx(1e6, rel=0.05)


@pytest.mark.parametrize("readings", [(), (8e3,), (2e4, 8e3)])
def test_the_readings_of_a_break_are_no_step_of_the_load(tmp_path, readings):
    time = np.arange(0.0, 130.0, 0.25)
    load = 2e4 + 1e4 * np.sin(2 * np.pi * 0.1 * np.clip(time - 10, 0, None))
    load[:40] = np.linspace(0, 2e4, 40)
    position = load / 1e5
    broke = 40 + 405  # after ten cycles, near a peak; the machine runs on
    load[broke:] = 0.0
    load[broke : broke + len(readings)] = readings
    position[broke:] = np.clip(position[broke - 1] + 0.02 * np.arange(time.size - broke), 0, 0.5)
    log_of_loads(tmp_path / "breaks.csv", time, load, position=position)
    result = run(tmp_path, made.single("breaks", "cyclic", 'waveform = "sinusoidal"'))
    assert "the specimen parted or came loose" in result.tests[0].message


def test_a_grip_that_slips_under_a_rope_without_a_diameter_is_told(tmp_path):
    cycle = np.arange(0, 40, 0.025)
    load = 3e4 - 1e4 * np.cos(2 * np.pi * cycle)
    creep = 3e-4 * np.log10(1 + cycle) - 2e-3 * np.exp(-cycle / 2)  # more at first than the slip
    noise = np.random.default_rng(5)
    for name, slip in (("slips", 8e-4), ("holds", 0.0)):
        strain = load / 1e6 + creep + slip * (cycle > 20.3) + noise.normal(0, 5e-6, cycle.size)
        rows = np.column_stack([12 * cycle, 10 * strain, load, strain])
        np.savetxt(tmp_path / f"{name}.csv", rows, fmt="%.7g", delimiter=",",
                   header="t_s,x_m,F_N,e", comments="")  # fmt: skip
    kind = ("cyclic", 'waveform = "sinusoidal"')
    result = run(tmp_path, made.single("slips", *kind, "order = 1"),
                 made.single("holds", *kind, "order = 2"),
                 '[uncertainty]\nlag = "1 ms"')  # fmt: skip
    assert [one.status for one in result.tests] == ["check", "reduced"]
    assert "the mean strain jumps by +0.08" in result.tests[0].message
    assert "after cycle 20" in result.tests[0].message or "cycle 19" in result.tests[0].message


def test_a_rope_without_a_diameter_creeps_with_its_cycles(tmp_path):
    cycle = np.arange(0, 40, 0.025)
    load = 3e4 - 1e4 * np.cos(2 * np.pi * cycle)
    # in the middle of the nth cycle .0003 log10 n
    strain = load / 1e6 + 3e-4 * np.log10(np.maximum(cycle + 0.5, 0.5))
    rows = np.column_stack([12 * cycle, 10 * strain, load, strain])
    np.savetxt(tmp_path / "creeps.csv", rows, fmt="%.8g", delimiter=",", header="t_s,x_m,F_N,e",
               comments="")  # fmt: skip
    result = run(tmp_path, made.single("creeps", "cyclic", 'waveform = "sinusoidal"'))
    found = row(result, "creeps", "trend").rename(lambda name: name.partition(" [")[0])
    near(found, "mean_strain_per_decade", 3e-4)
    assert found["mean_strain_per_decade"] == pytest.approx(3e-4, rel=0.02)
    assert np.isnan(found["dynamic_modulus_per_decade"])


@pytest.mark.parametrize("channel", ["crosshead_position", "the extensometer of R-1"])
def test_a_length_that_is_set_to_zero_again_under_load_is_told(tmp_path, channel):
    """Held at 30 kN, where the stroke, or the strain, is set back; cycles before and after it."""
    cycles = 2e4 - 1e4 * np.cos(2 * np.pi * np.arange(0, 20, 0.025))
    parts = [np.zeros(40), np.linspace(0, 1e4, 60), cycles, np.full(200, 1e4), cycles]
    load = np.concatenate(parts)
    time, noise = 0.5 * np.arange(load.size), np.random.default_rng(6)
    set_back = np.where(np.arange(load.size) > 1000, 2e-3, 0.0)
    strain = load / 1e6 + noise.normal(0, 2e-6, load.size)
    of_stroke, of_strain = (set_back, 0) if channel == "crosshead_position" else (0, set_back)
    rows = np.column_stack([time, 10 * (strain - of_stroke), load, strain - of_strain])
    np.savetxt(tmp_path / "P.csv", rows, fmt="%.7g", delimiter=",", header="t_s,x_m,F_N,e",
               comments="")  # fmt: skip
    method = "gauge-length" if channel == "crosshead_position" else "extensometer"
    steps = "".join(
        f'[[tests.P.steps]]\nname = "{name}"\nfrom = "{low} s"\nto = "{high} s"\n'
        for name, low, high in (("before", 50, 450), ("after", 548, 950))
    )
    # the rope has a gauge length in this campaign alone
    path = made.write_campaign(
        tmp_path, made.single("P", "cyclic", 'waveform = "sinusoidal"',
                              f'strain = {{ method = "{method}" }}', steps)
    )  # fmt: skip
    text = path.read_text().replace("[specimens.R-1]", '[specimens.R-1]\ngauge_length = "10 m"')
    path.write_text(text)
    run_campaign(
        load_campaign(path), processed=tmp_path / "p", reports=tmp_path / "r", clock=lambda: 0.0
    )
    notes_of = {}
    for name in ("before", "after"):
        with open_archive(next((tmp_path / "p").rglob(f"P.{name}.nc"))) as archive:
            notes_of[name] = [one for one in archive["note"].to_numpy().tolist() if "jumps" in one]
    assert notes_of["before"] == []
    (told,) = notes_of["after"]
    assert told.startswith(f"{channel} jumps by -0.")


def test_a_step_that_failed_is_named_where_its_property_is_missing(log, tmp_path):
    made.write(log, tmp_path / "P-7.csv")
    head, *lines = (tmp_path / "P-7.csv").read_text().splitlines()
    begin, end = log.steps["dynamic 1"]
    kept = [line for line in lines if begin <= float(line.partition(",")[0]) <= end]
    (tmp_path / "new.csv").write_text(f"{head}\nnot, a, number, at all\n")
    (tmp_path / "later.csv").write_text("\n".join([head, *kept]) + "\n")
    result = run(
        tmp_path, made.single("new", "bedding-in", "order = 1"),
        made.single("later", "cyclic", "order = 2"),
    )  # fmt: skip
    assert result.exit_status != 0
    found = table(result, "change_in_length").set_index("property_name")
    assert (
        "new came first, and gave no archive" in found.loc["original stiffness", "property_remark"]
    )
    assert found.loc["construction strain", "property_remark"].endswith("; new failed")
    assert found.loc["dynamic stiffness", "property_stiffness"] > 0


@pytest.mark.parametrize("what", ["position", "tension", ""])
def test_each_step_after_a_slip_is_told_of_it(tmp_path, what):
    cycle = np.arange(0, 60, 0.02)
    level = np.searchsorted([20, 40], cycle, side="right")
    # steps of 20 cycles, 5 s each, about 20, 30 and 40 kN; the slip takes half a cycle
    load = 1e4 * (2 + level) - 8e3 * np.cos(2 * np.pi * cycle)
    slipped = np.clip(cycle - 9.8, 0, 0.5) / 0.5
    noise = np.random.default_rng(7)
    strain = load / 1e6 + 1e-4 * np.log10(1 + cycle) + noise.normal(0, 2e-6, load.size)
    position = 10 * (strain + (4e-3 * slipped if what == "position" else 0))
    load = load - (4e3 * slipped if what == "tension" else 0)
    lead = np.linspace(0, 1, 150)
    rows = np.column_stack([
        np.concatenate([15 * lead - 15.1, 5 * cycle]),
        np.concatenate([position[0] * lead, position]),
        np.concatenate([load[0] * lead, load]),
    ])  # fmt: skip
    np.savetxt(tmp_path / "S.csv", np.column_stack([rows, rows[:, 1] / 10]), fmt="%.7g",
               delimiter=",", header="t_s,x_m,F_N,e", comments="")  # fmt: skip
    steps = "".join(
        f'[[tests.S.steps]]\nname = "{name}"\nfrom = "{low} s"\nto = "{high} s"\n'
        for name, low, high in (("one", 0, 100), ("two", 100, 200), ("three", 200, 300))
    )
    control = "load" if what == "position" else "position"
    path = made.write_campaign(
        tmp_path, made.single("S", "cyclic", f'waveform = "sinusoidal"\ncontrol = "{control}"',
                              'strain = { method = "gauge-length" }', steps)
    )  # fmt: skip
    text = path.read_text().replace("[specimens.R-1]", '[specimens.R-1]\ngauge_length = "10 m"')
    path.write_text(text)
    result = run_campaign(
        load_campaign(path), processed=tmp_path / "p", reports=tmp_path / "r", clock=lambda: 0.0
    )
    later = [f"in S.one its mean {what} jumped by" in one.message for one in result.tests]
    assert later == ([False, True, True] if what else [False, False, False])
    if what:
        assert result.tests[0].status == "check"
        found = float(result.tests[1].message.split("jumped by ")[1].split()[0])
        # of a slip that goes on over three cycles the greatest two steps are taken
        assert found == pytest.approx(40 if what == "position" else -4000, rel=0.2)

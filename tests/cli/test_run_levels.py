"""A log of several levels without steps: found, reduced by themselves, printed to be stated."""

import re
import tomllib
from dataclasses import replace

import pytest
from strangers import make

from reduction.batch.survey import survey_campaign
from reduction.campaign.load import load_campaign
from reduction.campaign.plan import StepPlan
from reduction.record.note_sentences import CAUSES

LAW = "rope-creep-levels"


@pytest.fixture(scope="module")
def raw(tmp_path_factory):
    folder = tmp_path_factory.mktemp("levels")
    make(LAW, 3, folder)
    return folder


def run(command, raw, out, *more):
    return command(
        "run", raw / "campaign.toml", "--processed", out / "p", "--reports", out / "r", *more
    )


def steps_of(text):
    (found, *_) = re.findall(r"steps = \[.*?\}\s*\]", text)
    return found


def with_steps(text, steps):
    return text.replace("[tests.R-1]\n", f"[tests.R-1]\n{steps}\n")


def numbers(folder):
    tables = folder / "p" / f"{LAW}-3" / "tables"
    return {path.name: path.read_bytes() for path in tables.glob("*.csv")}


def test_check_prints_steps_that_are_toml_with_times(command, raw):
    done = command("check", raw / "campaign.toml", "--json")
    assert done.returncode == 0, done.stderr
    (line,) = {steps_of(one.replace('\\"', '"')) for one in [done.stdout]}
    steps = tomllib.loads(line)["steps"]
    assert [one["name"] for one in steps] == ["level 1", "level 2", "level 3"]
    assert all(one["from"].endswith(" s") and one["to"].endswith(" s") for one in steps)
    shown = command("check", raw / "campaign.toml")
    assert (
        "ready for a run; the log contains 3 load levels, but no steps are stated" in shown.stdout
    )


def test_steps_that_are_pasted_give_the_same_numbers(command, raw, tmp_path):
    done = run(command, raw, tmp_path)
    assert done.returncode == 0, done.stderr
    stated = tmp_path / "stated"
    stated.mkdir()
    (stated / "R-1.csv").write_bytes((raw / "R-1.csv").read_bytes())
    text = (raw / "campaign.toml").read_text()
    (stated / "campaign.toml").write_text(with_steps(text, steps_of(done.stdout)))
    again = run(command, stated, stated)
    assert again.returncode == 0, again.stderr
    assert "no steps are stated" not in again.stdout
    found, now = numbers(tmp_path), numbers(stated)
    assert found.keys() == now.keys()
    # notes and what the laboratory kept apart, every table is the same
    same = [name for name in found if found[name] == now[name]]
    assert {"moduli.csv", "cycles.csv", "amplitude.csv", "tangent_modulus.csv"} <= set(same)
    page = (tmp_path / "r" / f"{LAW}-3" / "index.html").read_text()
    assert "no steps are stated" in page
    assert "R-1.level-2" in page
    verified = command(
        "verify", tmp_path / "p" / f"{LAW}-3", "--campaign", raw / "campaign.toml"
    )  # fmt: skip
    assert verified.returncode == 0, verified.stdout + verified.stderr


def test_a_stated_step_that_holds_several_levels_is_told(raw):
    campaign = load_campaign(raw / "campaign.toml")
    (name,) = campaign.tests
    plan = campaign.tests[name]
    whole = StepPlan("all", plan.kind, (0.0, 1e6), None, None)
    campaign.tests[name] = replace(plan, steps=(whole,))
    (survey,) = survey_campaign(campaign).surveys
    assert [one.code for one in survey.remarks] == ["cycles-unlike"]
    (said,) = [one for one in survey.notes if one.code == "cycles-unlike"]
    assert str(said).endswith("Declare each level as a step of its own")
    # the first line: a stiffness that "changes at a cycle" is that of another level
    assert said.code in CAUSES


def test_one_level_can_be_asked_for(command, raw, tmp_path):
    done = run(command, raw, tmp_path, "--test", "R-1.level-2", "--quiet")
    assert done.returncode == 0, done.stderr
    archives = sorted(path.name for path in (tmp_path / "p" / f"{LAW}-3").glob("R-1*.nc"))
    assert archives == ["R-1.level-2.nc"]
    done = run(command, raw, tmp_path, "--test", "R-1.level-4")
    assert done.returncode == 2
    assert "was not found in its log" in done.stderr


def test_an_experiment_that_names_the_whole_log_is_told_the_levels(command, raw, tmp_path):
    text = (raw / "campaign.toml").read_text()
    runs = "\n".join(
        f'"R-{place}" = [{", ".join(map(str, code))}]'
        for place, code in enumerate(
            [(-1, -1, 0), (1, -1, 0), (-1, 1, 0), (1, 1, 0), (-1, 0, -1), (1, 0, -1), (-1, 0, 1),
             (1, 0, 1), (0, -1, -1), (0, 1, -1), (0, -1, 1), (0, 1, 1), (0, 0, 0)], start=1,
        )
    )  # fmt: skip
    tests = "\n".join(f'[tests.R-{place}]\nfile = "R-1.csv"' for place in range(2, 14))
    experiment = (
        '[experiments.line]\nkind = "box-behnken"\nresponses = ["apparent_spring_constant"]\n'
        '[experiments.line.factors]\nfrequency = ["0.1 Hz", "0.5 Hz"]\n'
        'mean_tension = ["12 %RBS", "30 %RBS"]\ntension_amplitude = ["5 %RBS", "12 %RBS"]\n'
        f"[experiments.line.runs]\n{runs}\n"
    )
    (tmp_path / "R-1.csv").write_bytes((raw / "R-1.csv").read_bytes())
    (tmp_path / "campaign.toml").write_text(f"{text}\n{tests}\n{experiment}")
    done = command("check", tmp_path / "campaign.toml", "--test", "R-1")
    assert done.returncode == 4, done.stdout + done.stderr
    assert "contains several levels, but experiment 'line' uses it as one" in done.stderr
    assert 'name = "level 1"' in done.stderr

import json

import pytest

LBF = 4.4482216152605
NYLON = "nylon-double-braid-0.5in-new"
LEVELS = (
    "--frequency", "0.3 Hz", "--mean-tension", "21 %RBS", "--tension-amplitude", "8.5 %RBS",
)  # fmt: skip


def test_one_value_with_interval_range_and_source(command):
    done = command("lookup", NYLON, "--quantity", "apparent_spring_constant", *LEVELS, "--json")
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout)
    assert {"value", "unit", "interval", "inside", "source", "errata"} <= answer.keys()
    assert answer["value"] == pytest.approx(3.451e4 * LBF)
    assert answer["unit"] == "N"
    assert answer["interval"][0] < answer["value"] < answer["interval"][1]
    assert answer["inside"] is True
    assert answer["source"] == "CG-D-39-80"
    assert answer["peak_share"] == pytest.approx(0.295)


def test_a_grid_is_a_table(command):
    done = command(
        "lookup", NYLON, "--quantity", "apparent_spring_constant", "--table", "--json",
        "--frequency", "0.1 Hz,0.5 Hz", "--mean-tension", "21 %RBS",
    )  # fmt: skip
    answer = json.loads(done.stdout)
    assert len(answer["value"]) == 6
    assert answer["levels"]["frequency"] == [0.1] * 3 + [0.5] * 3
    text = command("lookup", NYLON, "--quantity", "relaxation_time", "--table", "--units", "us")
    assert "untested corner" in text.stdout


def test_what_there_is(command):
    done = command("lookup", "published", "--list", "--json")
    names = [one["name"] for one in json.loads(done.stdout)["lines"]]
    assert NYLON in names
    assert "rubber-tether-used-T-6" in names
    assert "tangent_modulus" in command("lookup", "rubber-tether-used-T-6").stdout


@pytest.mark.parametrize(
    ("arguments", "status", "told"),
    [
        (("nylon-braid", "--quantity", "loss_factor"), 2, "nylon-double-braid-0.75in-new"),
        ((NYLON, "--quantity", "loss_factor", *LEVELS), 2, "has no loss_factor"),
        ((NYLON, "--quantity", "relaxation_time"), 2, "needs another variable"),
        (
            (NYLON, "--quantity", "relaxation_time", "--frequency", "3 lbf"), 2,
            "--frequency: unit 'lbf'",
        ),
        (
            (
                NYLON, "--quantity", "relaxation_time", "--frequency", "2 Hz", "--mean-tension",
                "21 %RBS", "--tension-amplitude", "8.5 %RBS",
            ),
            4,
            "frequency 2, tested 0.1 to 0.5",
        ),
        (
            (
                NYLON, "--quantity", "relaxation_time", "--frequency", "0.3 Hz",
                "--mean-tension", "8 %RBS", "--tension-amplitude", "9 %RBS", "--extrapolate",
                "flag",
            ),
            4,
            "goes slack",
        ),
        (
            (NYLON, "--quantity", "relaxation_time", *LEVELS[:1], "0.1 Hz,0.2 Hz", *LEVELS[2:]),
            2,
            "several values of a level make a grid",
        ),
    ],
)  # fmt: skip
def test_what_cannot_be_looked_up_ends_with_its_status(command, arguments, status, told):
    done = command("lookup", *arguments)
    assert done.returncode == status, done.stdout + done.stderr
    assert told in done.stderr
    assert "Traceback" not in done.stderr

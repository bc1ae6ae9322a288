"""The commands on small campaigns: what they answer, what they refuse, and what they leave alone."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import smallcampaign
from commandruns import answered
from csvrows import csv_rows

from reduction.archive.open import open_archive

ROOT = Path(__file__).parents[2]
RAW = ROOT / "raw" / "tmt-synthetic"
CAMPAIGN = f"""{smallcampaign.CAMPAIGN}strain = {{ marks = "marks.csv" }}
[tests.A]
file = "A.csv"
n_cycles = 10
[tests.B]
file = "B.csv"
n_cycles = 10
"""


def write_small(folder):
    """Two synthetic logs, their marks, and a campaign."""
    smallcampaign.write_logs(folder)
    (folder / "campaign.toml").write_text(CAMPAIGN)


@pytest.fixture
def small(tmp_path):
    write_small(tmp_path / "raw")
    return tmp_path


@pytest.fixture(scope="session")
def reduced_once(tmp_path_factory, command):
    folder = tmp_path_factory.mktemp("reduced")
    write_small(folder / "raw")
    done = command("run", folder / "raw" / "campaign.toml", "--quiet", cwd=folder)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture
def reduced(reduced_once, tmp_path):
    """The small campaign with its products, to be changed at will."""
    shutil.copytree(reduced_once, tmp_path, dirs_exist_ok=True)
    return tmp_path


def test_check_prints_what_it_found_and_writes_nothing(small, command):
    before = sorted(small.rglob("*"))
    done = command("check", small / "raw" / "campaign.toml", "--json", cwd=small)
    answer = answered(done)
    assert [test["id"] for test in answer["tests"]] == ["A", "B"]
    assert [test["n_cycles"] for test in answer["tests"]] == [10, 10]
    assert answer["tests"][0]["n_rows"] == 7632
    assert sorted(small.rglob("*")) == before


@pytest.mark.slow
def test_a_test_that_did_not_change_is_not_done_again(reduced, command):
    campaign = reduced / "raw" / "campaign.toml"
    product = reduced / "processed" / "small" / "A.nc"
    stamp, content = product.stat().st_mtime_ns, product.read_bytes()
    again = json.loads(command("run", campaign, "--json", cwd=reduced).stdout)
    assert [test["status"] for test in again["tests"]] == ["unchanged", "unchanged"]
    assert product.stat().st_mtime_ns == stamp
    forced = json.loads(command("run", campaign, "--json", "--force", cwd=reduced).stdout)
    assert {test["status"] for test in forced["tests"]} == {"check"}
    assert product.read_bytes() == content
    campaign.write_text(campaign.read_text().replace("1.04 in", "1.01 in"))
    changed = json.loads(command("run", campaign, "--json", "--test", "A", cwd=reduced).stdout)
    assert [test["status"] for test in changed["tests"]] == ["check"]
    assert product.read_bytes() != content
    report = command("report", reduced / "processed", "--json", cwd=reduced)
    assert json.loads(report.stdout)["reports"] == [str(Path("reports/small/index.html"))]


@pytest.mark.slow
def test_a_failed_test_keeps_its_older_product_and_lets_the_others_run(reduced, command):
    campaign = reduced / "raw" / "campaign.toml"
    old, beside = (
        (reduced / "processed" / "small" / name).read_bytes() for name in ("A.nc", "B.nc")
    )
    log = reduced / "raw" / "A.csv"
    lines = log.read_text().splitlines()
    lines[1000] = "99.7,ovrflw,1,1"
    log.write_text("\n".join(lines) + "\n")
    done = command("run", campaign, "--json", cwd=reduced)
    assert done.returncode == 3
    statuses = {test["id"]: test for test in json.loads(done.stdout)["tests"]}
    assert statuses["A"]["status"] == "failed" and statuses["A"]["exit_status"] == 3
    assert "A.csv:1001 [crosshead_ft]" in statuses["A"]["message"]
    assert "ovrflw" in done.stderr and "Traceback" not in done.stderr
    assert (reduced / "processed" / "small" / "A.nc").read_bytes() == old
    assert {
        row["test"]: row["status"]
        for row in csv_rows(reduced / "processed" / "small" / "status.csv")
    }["A"] == "failed"
    # the marks of A can no longer be used: B is made without them, and says which and why
    assert statuses["B"]["status"] == "check"
    assert (reduced / "processed" / "small" / "B.nc").read_bytes() != beside
    with open_archive(reduced / "processed" / "small" / "B.nc") as archive:
        notes = archive["note"].values.tolist()
    for name in ("new", "used"):
        assert (
            f"{name}: 3 of 6 stretched marks belong to tests that failed (A), so their tension is "
            "not known; the tension law is fitted without them"
        ) in notes
    assert not any("no hold in the logs" in note for note in notes)


@pytest.mark.parametrize(
    ("change", "status", "message"),
    [
        (("[tests.A]", "[tests.A"), 2, "is not TOML"),
        (('unit = "ft"', 'unit = "furlongs_x"'), 2, "unit 'furlongs_x' is not known"),
        (('unit = "ft"', 'unit = "lbf"'), 2, "unit 'lbf' is not a unit of length"),
        (('column = "load_new_lb"', 'column = "load"'), 3, "load"),
        (
            ('file = "A.csv"', 'file = "C.csv"'),
            3,
            "C.csv: the file cannot be read; found No such file",
        ),
        (('"pin-to-pin"', '"displacement"'), 2, "displacement"),
    ],
)
def test_settings_that_cannot_be_used_end_with_their_status(
    small, command, change, status, message
):
    campaign = small / "raw" / "campaign.toml"
    campaign.write_text(campaign.read_text().replace(*change))
    done = command("check", campaign, "--quiet", cwd=small)
    assert done.returncode == status, done.stderr
    assert message in done.stderr and "Traceback" not in done.stderr and not done.stdout


def test_an_unknown_test_on_the_command_line_is_refused(small, command):
    done = command("run", small / "raw" / "campaign.toml", "--test", "Z", cwd=small)
    assert done.returncode == 2 and "needed one of A, B" in done.stderr
    assert not (small / "processed").exists()


def test_unknown_units_are_refused(small, command):
    done = command("check", small / "raw" / "campaign.toml", "--units", "imperial", cwd=small)
    assert done.returncode == 2 and "needed si or us" in done.stderr


def test_a_log_in_steps_gives_one_product_a_step(small, command):
    campaign = small / "raw" / "campaign.toml"
    text = campaign.read_text().split("[tests.B]")[0]
    campaign.write_text(
        text.replace("[specimens.new]", '[specimens.new]\nconstruction = "braided, one core"')
        + '[[tests.A.steps]]\nname = "first five"\nfrom = 1\nto = 5\nn_cycles = 5\n'
        "target_strain = [0.5, 1.25]\n"
        '[[tests.A.steps]]\nname = "hold"\nfrom = "150 s"\nto = "320 s"\nkind = "relaxation"\n'
    )
    (small / "raw" / "marks.csv").write_text(
        "\n".join(
            line
            for line in (small / "raw" / "marks.csv").read_text().splitlines()
            if not line.startswith("B,")
        )
    )
    done = command("run", campaign, "--json", cwd=small)
    statuses = {test["id"]: test["n_cycles"] for test in answered(done)["tests"]}
    assert statuses == {"A.first-five": 5, "A.hold": 0}
    names = {path.name for path in (small / "processed" / "small").glob("*.nc")}
    assert names == {"A.first-five.nc", "A.hold.nc"}
    with open_archive(small / "processed" / "small" / "A.first-five.nc") as archive:
        assert archive.attrs["target_strain"] == "0.5 to 1.25"
        assert archive["specimen_construction"].values[0] == "braided, one core"
    with open_archive(small / "processed" / "small" / "A.hold.nc") as archive:
        assert "target_strain" not in archive.attrs
    specimens = (small / "processed" / "small" / "tables" / "specimens.csv").read_text("utf-8")
    assert '"braided, one core"' in specimens


def test_a_step_that_ends_behind_the_log_or_overlaps_another_is_told(small, command):
    campaign = small / "raw" / "campaign.toml"
    steps = '[[tests.A.steps]]\nname = "hold"\nfrom = "150 s"\nto = "9000 s"\nkind = "relaxation"\n'
    campaign.write_text(campaign.read_text() + steps)
    done = command("check", campaign, cwd=small)
    assert "before the stated end of the step at 9000 s" in done.stdout
    assert "overlaps" not in done.stdout
    steps = '[[tests.A.steps]]\nname = "next"\nfrom = "200 s"\nto = "320 s"\nkind = "relaxation"\n'
    campaign.write_text(campaign.read_text() + steps)
    done = command("check", campaign, cwd=small)
    assert "A.hold: the step overlaps the step 'next'" in done.stdout
    assert "A.next: the step overlaps the step 'hold'" in done.stdout


@pytest.mark.slow
def test_a_product_of_no_test_is_named_and_put_aside(reduced, command):
    campaign = reduced / "raw" / "campaign.toml"
    campaign.write_text(campaign.read_text().split("[tests.B]")[0])
    marks = reduced / "raw" / "marks.csv"
    kept = [line for line in marks.read_text().splitlines() if not line.startswith("B,")]
    marks.write_text("\n".join(kept) + "\n")
    done = command("run", campaign, "--quiet", cwd=reduced)
    assert done.returncode == 0
    assert "superseded/B.nc: this campaign no longer makes it" in done.stderr
    assert (reduced / "processed" / "small" / "superseded" / "B.nc").exists()
    assert not (reduced / "processed" / "small" / "B.nc").exists()


@pytest.mark.slow
def test_a_campaign_of_the_same_id_is_told_that_it_replaces_another(reduced, command):
    shutil.copytree(reduced / "raw", reduced / "other" / "raw")
    campaign = reduced / "other" / "raw" / "campaign.toml"
    campaign.write_text(campaign.read_text().replace("n_cycles = 10", "n_cycles = 9"))
    done = command("run", campaign, "--quiet", cwd=reduced)
    assert done.returncode == 0
    assert f"replaced the results of {reduced / 'raw' / 'campaign.toml'}" in done.stderr
    # the same campaign, moved
    shutil.move(reduced / "other", reduced / "moved")
    done = command("run", reduced / "moved" / "raw" / "campaign.toml", "--quiet", cwd=reduced)
    assert done.returncode == 0 and "replaced the results" not in done.stderr


def test_init_quotes_a_path_with_a_blank(small, command):
    (small / "raw" / "campaign.toml").unlink()
    folder = small / "my logs"
    shutil.move(small / "raw", folder)
    done = command("init", folder)
    assert f'reduction check "{folder / "campaign.toml"}"' in done.stdout


def test_sniff_proposes_a_layout_that_a_person_completes(small, command):
    done = command("sniff", small / "raw" / "A.csv")
    assert done.returncode == 0, done.stderr
    assert 'format = "delimited"' in done.stdout and "crosshead_ft" in done.stdout
    assert "layout" in json.loads(command("sniff", small / "raw" / "A.csv", "--json").stdout)


def test_init_writes_a_starter_once_and_never_over_a_file(small, command):
    (small / "raw" / "campaign.toml").unlink()
    done = command("init", small / "raw")
    assert done.returncode == 0, done.stderr
    assert {"campaign.toml", "tests.csv"} <= {path.name for path in (small / "raw").iterdir()}
    assert f"reduction check {small / 'raw' / 'campaign.toml'}" in done.stdout
    again = command("init", small / "raw")
    assert again.returncode == 2 and "the folder already contains a campaign" in again.stderr
    check = command("check", small / "raw" / "campaign.toml")
    assert check.returncode == 2 and "tests.csv:3 [specimens]" in check.stderr


def test_schema_is_json_and_knows_the_sections(command):
    schema = json.loads(command("schema").stdout)
    assert set(schema["properties"]) >= {"campaign", "specimens", "layouts", "defaults", "tests"}


def test_report_without_an_archive_says_what_is_missing(tmp_path, command):
    done = command("report", tmp_path)
    assert done.returncode == 6 and "no archive was found" in done.stderr


def test_the_program_itself_answers_refuses_and_ends_with_its_status(process):
    assert "Reduce a campaign" in process("--help").stdout
    assert process("--version").stdout.startswith("reduction ")
    refused = process("check", "nowhere.toml")
    assert refused.returncode == 2 and not refused.stdout
    assert "cannot be read" in refused.stderr and "Traceback" not in refused.stderr


@pytest.mark.slow
def test_a_log_that_is_not_there_fails_its_own_test_alone(small, command):
    (small / "raw" / "A.csv").unlink()
    done = command("run", small / "raw" / "campaign.toml", "--json", cwd=small)
    assert done.returncode == 3 and "A.csv: the file cannot be read" in done.stderr
    statuses = {test["id"]: test["status"] for test in json.loads(done.stdout)["tests"]}
    assert statuses == {"A": "failed", "B": "check"}


@pytest.mark.parametrize("module", ["main", "campaigns"])
def test_the_start_of_a_command_loads_no_heavy_package(module):
    heavy = {"numpy", "pandas", "scipy", "pint", "xarray", "netCDF4", "pyarrow", "plotly"}
    # a run that finds nothing changed needs no more than the second of these modules
    code = f"import sys, reduction.cli.{module}; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_a_look_up_of_a_published_line_loads_no_package_of_archives_or_tables():
    heavy = {
        "pandas",
        "scipy.interpolate",
        "scipy.optimize",
        "scipy.stats",
        "xarray",
        "netCDF4",
        "pyarrow",
        "plotly",
    }
    code = f"""
import sys
sys.argv = ["reduction", "lookup", "nylon-double-braid-0.5in-new", "--quantity", "K_ap", "--quiet",
            "--frequency", "0.3 Hz", "--mean-tension", "21 %RBS", "--tension-amplitude", "8.5 %RBS"]
from reduction.cli.main import app
try:
    app()
except SystemExit as end:
    print(end.code, sorted({heavy} & set(sys.modules)))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "0 []\n"


@pytest.mark.slow
def test_the_answer_in_the_readme_is_the_one_that_its_command_prints(synthetic, command, tmp_path):
    processed = tmp_path / "processed"
    shutil.copytree(synthetic.processed, processed / "tmt-synthetic")
    done = command(
        "run", RAW / "campaign.toml", "--processed", processed, "--reports", tmp_path / "reports"
    )
    printed = [re.split(r"  +", line.strip()) for line in done.stdout.splitlines()]
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    head, *rows = re.search(r"^```text\n(specimen .*?)^```", text, re.M | re.S)[1].splitlines()
    heads = re.split(r"  +", head.strip())
    # tables of holds and of unlike tests begin with the specimen too
    whole, *_ = [line for line in printed if line[0] == "specimen"]
    places = [whole.index(name) for name in heads]
    answers = [[line[place] for place in places] for line in printed if len(line) == len(whole)]
    assert len(rows) == 2
    assert [re.split(r"  +", row.strip()) for row in rows] == answers[1:3]


@pytest.mark.slow
def test_a_run_in_which_every_test_fails_has_a_page_that_says_so(small, command):
    for name in ("A.csv", "B.csv"):
        (small / "raw" / name).unlink()
    done = command("run", small / "raw" / "campaign.toml", cwd=small)
    assert done.returncode == 3
    assert "report:   reports/small/index.html" in done.stdout
    page = (small / "reports" / "small" / "index.html").read_text(encoding="utf-8")
    assert "A.csv: the file cannot be read" in page and "B.csv: the file cannot be read" in page


@pytest.mark.parametrize(
    "change",
    [
        ('source = "synthetic"', 'source = "synthetic"\nsynthetic = true\ninstitution = "x"'),
        pytest.param(
            ("[defaults]", '[defaults]\nmachine = "linear drive"'), marks=pytest.mark.nightly
        ),
        pytest.param(("[tests.A]", '[tests.A]\ndate = "2026-11-21"'), marks=pytest.mark.nightly),
        ("[tests.A]", "[tests.A]\norder = 1"),
        pytest.param(
            ("[tests.A]", "[tests.A]\ntarget_strain = [0.5, 1.0]"), marks=pytest.mark.nightly
        ),
        ("[tests.A]", "[tests.A]\n[tests.A.reduction.cycles]\nbreak_in_cycles = 1\n[tests.A.x]"),
        ('diameter = ["1.04 in"]', 'diameter = ["1.04 in"]\nnote = "cut from one length"'),
    ],
)
@pytest.mark.slow
def test_whatever_a_product_says_is_part_of_what_makes_it_unchanged(reduced, command, change):
    campaign = reduced / "raw" / "campaign.toml"
    text = campaign.read_text().replace(*change)
    campaign.write_text(text.replace("\n[tests.A.x]", ""))
    if "[tests.A.x]" in text:  # the file key must come before the sub-table
        campaign.write_text(
            CAMPAIGN.replace(
                '[tests.A]\nfile = "A.csv"\nn_cycles = 10',
                '[tests.A]\nfile = "A.csv"\nn_cycles = 10\nreduction.cycles.break_in_cycles = 1',
            )
        )
    done = command("run", campaign, "--json", "--test", "A", cwd=reduced)
    assert answered(done)["tests"][0]["status"] == "check"


@pytest.mark.nightly
@pytest.mark.slow
def test_limits_make_no_archive_again_and_refuse_what_is_beyond_them(reduced, command):
    campaign = reduced / "raw" / "campaign.toml"
    before = (reduced / "processed" / "small" / "A.nc").read_bytes()
    campaign.write_text(CAMPAIGN + '[limits]\nfile_size = "1 GB"\ntime = "5 min"\n')
    again = json.loads(command("run", campaign, "--json", cwd=reduced).stdout)
    assert [test["status"] for test in again["tests"]] == ["unchanged", "unchanged"]
    campaign.write_text(CAMPAIGN + "[limits]\ncolumns = 2\n")
    done = command("run", campaign, "--json", "--force", cwd=reduced)
    assert done.returncode == 3
    assert "raise columns under [limits] of campaign.toml" in done.stderr
    assert (reduced / "processed" / "small" / "A.nc").read_bytes() == before


@pytest.mark.slow
def test_marks_of_a_log_in_steps_serve_the_other_tests_as_before(reduced, command):
    campaign = reduced / "raw" / "campaign.toml"
    archives = reduced / "processed" / "small"
    whole = (archives / "tables" / "tangent_modulus.csv").read_text().splitlines()
    campaign.write_text(
        campaign.read_text()
        + '[[tests.B.steps]]\nname = "first"\nfrom = 1\nto = 5\n'
        + '[[tests.B.steps]]\nname = "second"\nfrom = 6\nto = 10\n'
    )
    done = command("run", campaign, "--json", cwd=reduced)
    assert done.returncode == 0, done.stderr
    split = (archives / "tables" / "tangent_modulus.csv").read_text().splitlines()
    of_a = [line for line in whole if line.startswith("A,")]
    assert of_a and of_a == [line for line in split if line.startswith("A,")]


@pytest.mark.slow
def test_one_test_alone_leaves_the_rows_of_the_others_in_the_status(reduced, command):
    campaign = reduced / "raw" / "campaign.toml"
    assert command("run", campaign, "--quiet", "--test", "B", cwd=reduced).returncode == 0
    rows = {row["test"]: row for row in csv_rows(reduced / "processed" / "small" / "status.csv")}
    assert rows["A"]["status"] == "check" and "after position" in rows["A"]["message"]
    assert rows["B"]["status"] == "unchanged" and "after position" in rows["B"]["message"]


def test_a_failure_is_one_object_too(tmp_path, command):
    done = command("run", tmp_path / "nope.toml", "--json")
    assert done.returncode == 2
    answer = json.loads(done.stdout)
    assert answer["tests"] == [] and "cannot be read" in answer["error"]
    assert json.loads(command("schema", "--json").stdout)["title"] == "CampaignFile"


def test_a_fault_of_one_row_is_told_with_file_row_and_channel(small, command):
    log = small / "raw" / "B.csv"
    lines = log.read_text().splitlines()
    first = next(place for place, line in enumerate(lines) if line[:1].isdigit())
    again = lines[first : first + 200]
    log.write_text("\n".join(lines + again) + "\n")
    done = command("check", small / "raw" / "campaign.toml", "--test", "B", cwd=small)
    assert done.returncode == 4
    place = f"{log}:{len(lines) + 1} [time]: the log has two time bases"
    assert place in done.stderr.replace("\n", " ")


@pytest.mark.slow
def test_a_folder_that_cannot_be_made_is_told_by_its_path(small, command):
    (small / "a.csv").write_text("no folder")
    done = command(
        "run", small / "raw" / "campaign.toml", "--test", "A", "--processed", "a.csv", cwd=small
    )
    assert done.returncode == 6
    assert "a.csv/small/run.lock cannot be written; found Not a directory" in done.stderr


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (("run", "--jobs", "0", "c.toml"), "Invalid value for '--jobs': "),
        (("check", "c.toml", "--colour"), "No such option: --colour"),
        (("check",), "Missing argument 'CAMPAIGN.toml'."),
        (("chek", "c.toml"), "No such command 'chek'."),
        (
            ("sniff", "https://ann:secret@example.org/T.csv?sig=abc"),
            "this command reads no URLs; found 'https://example.org/T.csv'; needed "
            "a local file. Download it first.",
        ),
        (
            ("lookup", "published", "--out", "s3://ann:secret@bucket/a.csv"),
            "this command writes to no URLs; found 's3://bucket/a.csv'; needed a local path",
        ),
        (
            ("check", "https://ann:secret@example.org/c.toml?sig=abc"),
            "this command reads no URLs; found 'https://example.org/c.toml'; needed "
            "a local file. Download it first.",
        ),
    ],
)
def test_a_line_that_cannot_be_used_is_one_line_and_one_object(command, tmp_path, line, message):
    done = command(*line, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert message in done.stderr and done.stderr.count("\n") == 1
    asked = command(*line, "--json", cwd=tmp_path)
    assert asked.returncode == 2 and asked.stderr == done.stderr
    assert json.loads(asked.stdout) == {
        "tests": [], "error": done.stderr.strip(), "exit_status": 2,
    }  # fmt: skip


def test_a_check_shows_the_status_that_its_json_has(small, command):
    campaign = small / "raw" / "campaign.toml"
    shown = command("check", campaign, cwd=small).stdout
    assert "checked" in shown and "ready for a run" in shown
    answer = json.loads(command("check", campaign, "--json", cwd=small).stdout)
    assert {(test["status"], test["message"]) for test in answer["tests"]} == {
        ("no_work", "ready for a run")
    }

"""The command ``diff``: its first line, its tables, its answer in JSON, and how it ends."""

import json
import re
import shutil

import netCDF4
import numpy as np
import pytest
from documentedcampaign import made_without_page
from nopage import leave_out_page

NAME = "two-tethers"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return made_without_page(tmp_path_factory.mktemp("compared"), NAME)


@pytest.fixture
def place(made, tmp_path):
    """The products as they were made, and a copy of them to be changed."""
    shutil.copytree(made / "processed", tmp_path / "processed")
    shutil.copytree(made / "processed", tmp_path / "changed")
    return tmp_path


def change(path, name, by, at=None):
    """Add to one number so many of its standard uncertainties; return both numbers."""
    with netCDF4.Dataset(path, "a") as file:
        file.set_auto_mask(False)
        group = next(one for one in (file, *file.groups.values()) if name in one.variables)
        values, own = group[name][...], group[f"{name}_standard_uncertainty"][...]
        at = at or tuple(np.argwhere(np.isfinite(values) & (own > 0))[0])
        before = values[at]
        values[at] = by(before, own[at])
        group[name][...] = values
    return float(before), float(values[at])


@pytest.mark.nightly
def test_what_is_equal_ends_with_0(made, command):
    for options in ((), ("--exact",)):
        done = command("diff", "processed", f"processed/{NAME}", *options, cwd=made)
        assert (done.returncode, done.stderr) == (0, "")
        assert done.stdout.startswith("0 of ") and done.stdout.count("\n") == 1


@pytest.mark.nightly
def test_the_first_line_names_the_worst(place, command):
    change(place / "changed" / NAME / "T-1.nc", "tangent_modulus", lambda x, u: x + 4.2 * u)
    change(place / "changed" / NAME / "T-1.nc", "test_frequency", lambda x, u: x - 0.6 * u)
    change(place / "changed" / NAME / "T-2.nc", "test_frequency", lambda x, u: x - 0.4 * u)
    done = command("diff", "processed", "changed", cwd=place)
    assert done.returncode == 4 and done.stderr == ""
    first, heads, *rows = done.stdout.splitlines()
    assert first.startswith("2 of ")
    assert (
        " answers moved by more than half their standard uncertainty; 1 changed by less; " in first
    )
    assert "; worst: tangent_modulus of T-1 new ascending strain_bin " in first
    assert first.endswith(" Pa, +4.2 u")
    assert (
        heads.split() == "quantity worst at before after change changed moved added removed".split()
    )
    assert rows[0].startswith("tangent_modulus [Pa]  T-1.nc, new, ascending, strain_bin ")
    assert rows[1].startswith("test_frequency [Hz]  ")
    assert rows[1].split()[-6:] == "-0.6 u 2 1 0 0".split()


@pytest.mark.nightly
def test_units_are_those_that_were_asked_for(place, command):
    before, _ = change(
        place / "changed" / NAME / "T-1.nc", "branch_tension", lambda x, u: x + 9 * u
    )
    done = command("diff", "processed", "changed", "--units", "us", cwd=place)
    assert done.stdout.splitlines()[0].endswith(" lbf, +9 u")
    shown = re.search(r" (\S+) -> \S+ lbf", done.stdout)[1]
    assert float(shown) == pytest.approx(before / 4.4482216152605, rel=1e-2)


@pytest.mark.nightly
def test_a_bit_is_no_move_unless_it_is_asked_for(place, command):
    archive = place / "changed" / NAME / "T-2.nc"
    before, after = change(archive, "test_frequency", lambda x, u: np.nextafter(x, 2 * x))
    assert command("diff", "processed", "changed", cwd=place).returncode == 0
    done = command("diff", "processed", "changed", "--exact", cwd=place)
    assert done.returncode == 4
    assert f"{before!r} -> {after!r} Hz" in done.stdout.splitlines()[0]


def test_the_answer_in_json_has_every_quantity(place, command):
    archive = place / "changed" / NAME / "T-1.nc"
    before, after = change(archive, "test_mean_strain", lambda x, u: x + 2 * u)
    with netCDF4.Dataset(archive, "a") as file:
        file["cycles"].renameVariable("test_mean_tension", "test_average_tension")
        file.setncattr("title", "another")
    moduli = place / "changed" / NAME / "tables" / "moduli.csv"
    moduli.write_text(moduli.read_text().replace("n_cycles", "cycles_used"))
    done = command("diff", f"processed/{NAME}", f"changed/{NAME}", "--json", cwd=place)
    found = json.loads(done.stdout)
    assert (done.returncode, found["status"]) == (4, 4)
    assert found["verdict"].startswith("1 of ")
    (one,) = found["answers"]
    assert (one["file"], one["variable"], one["unit"]) == ("T-1.nc", "test_mean_strain", "1")
    assert (one["before"], one["after"], one["where"]) == (before, after, {"specimen": "new"})
    assert one["shift"] == pytest.approx(2.0)
    assert one["shift"] * one["standard_uncertainty"] == pytest.approx(after - before)
    assert {each["name"] for each in found["added"]} == {
        "cycles/test_average_tension", "cycles_used",
    }  # fmt: skip
    assert {each["name"] for each in found["removed"]} == {
        "cycles/test_mean_tension", "n_cycles",
    }  # fmt: skip
    assert [each["attribute"] for each in found["attributes"]] == ["title"]
    (table,) = found["tables"]
    assert table["file"] == "tables/moduli.csv" and table["columns"] == []
    assert [each["name"] for each in table["added"]] == ["cycles_used"]
    assert (found["moved"], found["history"], found["tests"]) == ([], [], [])


@pytest.mark.nightly
def test_quiet_says_nothing_and_ends_alike(place, command):
    change(place / "changed" / NAME / "T-1.nc", "test_mean_strain", lambda x, u: x + 2 * u)
    done = command("diff", "processed", "changed", "--quiet", cwd=place)
    assert (done.returncode, done.stdout, done.stderr) == (4, "", "")


@pytest.mark.slow
def test_two_campaigns_are_run_and_compared(made, tmp_path, command, monkeypatch):
    leave_out_page(monkeypatch)
    shutil.copytree(made / "raw" / NAME, tmp_path / "wider")
    settings = tmp_path / "wider" / "campaign.toml"
    text = settings.read_text(encoding="utf-8").replace("1.04 in", "1.05 in")
    settings.write_text(text, encoding="utf-8")
    before = made / "raw" / NAME / "campaign.toml"
    done = command("diff", before, settings, "--json", cwd=tmp_path)
    found = json.loads(done.stdout)
    assert done.returncode == 4
    area = next(one for one in found["answers"] if one["variable"] == "area")
    assert area["relative"] == pytest.approx((1.05 / 1.04) ** 2 - 1, rel=1e-6)
    named = [one for one in found["attributes"] if "diameter" in one["attribute"]]
    assert {one["attribute"] for one in named} == {"settings.specimens.new.diameter"}
    assert sorted(one.name for one in tmp_path.iterdir()) == ["wider"]


@pytest.mark.parametrize(
    ("words", "status", "message"),
    [
        (["processed"], 2, "diff compares two things; found A alone; needed A and B, or"),
        (["processed", "processed", "--against", "HEAD"], 2, "found B and --against"),
        (["processed", "--against", "HEAD"], 2, "--against runs a campaign; found processed"),
        (["processed", "none"], 6, "there is no file or folder none"),
        (["processed", "raw"], 6, "raw: no archive was found"),
        (["processed", "raw/two-tethers/marks.csv"], 2, "these two cannot be compared"),
        (
            ["raw/two-tethers/marks.csv", f"processed/{NAME}/tables/columns.csv"],
            4,
            "nothing in common",
        ),
        (["s3://a/b", "processed"], 2, "this command reads no URLs"),
        (["none.toml", "raw/two-tethers/campaign.toml"], 2, "none.toml"),
    ],
)
def test_what_cannot_be_compared_is_one_line(made, command, words, status, message):
    done = command("diff", *words, cwd=made)
    assert (done.returncode, done.stdout) == (status, "")
    assert message in done.stderr and done.stderr.count("\n") == 1

"""From somebody else's log to a number: every edit and every number of docs/published-log.md.

The logs are of third parties and lie beside the project; where they are absent the tests skip.
What was published of the strip is the authors' own table of it; of the silicones the sheet of
their maker and constants that the authors of the log fitted to it.
"""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from measured_logs import LOGS

PAGE = (Path(__file__).parents[2] / "docs" / "published-log.md").read_text(encoding="utf-8")
STRIP, SILICONES = LOGS / "vhb4910", LOGS / "soft-silicones"
RATES = ("0d01_3d0", "0d03_3d0", "0d05_3d0")
PSI = 6894.757
TABLE_AREA, TABLE_LENGTH = 22e-6, 0.08  # of the authors' script and README


def section(title):
    (found,) = re.findall(rf"^## {re.escape(title)}\n(.*?)(?=^## |\Z)", PAGE, re.M | re.S)
    return found


def drafted(command, folder, logs, title):
    """The draft of `init`, with the edits that the page lists."""
    folder.mkdir()
    for log in logs:
        shutil.copyfile(log, folder / log.name)
    assert command("init", folder).returncode == 0
    edits = re.findall(
        r"^\| (campaign\.toml|tests\.csv) \| `(.+?)` \| (.*) \|$", section(title), re.M
    )
    for name, old, new in edits:
        path = folder / name
        text = path.read_text(encoding="utf-8")
        assert old in text, f"nothing to edit: {old}"
        path.write_text(text.replace(old, "\n".join(re.findall("`(.+?)`", new))), encoding="utf-8")
    (added,) = re.findall(r"^```toml\n(.*?)^```$", section(title), re.M | re.S)
    campaign = folder / "campaign.toml"
    campaign.write_text(campaign.read_text(encoding="utf-8") + added, encoding="utf-8")
    counted = int(re.findall(r"(\d+) edits", section(title))[0])
    assert len(edits) + 1 == counted  # what is added at the end is one
    assert command("check", campaign).returncode == 0
    products = ("--processed", folder / "processed", "--reports", folder / "reports")
    assert command("run", campaign, *products).returncode == 0
    return folder / "processed" / folder.name


def number(command, product, quantity, **at):
    """Value and half of the 95 % interval, as `reduction budget` gives them."""
    places = [part for key, value in at.items() for part in ("--at", f"{key}={value}")]
    done = command("budget", product, "--quantity", quantity, *places, "--json")
    found = json.loads(done.stdout)
    return found["value"], found["expanded_uncertainty"]


def published_strip(name):
    """Time, strain and stress of the authors' table; their strain is rate times clock."""
    import python_calamine

    book = python_calamine.CalamineWorkbook.from_path(STRIP / f"{name}.xlsx")
    time, stretch, stress = np.array(book.get_sheet_by_index(0).to_python()[1:], float).T
    return time, stretch - 1, 1e3 * stress


def of_table(strain, stress, turn):
    """Stress at 100 % up, tension there on the way down, work of the loop per length."""
    up, down = slice(0, turn + 1), slice(None, turn, -1)
    return (
        float(np.interp(1, strain[up], stress[up])),
        TABLE_AREA * float(np.interp(1, strain[down], stress[down])),
        TABLE_AREA * float(np.trapezoid(stress, strain)),
    )


def percent(ratio):
    return f"{round(100 * (ratio - 1), 2) + 0.0:+.2f} %"  # no minus before a zero


SHOWN = (
    ("stress at 100 %, up", "kPa", 1e-3, 2),
    ("tension at 100 %, down", "N", 1, 3),
    ("work of the loop", "J/m", 1, 3),
)


@pytest.mark.nightly
@pytest.mark.skipif(
    not STRIP.exists(), reason="docs/published-log.md has the command that fetches it"
)
def test_the_strip_and_its_authors_table(tmp_path, command):
    logs = [STRIP / f"{name}.csv" for name in RATES]
    products = drafted(command, tmp_path / "vhb4910", logs, "A strip pulled and let back")
    rows, offsets = [], []
    for name in RATES:
        product = products / f"{name}.nc"
        here = (
            number(command, product, "stress_at_strain", specimen="strip", strain_level=1),
            number(command, product, "branch_tension", specimen="strip", branch="descending",
                   strain_bin=1.0),
            number(command, product, "test_hysteresis_energy", specimen="strip"),
        )  # fmt: skip
        time, strain, stress = published_strip(name)
        text = (STRIP / f"{name}.csv").read_bytes().decode("gb18030")
        log = np.array(re.findall(r'^"([-\d.]+)","([-\d.]+)"', text, re.M), float)
        turn = int(np.argmax(strain))
        theirs = of_table(strain, stress, turn)
        # the authors' stress at the position that the log has at their times
        at_position = 1e-3 * np.interp(time, *log.T) / TABLE_LENGTH
        offsets.append(float(np.median((at_position - strain)[turn + 5 :])))
        logged = of_table(at_position, stress, turn)
        for (what, unit, scale, digits), (value, half), printed, by_position in zip(
            SHOWN, here, theirs, logged, strict=True
        ):
            rows.append(
                f"| {name} | {what} [{unit}] | {scale * printed:.{digits}f} |"
                f" {scale * value:.{digits}f} ± {scale * half:.{digits}f} |"
                f" {percent(printed / value)} | {percent(by_position / value)} |"
            )
            # what their clock does not explain is a small part of the interval
            assert abs(by_position - value) < 0.15 * half
        assert abs(theirs[0] - here[0][0]) < 0.1 * here[0][1]
    assert [row for row in rows if row not in PAGE] == []
    assert "too small by {:.3f}, {:.3f} and {:.3f}".format(*offsets) in PAGE
    shown = re.findall(r"^```text\n(stress_at_strain, specimen strip.*?)^```$", PAGE, re.M | re.S)
    done = command("budget", products / "0d03_3d0.nc", "--quantity", "stress_at_strain",
                   "--at", "specimen=strip", "--at", "strain_level=1")  # fmt: skip
    assert shown == [done.stdout]


def ogden(constants, stretch):
    """The formula of the notebook of the database."""
    size, power = np.split(np.asarray(constants), 2)
    each = stretch[..., None] ** (power - 1) - stretch[..., None] ** (-power / 2 - 1)
    return (2 * size * each).sum(axis=-1)


PRINTED = (0.021561698476583308, 0.07121106958115447, 0.008152239569779961,
           3.336151800687571, 3.336174527094276, 3.3362252145791564)  # fmt: skip


@pytest.mark.skipif(not SILICONES.exists(), reason="logs of third parties are beside the project")
def test_the_silicones_their_sheet_and_their_constants(tmp_path, command):
    from scipy.optimize import least_squares

    rows, here = [], {}
    for grade, sheet in ((20, 49.0), (30, 86.0)):
        log = SILICONES / f"Dragon Skin {grade}.csv"
        products = drafted(
            command, tmp_path / f"silicone-{grade}", [log], "Silicones pulled to failure"
        )
        (name,) = (path.stem for path in products.glob("*.nc"))
        value, half = here[grade] = number(
            command, products / f"{name}.nc", "stress_at_strain", strain_level=1
        )
        strain, stress = np.genfromtxt(log, delimiter=";", skip_header=18, usecols=(3, 4)).T
        # the strain of the log at which the stress of the sheet is reached
        needed = float(np.interp(sheet * PSI, 1e6 * stress, strain))
        rows.append(
            f"| Dragon Skin {grade} | {sheet:.0f} psi = {sheet * PSI / 1e3:.0f} kPa |"
            f" {value / 1e3:.0f} ± {half / 1e3:.0f} kPa |"
            f" {100 * (sheet * PSI / value - 1):+.0f} % | {needed:.2f} |"
        )

    log = SILICONES / "Dragon Skin 20.csv"
    true_strain, true, strain, nominal = np.genfromtxt(
        log, delimiter=";", skip_header=18, usecols=(1, 2, 3, 4)
    ).T
    at_double = float(ogden(PRINTED, np.array([2.0]))[0])
    for what, printed in (
        ("as its heading says, nominal stress", at_double),
        ("as it was fitted, true stress: divided by the stretch of 2", at_double / 2),
    ):
        rows.append(f"| {what} | {1e3 * printed:.0f} | {1e3 * printed / (here[20][0] / 1e3):.2f} |")
    # their constants, three times one pair, come out of the true stress of the whole pull
    stretch = np.exp(true_strain)
    again = least_squares(lambda one: ogden(one, stretch) - true, (0.1, 3.0), method="lm")
    size, power = np.split(np.array(PRINTED), 2)
    assert again.x == pytest.approx([size.sum(), power.mean()], rel=1e-4)
    # and the stress of the log out of the same formula and the nominal stress of the first part
    for most in (1, 2, 3):
        part = strain <= most
        fit = least_squares(lambda one, part=part: ogden(one, stretch[part]) - nominal[part],
                            (0.05, 2.0), method="lm")  # fmt: skip
        value = 1e6 * float(ogden(fit.x, np.array([2.0]))[0])
        assert abs(value - here[20][0]) < here[20][1]
        rows.append(
            f"| nominal stress up to {100 * most} % | {value / 1e3:.0f} | {value / here[20][0]:.2f} |"
        )
    assert [row for row in rows if row not in PAGE] == []


@pytest.mark.parametrize(("kind", "is_told"), [("elastomer", False), ("rubber tether", True)])
def test_an_elastomer_may_let_its_tension_lead_as_no_tether_does(tmp_path, command, kind, is_told):
    # a loss factor of tan(2 pi 0.1) = 0.73: acrylic foam tape has it, natural rubber has not
    time = np.arange(0, 100, 0.1)
    turn = 2 * np.pi * time / 10
    travel, load = 50 - 40 * np.cos(turn), 50 - 40 * np.cos(turn + 2 * np.pi * 0.1)
    rows = "\n".join(f"{t:.1f},{x:.4f},{f:.4f}" for t, x, f in zip(time, travel, load, strict=True))
    (tmp_path / "log.csv").write_text(f"time,position,load\n{rows}\n")
    (tmp_path / "campaign.toml").write_text(f"""
[campaign]
id = "lead"
title = "A sine whose tension leads (synthetic)"
source = "synthetic"
[specimens.one]
kind = "{kind}"
area = "100 mm2"
gauge_length = "100 mm"
[layouts.log]
format = "delimited"
[layouts.log.channels]
time = {{ column = "time", unit = "s" }}
crosshead_position = {{ column = "position", unit = "mm", datum = "displacement", reference_length = "100 mm" }}
tension.1 = {{ column = "load", unit = "N" }}
[tests.A]
file = "log.csv"
layout = "log"
specimens = ["one"]
""")
    done = command("check", tmp_path / "campaign.toml")
    assert done.returncode == 0
    assert ("tension leads position" in done.stdout) is is_told

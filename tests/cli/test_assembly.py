"""The command assembly: the deployed moorings of WHOI-2005-10, and what is refused.

What the report gives, and what is assumed, stands in `test_whoi_2005_10_assemblies`.
"""

import csv
import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from commandruns import answered

DOCS = Path(__file__).parents[2] / "docs" / "assemblies"
RAW = Path(__file__).parents[2] / "raw" / "tmt-synthetic"
LBF = 4.4482216152605
SPEC = """
[assembly]
n_tethers = 2
free_length = "8 m"
[assembly.curve]
source = "rubber-tether-used"
"""


def written(folder, text=SPEC):
    path = folder / "spec.toml"
    path.write_text(text, encoding="utf-8")
    return path


def assembly(command, path):
    done = command("assembly", path, "--json")
    assert done.returncode in (0, 4), done.stderr
    found = json.loads(done.stdout)
    # what is in doubt where a mooring works ends with 4, and what is not does not
    assert (done.returncode == 4) == bool(found["doubts"])
    return found


@pytest.mark.parametrize(
    ("name", "n_tethers", "stated"), [("new-hampshire", 4, 350), ("globec", 6, 500)]
)
def test_the_deployed_tension_is_the_stated_one_within_the_scatter(
    command, name, n_tethers, stated
):
    found = assembly(command, DOCS / f"{name}.toml")
    assert found["n_tethers"] == n_tethers
    point = found["working"][0]
    assert point["tether_strain"] == pytest.approx([1.0] * n_tethers)
    spread = point["tension_standard_uncertainty"]
    assert abs(point["mean_tension"] - stated * LBF) < spread
    assert 0.12 < spread / point["mean_tension"] < 0.18  # 14 to 18 % between the tests
    assert point["load_share"] == pytest.approx([1 / n_tethers] * n_tethers)
    assert point["is_tested"] is True


def test_under_way_the_tethers_stay_inside_the_tests_and_far_from_their_strength(command):
    """400 to 800 lbf on four tethers; one breaks at something like 800 lbf (section 2.3.2)."""
    found = assembly(command, DOCS / "new-hampshire.toml")
    point = found["working"][1]
    assert point["minimum_tension"] / LBF == pytest.approx(400)
    assert point["peak_tether_tension"] == pytest.approx([200 * LBF] * 4)
    assert point["peak_share"] == pytest.approx([0.25] * 4)
    assert point["is_tested"] is True
    sharing = point["sharing"]
    assert sharing["least_load"] < 150 * LBF < sharing["greatest_load"]


def test_length_is_that_of_the_rubber_its_splices_and_the_bridles(command):
    """8.8 m and 1.1948 m of splices, which strain by 0.2177 of what the rubber does; 1 m rigid."""
    found = assembly(command, DOCS / "new-hampshire.toml")
    splices = 12.26 * 0.3048 - 8.34 * 0.3048
    assert found["total_length"][0] == pytest.approx(8.8 + splices + 1.0)
    at_100 = found["working"][0]["total_length"]
    assert at_100 == pytest.approx(2 * 8.8 + splices * 1.21774 + 1.0, abs=1e-4)
    slack = found["total_length"][0]
    assert found["strain"] == pytest.approx(np.array(found["total_length"]) / slack - 1)


def test_tethers_of_a_campaign_have_the_splices_of_their_strain_correction(
    command, synthetic, tmp_path
):
    files = [str(synthetic.processed / f"T-{number}.nc") for number in (1, 2)]
    text = f"""
[assembly]
n_tethers = 3
[assembly.curve]
source = {json.dumps(files)}
specimen = "new"
branch = "ascending"
precedence = ["cyclic"]
[[assembly.working]]
tension = "1200 N"
"""
    found = assembly(command, written(tmp_path, text))
    assert found["synthetic"] is True
    assert "by mixed" in found["sources"][0]
    strain, length = found["working"][0]["tether_strain"][0], found["working"][0]["total_length"]
    told = dict(re.findall(
        r"(relaxed free length|relaxed splice length|splice \w+(?: \w+)?) (-?[\d.]+)",
        found["sources"][0],
    ))  # fmt: skip
    law = {name: float(value.rstrip(".")) for name, value in told.items()}
    # the slack rows of the tape say 2.5547 and 1.1821 m, each to 2 mm; the stretched rows, by how
    # much the splices settle, of which 3 % is known beforehand
    assert abs(law["splice offset"]) < 0.03
    settled = 3.7368 + 1.1821 * law["splice offset"]
    assert found["slack_length"] == pytest.approx([settled] * 3, abs=3e-3)
    stretched = (
        law["splice offset"] + law["splice strain ratio"] * strain
        + law["splice strain curvature"] * strain**2
        + law["splice compliance"] * 400 ** law["splice exponent"]
        + law["splice limit"] * (1 - np.exp(-400 * law["splice saturation"]))
    )  # fmt: skip
    splices = law["relaxed splice length"] * (1 + stretched)
    assert length == pytest.approx(law["relaxed free length"] * (1 + strain) + splices, abs=2e-3)


def test_one_tether_is_its_own_log(command, synthetic, tmp_path):
    """Crosshead and load of the raw log of T-2, as it rises in its last eight cycles."""
    text = f"""
[assembly]
n_tethers = 1
[assembly.curve]
source = {json.dumps(str(synthetic.processed / "T-2.nc"))}
specimen = "used"
branch = "ascending"
precedence = ["cyclic"]
"""
    found = assembly(command, written(tmp_path, text))
    raw = pd.read_csv(RAW / "T-2.csv", comment="#")
    length, load = 0.3048 * raw.crosshead_ft.to_numpy(), LBF * raw.load_used_lb.to_numpy()
    rising = np.gradient(length) > 0.02  # 1 ft/s at 10 Hz is 0.03 m a sample
    late = np.arange(length.size) > np.flatnonzero(length > 8.0)[0] + 300
    inner = rising & late & (length > 5.8) & (length < 7.6)
    assert np.count_nonzero(inner) > 400
    level = np.interp(length[inner], found["total_length"], found["tension"])
    # cycles differ by 2 to 3 %, the first one most
    assert np.median(load[inner] / level - 1) == pytest.approx(0, abs=0.01)
    assert np.abs(load[inner] / level - 1).max() < 0.06


def test_unequal_tethers_share_by_their_lengths(command, tmp_path):
    text = SPEC.replace('n_tethers = 2\nfree_length = "8 m"', 'free_lengths = ["8 m", "8.4 m"]')
    path = written(tmp_path, text + '[[assembly.working]]\ntension = "200 lbf"\n')
    point = assembly(command, path)["working"][0]
    assert point["tether_tension"][0] > point["tether_tension"][1]
    assert sum(point["tether_tension"]) == pytest.approx(200 * LBF)
    done = command("assembly", path, "--units", "us", "--out", tmp_path / "a.csv")
    assert "the longest tether below" in done.stdout
    assert "greatest, least [lbf]" in done.stdout
    table = pd.read_csv(tmp_path / "a.csv")
    first, second = (table[f"tether_tension_{number} [lbf]"] for number in (1, 2))
    assert (first + second).to_numpy() == pytest.approx(table["tension [lbf]"].to_numpy())
    assert (first > second)[1:].all()


def test_a_stated_strength_stands_before_that_of_the_source(command, tmp_path):
    point = '[[assembly.working]]\ntension = "200 lbf"\n'
    for stated, share in (("", 0.125), ('rated_break_strength = "400 lbf"\n', 0.25)):
        text = SPEC.replace("[assembly.curve]", f"{stated}[assembly.curve]") + point
        found = assembly(command, written(tmp_path, text))["working"][0]
        assert found["peak_share"] == pytest.approx([share] * 2)


def test_stated_splices_stand_before_the_published_ones(command, tmp_path):
    for law, splices in (
        ("", 2.0),
        ('strain_ratio = "50 %"', 2.0 * 1.5),
        ('strain = "40 %"\nat_tension = "85 lbf"', None),
    ):
        text = f'{SPEC}[assembly.splices]\nlength = "2 m"\n{law}\n[[assembly.working]]\nstrain = "100 %"\n'
        found = assembly(command, written(tmp_path, text))
        assert found["slack_length"] == pytest.approx([10.0] * 2)
        point = found["working"][0]
        if splices is None:
            splices = 2.0 * (1 + 0.4 * point["tether_tension"][0] / (85 * LBF))
        assert point["total_length"] == pytest.approx(16.0 + splices, abs=1e-3)
    bare = written(tmp_path, f'{SPEC}[assembly.splices]\nlength = "0 m"\n')
    assert assembly(command, bare)["slack_length"] == pytest.approx([8.0] * 2)


def test_a_spring_in_line_takes_its_share(command, tmp_path):
    part = '[[assembly.parts]]\nname = "nylon"\nlength = "5 m"\nspring_constant = "10 kN"\n'
    point = '[[assembly.working]]\ntension = "1 kN"\n'
    alone = assembly(command, written(tmp_path, SPEC + point))["working"][0]
    found = assembly(command, written(tmp_path, SPEC + part + point))["working"][0]
    assert found["total_length"] - alone["total_length"] == pytest.approx(5.0 * 1.1)


def test_every_node_is_written(command, tmp_path):
    path = written(tmp_path)
    done = command("assembly", path, "--out", tmp_path / "a.csv", "--units", "us")
    assert done.returncode == 4, done.stderr  # far from a test at a strain of 142 %
    assert done.stdout.splitlines()[1].startswith("DOUBTFUL: the curve is up to ")
    assert "slack below 30.167 ft" in done.stdout and "not tested" in done.stdout
    with (tmp_path / "a.csv").open(newline="", encoding="utf-8") as lines:
        rows = list(csv.reader(lines))
    assert rows[0][:3] == [
        "total_length [ft]", "tension [lbf]", "tension_standard_uncertainty [lbf]",
    ]  # fmt: skip
    assert "tether_tension [lbf]" in rows[0] and "is_tested" in rows[0]
    found = assembly(command, path)
    tension = [float(row[1]) * LBF for row in rows[1:]]
    assert tension == pytest.approx(found["tension"], rel=1e-9, abs=1e-9)
    assert command("assembly", path, "--quiet").stdout == ""
    page = tmp_path / "a.html"
    assert command("assembly", path, "--out", page).returncode == 4
    assert "2 x rubber-tether-used" in page.read_text(encoding="utf-8")


def test_an_assembly_is_exported_as_one_line(command, tmp_path):
    path = written(tmp_path)
    done = command("export", path, "--to", "json", "--out", tmp_path / "a.json", "--json")
    answer = answered(done)
    found = assembly(command, path)
    written_ = json.loads((tmp_path / "a.json").read_text())["values"]
    assert written_["tension"] == pytest.approx(found["tension"])
    assert written_["strain"] == pytest.approx(found["strain"])
    assert answer["curve"].startswith("assembly of 2 x rubber-tether-used, free length 8 m")
    assert any(f"unstretched length of the whole assembly, {found['total_length'][0]:.6g} m" in note
               for note in answer["notes"])  # fmt: skip
    deck = command(
        "export", path, "--to", "moordyn", "--out", tmp_path / "a.dat", "--diameter", "60 mm",
        "--linear-density", "2 kg/m",
    )  # fmt: skip
    assert deck.returncode == 0, deck.stderr
    for arguments, told in (
        (["--to", "moordyn"], "the diameter of spec is not known"),
        (
            ["--to", "csv", "--curve", "ascending"],
            "curve of an assembly is set in its specification",
        ),
        (["--to", "csv", "--frequency", "0.1 Hz"], "have no effect for an assembly"),
    ):
        done = command("export", path, *arguments, "--out", tmp_path / "x")
        assert done.returncode == 2
        assert told in done.stderr


LEVEL = "[[assembly.working]]\n"


@pytest.mark.parametrize(
    ("replaced", "added", "status", "told"),
    [
        (("n_tethers = 2", "n_tethers = 0"), "", 2, "assembly.n_tethers"),
        (("n_tethers = 2", "tethers = 2"), "", 2, "assembly.tethers: is not a known key"),
        (("n_tethers = 2\n", ""), "", 2, "state the number of tethers once; found"
                                         " neither"),
        (("n_tethers = 2", 'n_tethers = 2\nfree_lengths = ["8 m"]'), "", 2, "of tethers once; found"
                                                                            " both"),
        (("n_tethers = 2", 'free_lengths = ["8 m"]'), "", 2, "free_length and free_lengths are both stated"),
        (('free_length = "8 m"', 'free_length = "-8 m"'), "", 2, "assembly.free_length: is not"
                                                                 " positive"),
        (('free_length = "8 m"', 'free_length = "8 lbf"'), "", 2, "assembly.free_length: unit 'lbf'"),
        (('free_length = "8 m"', 'free_length = "?"'), "", 2, "1 value is still '?'"),
        (('n_tethers = 2\nfree_length = "8 m"', 'free_lengths = ["8 m", "0 m"]'), "", 2,
         "assembly.free_lengths.2: is not positive"),
        (('n_tethers = 2\nfree_length = "8 m"', 'free_lengths = ["8 m", "80 m"]'), "", 4,
         "assembly: a tether is at the end of its curve before another one is taut"),
        (("n_tethers = 2", 'n_tethers = 2\ntolerance = "200 %"'), LEVEL + 'strain = "1"', 2,
         "assembly.tolerance is not a fraction of a length"),
        (("n_tethers = 2", 'n_tethers = 1\ntolerance = "1 %"'), LEVEL + 'strain = "1"', 2,
         "assembly.tolerance applies only to two or more identical tethers; found one tether"),
        (("n_tethers = 2", 'n_tethers = 2\ntolerance = "1 %"'), "", 2, "assembly.tolerance needs"
                                                                       " a working tension"),
        (("n_tethers = 2", 'n_tethers = 2\nrated_break_strength = "-5 lbf"'), "", 2,
         "assembly.rated_break_strength: is not positive"),
        (('"rubber-tether-used"', '"rubber-tether-old"'), "", 2, "assembly.curve: unknown source"),
        (('"rubber-tether-used"', '""'), "", 2, "assembly.curve.source is empty"),
        (('"rubber-tether-used"', '"rubber-tether-used"\nbranch = "mean"'), "", 2,
         "assembly.curve: rubber-tether-used has only its ascending branch"),
        (('"rubber-tether-used"', '"rubber-tether-used"\nbranch = "loop"'), "", 2, "assembly.curve.branch"),
        (('"rubber-tether-used"', '"rubber-tether-used"\nprecedence = []'), "", 2,
         "assembly.curve.precedence: the precedence names no known kind"),
        (('"rubber-tether-used"', '"rubber-tether-used"\nprecedence = ["static"]'), "", 4,
         "assembly.curve: rubber-tether-used: no piece is of a kind"),
        (None, '[[assembly.parts]]\nname = "chain"\nlength = "-1 m"', 2, "assembly.parts.chain:"
                                                                         " chain has no length"),
        (None, '[[assembly.parts]]\nlength = "1 m"\nspring_constant = "0 N"', 2,
         "assembly.parts.1: the spring constant of part 1 is not positive"),
        (None, '[assembly.splices]\nlength = "-1 m"', 2, "assembly.splices.length is not a number"
                                                         " of a splice"),
        (None, '[assembly.splices]\nlength = "1 m"\nstrain = 0.4', 2, "strain and at_tension"
                                                                      " go together"),
        (None, '[assembly.splices]\nlength = "1 m"\nat_tension = "9 N"', 2, "found at_tension alone"),
        (None, '[assembly.splices]\nlength = "1 m"\nstrain_ratio = 0.2\nstrain = 0.4\nat_tension = "9 N"', 2,
         "strain_ratio and strain are two laws"),
        (None, '[assembly.splices]\nlength = "1 m"\nexponent = 3.0', 2, "exponent is not a number"
                                                                        " of a splice"),
        (None, LEVEL, 2, "assembly.working.1: state one working level; found"
                         " nothing"),
        (None, LEVEL + 'strain = "1"\ntension = "9 N"', 2, "found tension, strain"),
        (None, LEVEL + 'tension = "-9 N"', 2, "assembly.working.1.tension: is not positive"),
        (None, LEVEL + 'tension = "9 N"\ntension_amplitude = "-1 N"', 2, "assembly.working.1.tension_amplitude: is negative"),
        (None, LEVEL + 'tension = "90 kN"', 4, "assembly.working.1: the peak tension is beyond the"
                                               " curves"),
        (None, LEVEL + 'tension = "100 N"\ntension_amplitude = "200 N"', 4, "assembly.working.1: "),
        (None, LEVEL + 'total_length = "5 m"', 4, "the assembly is slack at this total length"),
        (None, LEVEL + 'total_length = "99 m"', 4, "beyond its curve at this total length"),
        (None, LEVEL + 'strain = "400 %"', 4, "beyond its curve at this strain"),
        (('n_tethers = 2\nfree_length = "8 m"', 'free_lengths = ["8 m", "8.1 m"]'), LEVEL + 'strain = "1"', 2,
         "assembly.working.1.strain: tethers of different length have no common strain"),
        (("[assembly]", "[tethers]"), "", 2, "spec.toml: "),
    ],
)  # fmt: skip
def test_nonsense_is_refused_with_file_and_key(command, tmp_path, replaced, added, status, told):
    text = SPEC if replaced is None else SPEC.replace(*replaced)
    assert text != SPEC or added
    path = written(tmp_path, text + added + "\n")
    done = command("assembly", path)
    assert done.returncode == status, done.stderr
    assert told in done.stderr
    assert str(path) in done.stderr
    assert "internal error" not in done.stderr


def test_a_specification_that_is_not_there_and_a_table_of_no_format(command, tmp_path):
    done = command("assembly", tmp_path / "none.toml")
    assert (done.returncode, "the assembly cannot be read" in done.stderr) == (2, True)
    done = command("assembly", written(tmp_path), "--out", tmp_path / "a.xls")
    assert (done.returncode, "ends in .csv" in done.stderr) == (2, True)


def test_a_source_that_knows_no_splices_asks_for_them(command, static, tmp_path):
    text = f'[assembly]\nn_tethers = 2\n[assembly.curve]\nsource = "{static.processed}"\n'
    done = command("assembly", written(tmp_path, text))
    assert done.returncode == 2
    assert "assembly.splices: the tests of short-tether do not give the splices" in done.stderr
    done = command("assembly", written(tmp_path, f'{text}[assembly.splices]\nlength = "0 m"\n'))
    assert done.returncode == 2
    assert "assembly.free_length: the tests of short-tether do not give it" in done.stderr
    whole = text.replace("= 2\n", '= 2\nfree_length = "2 m"\n')
    done = command("assembly", written(tmp_path, f'{whole}[assembly.splices]\nlength = "0 m"\n'))
    assert done.returncode == 0, done.stderr


def test_folders_are_looked_for_beside_the_specification(command, synthetic):
    path = synthetic.processed.parent / "beside.toml"
    path.write_text(
        '[assembly]\nn_tethers = 1\n[assembly.curve]\nsource = "tmt-synthetic"\n', encoding="utf-8"
    )
    done = command("assembly", path)
    assert done.returncode == 2
    assert "assembly.curve: " in done.stderr and "several specimens; found new, used" in done.stderr


def test_the_deck_of_an_assembly_has_its_slack_length(command, tmp_path):
    """8.8 m of rubber, 3.92 ft of splices (Table 3) and 1 m of bridle, in deck and header."""
    done = command(
        "export", DOCS / "new-hampshire.toml", "--to", "moordyn", "--out", tmp_path / "a.dat",
        "--diameter", "60 mm", "--linear-density", "2 kg/m",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "a.dat").read_text()
    (row,) = re.findall(r"^1 new-hampshire 1 2 (\S+) ", text, re.MULTILINE)
    assert float(row) == pytest.approx(8.8 + 3.92 * 0.3048 + 1.0, abs=1e-9)
    assert f"whole assembly, {float(row):.6g} m: this is the length of the line in the deck" in (
        " ".join(text.split())
    )


def test_the_stiffness_of_a_cycle_is_that_of_the_tests_that_cover_it(command):
    """Table 6: 100 to 200 lbf of T-4 (70 to 190) and T-5 (112 to 237); T-3 ends at 160 lbf.

    T-4 has 112 to 190 lbf between strains of 1.4532 and 1.93, T-5 between 1.72 and 2.0397; four
    tethers of 8.8 m with splices of 1.1948 m that strain by 0.2177 of it, 10.995 m at slack.
    """
    path = DOCS / "new-hampshire.toml"
    found = assembly(command, path)
    state = found["working"][1]
    strain = np.array([np.diff(np.interp([112, 190], load, at))[0] for load, at in (
        ([70, 120, 190], [1.05, 1.53, 1.93]), ([112, 170, 237], [1.72, 1.98, 2.18]),
    )])  # fmt: skip
    expected = found["total_length"][0] * 4 * 78 / ((8.8 + 1.1948 * 0.2177) * strain)
    by_name = {one["words"]: one for one in state["tests"]}
    both = [by_name[name]["spring_constant"] / LBF for name in ("T-4 cycles", "T-5 cycles")]
    assert both == pytest.approx(expected, rel=1e-3)
    assert expected == pytest.approx([794, 1184], abs=1)
    assert by_name["T-3 cycles"]["covered"] == pytest.approx(0.6)
    assert by_name["T-3 cycles"]["spring_constant"] is None
    assert (state["common_low"] / LBF, state["common_high"] / LBF) == pytest.approx((448, 760))
    # the slopes of both at the mean of 150 lbf are those of the segments there
    near = found["total_length"][0] * 4 / 9.06 * np.array([70 / 0.40, 58 / 0.26])
    assert near == pytest.approx([850, 1083], abs=2)
    assert near[0] < state["secant_spring_constant"] / LBF < near[1]
    assert state["nearest_test"] == "T-4 cycles"
    least, greatest = (state[f"{name}_spring_constant"] / LBF for name in ("least", "greatest"))
    # a load to the pound at either end of 78 lbf, k = 1.96
    half = 1.96 * np.sqrt(2 / 12) / 78
    assert (least, greatest) == pytest.approx(expected * (1 + half * np.array([-1, 1])), rel=2e-3)
    told = command("assembly", path, "--units", "us").stdout.splitlines()
    assert told[1].startswith("DOUBTFUL: working.2: over the loads of T-4 cycles and T-5 cycles")
    (line,) = (line for line in told if line.startswith("working.2"))
    assert "T-4 cycles 794.1, T-5 cycles 1184" in line
    assert "T-4 cycles is nearest in mean and amplitude" in line


def test_no_stiffness_along_the_curve_is_softer_or_stiffer_than_the_tests_there(command):
    """Segments of Table 6 and of T-4 after 3,000 cycles: loads, and pounds per unit strain."""
    segments = np.array([
        (63, 118, 125), (50, 98, 96), (98, 139, 124.2), (88, 160, 160), (70, 120, 104.2),
        (120, 190, 175), (112, 170, 223.1), (170, 237, 335), (135, 230, 306.5), (230, 320, 529.4),
        (68, 113, 81.8), (113, 153, 125),
    ])  # fmt: skip
    found = assembly(command, DOCS / "new-hampshire.toml")
    length, tension = np.array(found["total_length"]), np.array(found["tension"]) / 4 / LBF
    value = np.array(found["secant_spring_constant"], dtype=float) / (4 * LBF * length[0] / 9.06)
    known = np.isfinite(value)
    assert known.sum() > 300
    assert tension[known][0] == pytest.approx(55, abs=8)
    for low, high, one in zip(
        np.interp(0.95 * length, length, tension)[known],
        np.interp(1.05 * length, length, tension)[known],
        value[known],
        strict=True,
    ):
        slope = segments[(segments[:, 0] < high) & (segments[:, 1] > low), 2]
        assert slope.min() * 0.99 < one < slope.max() * 1.01


def test_the_uncertainty_of_a_working_state_is_expanded_and_says_so(command):
    path = DOCS / "new-hampshire.toml"
    found, said = assembly(command, path), command("assembly", path, "--units", "us").stdout
    half = 1.96 * found["working"][0]["tension_standard_uncertainty"] / LBF
    told = re.search(r"working\.1: [\d.]+ lbf \+- (\d+) \(95 %, k = 1\.96\) at ", said)
    assert float(told[1]) == pytest.approx(half, abs=0.5)

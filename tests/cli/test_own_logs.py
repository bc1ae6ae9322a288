"""From a raw log of somebody's machine to a right number: draft, the listed edits, check, run.

Right is what the machine itself made of the test, or what a few lines here make of its file.
The logs are of third parties and lie beside the project; docs/own-logs.md has the table.
"""

import csv
import json
import re
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from measured_logs import LOGS, needs_measured_logs

PAGE = Path(__file__).parents[2] / "docs" / "own-logs.md"

ELASTOMER = (r'kind = "\?"', 'kind = "elastomer"')
OTHER = (r'kind = "\?"', 'kind = "other"')
NO_AREA = (r'diameter = \["\?"\].*\n', "")
TENSILE = ('kind = "cyclic"', 'kind = "tensile"')
SINE = (r'(control = "position".*)', r"\1" + '\nwaveform = "sinusoidal"')


def answer(key, value):
    """Replace one question by an answer."""
    return rf'{key} = "\?"', f'{key} = "{value}"'


def areas(text):
    return r'diameter = \["\?"\]', text


def channel(key, text):
    return rf"(?m)^(# )?{re.escape(key)} = .*\?.*", text


def compressed():
    """A machine that pushes, and logs both of its channels below zero."""
    return [
        (r"(crosshead_position = .*) }", r"\1, sign = -1 }"),
        (r"(tension\.1 = .*) }", r"\1, sign = -1 }"),
    ]


def of_cycles(tree, name):
    return tree["cycles"][name].values[0]


def trends(path, gauge):
    """Frequency and half the range of strain of each cycle, as the machine itself wrote them."""
    with path.open(encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    low, high = (
        np.array([float(row[f"Position:{end} (mm)"]) for row in rows])
        for end in ("Minimum", "Maximum")
    )
    return np.array([float(row["PC:Frequency (Hz)"]) for row in rows]), (high - low) / 2 / gauge


def wave_matrix(tree, name, within):
    """Cycles 2 to the last whole one against the trends file of the machine."""
    frequency, strain = trends(LOGS / "instron-elastomer" / name, 30.0)
    whole = slice(*within)
    np.testing.assert_allclose(
        of_cycles(tree, "strain_amplitude")[whole], strain[whole], rtol=0.012
    )
    np.testing.assert_allclose(of_cycles(tree, "frequency")[whole], frequency[whole], rtol=0.02)


def zwick(tree):
    # Dehnung bei Fmax 306.402 %, Kraftmaximum 37.9483 N/mm2 of 11.4 mm x 0.2 mm, in its preamble
    programme = tree["programme"]
    assert float(programme["pull_peak_strain"][0]) == pytest.approx(3.06402, rel=1e-5)
    stress = float(programme["pull_peak_tension"][0] / tree["area"][0])
    assert stress == pytest.approx(37.9483e6, rel=1e-5)


def column(name, place, **given):
    return np.genfromtxt(LOGS / name, usecols=place, invalid_raise=False, **given)


def peak(name, place, scale, **given):
    def look(tree):
        raw = column(name, place, **given)
        expected = scale * float(np.nanmax(np.sign(scale) * raw)) * np.sign(scale)
        assert float(tree["tension"].max()) == pytest.approx(expected, rel=1e-6)

    return look


def mts(tree):
    lines = (LOGS / "machine-exports/example4.csv").read_text("utf-8", errors="replace").split("\n")
    rows = [line.replace(",", ".").split("\t") for line in lines[15:946]]
    load = np.array([float(row[3]) for row in rows if len(row) == 8])
    assert float(tree["tension"].max()) == pytest.approx(-1e3 * load.min(), rel=1e-9)


def bluehill(tree):
    time, position, load, _, count = np.genfromtxt(
        LOGS / "bluehill-compression/Specimen_RawData_6.csv", delimiter=",", skip_header=5
    ).T
    assert time.size == int(tree["record"]["n_rows_read"])
    # the machine counts from 0; what it counts as 0 is taken for what precedes the first cycle
    peaks = [-load[count == number].min() for number in (1, 2)]
    assert of_cycles(tree, "peak_tension") == pytest.approx(peaks, rel=1e-3)
    ranges = [np.ptp(position[count == number]) / 2 / 20 for number in (1, 2)]
    assert of_cycles(tree, "strain_amplitude") == pytest.approx(ranges, rel=0.03)


def silicone(tree):
    strain, stress = column("soft-silicones/Dragon Skin 20.csv", (3, 4), delimiter=";",
                            skip_header=18).T  # fmt: skip
    levels = (0.5, 1.0, 2.0)
    given = tree["rubber"]["stress_at_strain"].sel(strain_level=list(levels)).values[0]
    np.testing.assert_allclose(given, 1e6 * np.interp(levels, strain, stress), rtol=0.005)


def loops(name, x_place, f_place, to_metre, to_newton, **given):
    """Each loop of the product against the integral of force over travel in the raw file."""

    def look(tree):
        raw = column(name, None, **given) if isinstance(name, str) else name()
        x, f = to_metre * raw[:, x_place], to_newton * raw[:, f_place]
        cycles = tree["cycles"]
        energy, amplitude = (
            of_cycles(tree, "closed_loop_energy"),
            of_cycles(tree, "strain_amplitude"),
        )
        ends = zip(
            cycles["cycle_first_sample"].values, cycles["cycle_last_sample"].values, strict=True
        )
        closed = 0
        begins = [*cycles["cycle_first_sample"].values[1:], x.size - 1]
        for place, (first, last) in enumerate(ends):
            part = slice(first, last + 1)
            if abs(x[first] - x[last]) > 0.02 * np.ptp(x[part]):
                continue  # of a loop that does not close the integral is no energy
            closed += 1
            area = np.trapezoid(f[part], x[part])
            assert energy[place] == pytest.approx(area, rel=0.05)
            # a metre of gauge length: strain is travel; a cycle of a growing wave is cut where it
            # closes, before the turn that ends its stroke
            after = x[last : begins[place] + 1].min() if begins[place] > last + 1 else x[last]
            half = (x[part].max() - (x[first] + after) / 2) / 2
            assert amplitude[place] == pytest.approx(half, rel=0.015)
        assert closed

    return look


def growing(tree):
    """Each cycle is up to 1.6 times the one before it: no loop closes, and none has an energy."""
    travel = 0.0254 * column("damper-hysteresis/ganey_damper/xyTestData.csv", 0, delimiter=",")
    cycles = tree["cycles"]
    assert np.isnan(of_cycles(tree, "closed_loop_energy")).all()
    ends = cycles["cycle_first_sample"].values, cycles["cycle_last_sample"].values
    amplitude = of_cycles(tree, "strain_amplitude")
    assert amplitude.size == 8
    for half, first, last in zip(amplitude, *ends, strict=True):
        peak = first + np.argmax(travel[first : last + 1])
        valleys = travel[first - 5 : peak].min(), travel[peak : last + 5].min()
        rise, fall = sorted((travel[peak] - np.array(valleys)) / 2)
        assert 0.985 * rise < half < 1.015 * fall


def friction_rows():
    with (LOGS / "friction-damper/0.5Hz30lbtension1.5amplitude.json").open() as file:
        return np.array(json.load(file)["data"])


def friction(tree):
    # 0.5 Hz and 1.5 in, as its README states them; the last cycles run down
    frequency = of_cycles(tree, "frequency")[:3]
    uncertainty = of_cycles(tree, "frequency_standard_uncertainty")[:3]
    assert (uncertainty < 0.006 * 0.5).all()
    assert (np.abs(frequency - 0.5) < 2 * uncertainty).all()
    np.testing.assert_allclose(of_cycles(tree, "strain_amplitude")[:3], 1.5 * 0.0254, rtol=0.015)
    loops(friction_rows, 1, 2, 0.0254, 4448.2216152605)(tree)


def knit(tree):
    import python_calamine

    book = python_calamine.CalamineWorkbook.from_path(LOGS / "knit-yarn/compressionTests.xls")
    rows = book.get_sheet_by_name("cotton-1").to_python()
    place = rows[1].index("Standard force")
    force = [row[place] for row in rows[3:] if isinstance(row[place], float)]
    assert float(tree["tension"].max()) == pytest.approx(max(force) / 1e3, rel=1e-9)
    travel = [row[rows[1].index("Strain")] for row in rows[3:] if isinstance(row[place], float)]
    at_peak = travel[force.index(max(force))] / 20
    assert float(tree["strain"].max()) == pytest.approx(at_peak, rel=0.001)


@dataclass(frozen=True)
class OwnLog:
    """A log, the answers that a person gives, and what must come out."""

    file: str
    product: str
    edits: list
    look: object
    may_say: tuple = ()
    """Warnings of plausibility that are right of this log."""


MADE_BY = {
    "Instron WaveMatrix, latex": OwnLog(
        "instron-elastomer/latex_glove/Test6.steps.tracking.csv", "Test6-steps-tracking",
        [ELASTOMER, areas('area = "2 mm2"'), answer("gauge_length", "30 mm"),
         answer("reference_length", "42 mm"), (r"(tension\.1 = .*) }", r"\1, sign = -1 }"), SINE],
        lambda tree: wave_matrix(tree, "latex_glove/Test6.steps.trends.csv", (1, 11)),
        # what the cell logs at 2.5 Hz is inertia
        ("strain-below-zero",),
    ),
    "Instron WaveMatrix, silicone": OwnLog(
        "instron-elastomer/silicone_10a/Test7.steps.tracking.csv", "Test7-steps-tracking",
        [ELASTOMER, areas('area = "1 mm2"'), answer("gauge_length", "30 mm"),
         answer("reference_length", "42 mm"), answer("zero", "0 kN"), SINE],
        lambda tree: wave_matrix(tree, "silicone_10a/Test7.steps.trends.csv", (10, 14)),
        ("strain-below-zero",),
    ),
    "Zwick, German": OwnLog(
        "machine-exports/example.csv", "example",
        [ELASTOMER, areas('width = "11.4 mm"\nthickness = "0.2 mm"'), TENSILE], zwick,
    ),
    "Instron 8852, German logger": OwnLog(
        "machine-exports/example2.csv", "example2",
        [OTHER, areas('width = "10 mm"\nthickness = "0.03 mm"'), answer("gauge_length", "15 mm"),
         answer("reference_length", "15 mm"), TENSILE],
        peak("machine-exports/example2.csv", 1, 1e3, delimiter="\t", skip_header=2),
        ("last-reading-off",),  # it broke, and the load is 0 in the last row
    ),
    "MTS 793, German": OwnLog(
        "machine-exports/example4.csv", "example4",
        [OTHER, areas('diameter = "100.1 mm"'), answer("gauge_length", "299.8 mm"),
         answer("reference_length", "299.8 mm"), ('kind = "cyclic"', 'kind = "quasi-static"'),
         ('control = "position"', 'control = "load"'), *compressed()], mts,
        # the displacements were set to zero again under load, 10 s after the log begins
        ("channel-steps",),
    ),
    "Instron Bluehill, compression": OwnLog(
        "bluehill-compression/Specimen_RawData_6.csv", "Specimen_RawData_6",
        [ELASTOMER, areas('area = "100 mm2"'), answer("gauge_length", "20 mm"),
         answer("reference_length", "20 mm"), *compressed()], bluehill,
    ),
    "Instron 5569, stress and strain": OwnLog(
        "soft-silicones/Dragon Skin 20.csv", "Dragon-Skin-20",
        [ELASTOMER, areas('width = "6 mm"\nthickness = "3 mm"\ngauge_length = "33 mm"'),
         (r"strain\.1 = .*\n", ""), TENSILE,
         channel("crosshead_position", 'crosshead_position = { column = "Engineering Strain", '
                 'unit = "mm", factor = 33, datum = "displacement", reference_length = "33 mm" }'),
         channel("tension.1", 'tension.1 = { column = "Engineering Stress (MPa)", unit = "N", '
                 "factor = 18 }")], silicone,
    ),
    "damper, no header": OwnLog(
        "damper-hysteresis/ganey_damper/xyTestData.csv", "xyTestData",
        [OTHER, NO_AREA, answer("gauge_length", "1 m"), answer("sample_interval", "1 s"),
         channel("crosshead_position", 'crosshead_position = { column = 1, unit = "in", '
                 'datum = "displacement", reference_length = "1 m" }'),
         channel("tension.1", 'tension.1 = { column = 2, unit = "kip" }'),
         (r'(control = "position".*)', r"\1" + '\nwaveform = "other"')],
        growing,
        ("last-reading-off",),  # the load is 0 in the last row, and the position is not
    ),
    "timber panel, two columns": OwnLog(
        "damper-hysteresis/clt_SPC1/SPC1.csv", "SPC1",
        [OTHER, NO_AREA, answer("gauge_length", "1 m"), answer("reference_length", "1 m"),
         answer("sample_interval", "0.1 s")],
        lambda tree: panel(tree),
    ),
    "friction damper, JSON": OwnLog(
        "friction-damper/0.5Hz30lbtension1.5amplitude.json", "0-5Hz30lbtension1-5amplitude",
        [OTHER, NO_AREA, answer("gauge_length", "1 m"), SINE,
         channel("crosshead_position", 'crosshead_position = { column = 2, unit = "in", '
                 'unit_key = "displacement units", datum = "displacement", '
                 'reference_length = "1 m" }'),
         channel("tension.1", 'tension.1 = { column = 3, unit = "kip", '
                 'unit_key = "friction force units" }')], friction,
    ),
    "Zwick workbook, mN": OwnLog(
        "knit-yarn/compressionTests.xls", "compressionTests-cotton-1",
        [(r'\[specimens\."\?"\]', "[specimens.fabric]"), OTHER, NO_AREA,
         answer("gauge_length", "20 mm"),
         (r'reference_length = "\?"', 'reference_length = "20 mm"'),
         ('kind = "cyclic"', 'kind = "quasi-static"'), ("tests.csv", r"\?", "fabric")], knit,
    ),
}  # fmt: skip


def panel(tree):
    load, travel = column("damper-hysteresis/clt_SPC1/SPC1.csv", (0, 1), delimiter=",",
                          skip_header=2).T  # fmt: skip
    cycles = tree["cycles"]
    first, last = cycles["cycle_first_sample"].values[1], cycles["cycle_last_sample"].values[1]
    part = slice(first, last + 1)
    assert of_cycles(tree, "peak_tension")[1] == pytest.approx(1e3 * load[part].max(), rel=0.01)
    assert of_cycles(tree, "strain_amplitude")[1] == pytest.approx(
        np.ptp(travel[part]) / 2e3, rel=0.01
    )


BANDS = ("modulus-outside-band", "strain-above-band", "strength-outside-band", "density-outside-band",
         "position-behind-tension", "load-zero-drifts", "load-zero-wrong", "load-negative",
         "load-falls-with-stretch", "channel-steps", "last-reading-off", "strain-below-zero")  # fmt: skip


QUICK = ("Zwick, German", "MTS 793, German", "Instron 5569, stress and strain")


@needs_measured_logs
@pytest.mark.parametrize(
    "name",
    [pytest.param(one, marks=() if one in QUICK else pytest.mark.nightly) for one in MADE_BY],
)
def test_from_the_raw_log_to_a_right_number(tmp_path, command, name):
    log = MADE_BY[name]
    folder = tmp_path / "own"
    folder.mkdir()
    shutil.copyfile(LOGS / log.file, folder / Path(log.file).name)
    assert command("init", folder).returncode == 0
    for edit in log.edits:
        *file, old, new = edit
        path = folder / (file[0] if file else "campaign.toml")
        text, count = re.subn(old, new, path.read_text(encoding="utf-8"))
        assert count, f"nothing to edit: {old}"
        path.write_text(text, encoding="utf-8")
    campaign = folder / "campaign.toml"
    products = ("--processed", tmp_path / "processed", "--reports", tmp_path / "reports")
    test = log.product.split(".")[0]
    assert command("check", campaign, "--test", test).returncode == 0
    assert command("run", campaign, "--test", test, *products).returncode == 0
    with xr.open_datatree(tmp_path / "processed" / "own" / f"{log.product}.nc") as tree:
        log.look(tree)
        codes = tree["notes"]["note_code"].values.tolist()
        assert set(codes) & set(BANDS) <= set(log.may_say)


def test_the_page_has_a_row_for_each_log_with_as_many_edits():
    """Logs that were reduced once have no number of edits with an early version."""
    rows = [line.split("|") for line in PAGE.read_text(encoding="utf-8").splitlines()]
    shown = {
        row[1].strip(): int(row[5]) for row in rows if len(row) > 7 and row[4].strip().isdigit()
    }
    assert shown == {name: len(log.edits) for name, log in MADE_BY.items()}

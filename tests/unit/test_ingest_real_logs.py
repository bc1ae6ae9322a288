"""Measured logs from public sources, each by a declared layout.

Counts and peaks are those of the README beside the logs, or were taken from the files with
awk; none is from this package.
"""

import numpy as np
import pytest
from measured_logs import LOGS, needs_measured_logs

from reduction.readers.layout import Layout
from reduction.readers.read_log import read_log, read_record
from reduction.record.errors import LogError
from reduction.record.measurement import Quality
from reduction.record.settings import QualitySettings

pytestmark = needs_measured_logs
POUND, INCH = 4.4482216152605, 0.0254


def layout(*, position, tension, time=None, more=None, **settings):
    channels = {} if time is None else {"time": time}
    channels |= {"crosshead_position": {"datum": "displacement"} | position, "tension.1": tension}
    settings = {"format": "delimited"} | settings
    return Layout(channels=channels | (more or {}), **settings)


def read(path, one, *, specimens=("one",), length_needed=False):
    record, (source,) = read_record(
        [(LOGS / path, one, path)],
        test_id="test",
        specimens=specimens,
        quality=QualitySettings(),
        length_needed=length_needed,
    )
    assert source.name == path and source.size == (LOGS / path).stat().st_size
    assert record.n_rows_read == record.n_samples
    return record


def flagged(record, mask):
    along = record.crosshead_position_quality_flag | record.quality_flag[0]
    return np.flatnonzero(along & mask).tolist()


INSTRON = layout(
    time={"column": "Total Time (s)", "unit": "s"},
    position={"column": "Position (mm)", "unit": "mm"},
    tension={"column": "Force (kN)", "unit": "kN", "sign": -1},
    more={"cycle_counter": {"column": "Total Cycles"}},
)
TRENDS = layout(
    time={"column": "PC:Cycle Start Time (s)", "unit": "s"},
    position={"column": "Position:Maximum (mm)", "unit": "mm"},
    tension={"column": "Force:Minimum (kN)", "unit": "kN", "sign": -1},
    more={"cycle_counter": {"column": "Total Cycles"}},
)
SPECIMENS = [("latex_glove/Test6", 1651, 1431, 12), ("silicone_10a/Test7", 1942, 1496, 15)]


@pytest.mark.parametrize(("name", "n_tracking", "n_stop", "n_trends"), SPECIMENS)
def test_instron_logs_with_byte_order_mark_and_trailing_comma(name, n_tracking, n_stop, n_trends):
    folder = f"instron-elastomer/{name}"
    tracking = read(f"{folder}.steps.tracking.csv", INSTRON)
    stop = read(f"{folder}.Stop.csv", INSTRON)
    trends = read(f"{folder}.steps.trends.csv", TRENDS)
    assert (tracking.n_samples, stop.n_samples, trends.n_samples) == (n_tracking, n_stop, n_trends)
    assert not flagged(
        tracking, Quality.SPIKE | Quality.STUCK | Quality.SATURATED | Quality.MISSING
    )
    assert any("sampling rate is not constant" in note for note in map(str, tracking.notes))


@pytest.mark.parametrize(("name", "n_tracking", "n_stop", "n_trends"), SPECIMENS)
def test_the_machines_counter_parts_the_log_into_the_cycles_of_its_own_trends(
    name, n_tracking, n_stop, n_trends
):
    folder = f"instron-elastomer/{name}"
    tracking = read(f"{folder}.steps.tracking.csv", INSTRON)
    trends = read(f"{folder}.steps.trends.csv", TRENDS)
    assert set(trends.cycle_counter.tolist()) <= set(tracking.cycle_counter.tolist())
    for number, greatest in zip(trends.cycle_counter, trends.crosshead_position, strict=True):
        found = tracking.crosshead_position[tracking.cycle_counter == number].max()
        assert found == pytest.approx(greatest, abs=5e-12)  # metres; nine digits are logged


ZWICK = layout(
    delimiter="\t",
    encoding="latin-1",
    preamble_rows=16,
    has_unit_row=True,
    time={"column": "Prüfzeit", "unit": "s"},
    position={"column": "Traverse abs.", "unit": "mm", "datum": "pin-to-pin"},
    tension={"column": "Standardkraft", "unit": "N"},
    more={"strain.1": {"column": "Dehnung", "unit": "%"}},
)


def test_a_zwick_export_in_latin1_with_a_german_preamble():
    record = read("machine-exports/example.csv", ZWICK, length_needed=True)
    assert record.n_samples == 18_876
    assert record.tension.max() == pytest.approx(86.5222)
    assert record.measured_strain.max() == pytest.approx(3.09236)
    assert record.metadata["Dehnung bei Bruch"] == "309.236 %"
    assert record.metadata["Einspannlänge"] == "832.756 mm"
    area = 11.4 * 0.2  # mm2; the export prints the strength as 37.9483 N/mm2
    assert record.tension.max() / area == pytest.approx(37.9483, abs=5e-5)
    assert len(record.metadata) == 16


def test_a_zwick_export_in_the_wrong_encoding_names_its_row():
    wrong = ZWICK.model_copy(update={"encoding": "utf-8"})
    with pytest.raises(LogError, match=r"example\.csv:2: the file is not in the declared encoding"):
        read_log(LOGS / "machine-exports/example.csv", wrong, name="x")


def test_a_zwick_export_in_the_wrong_unit_is_refused():
    channels = ZWICK.channels | {
        "tension.1": ZWICK.channels["tension.1"].model_copy(update={"unit": "kN"})
    }
    wrong = ZWICK.model_copy(update={"channels": channels})
    with pytest.raises(LogError, match=r"example\.csv:18 \[Standardkraft\]: the unit in the file"):
        read_log(LOGS / "machine-exports/example.csv", wrong, name="x")


INSTRON_8852 = layout(
    delimiter="\t",
    preamble_rows=1,
    time={"column": "Zeit [s]", "unit": "s"},
    position={"column": "Maschine [mm]", "unit": "mm"},
    tension={"column": "Kraft [kN]", "unit": "kN"},
    # gauge length 15 mm, from the sheet that comes with the log
    more={"strain.1": {"column": "Clip-Gauge [mm]", "unit": "1", "factor": 1 / 15}},
)


def test_an_instron_8852_log_and_the_sheet_that_comes_with_it():
    record = read("machine-exports/example2.csv", INSTRON_8852)
    assert record.n_samples == 712
    assert record.tension.max() == pytest.approx(23371.8)
    assert record.time[-1] == pytest.approx(146.39)
    with pytest.raises(LogError, match="column 'Zeit .s.' is not in the file"):
        read_log(LOGS / "machine-exports/example3.csv", INSTRON_8852, name="x")


def test_an_mts_file_with_two_kinds_of_blocks():
    mts = layout(
        format="blocks",
        delimiter="\t",
        thousands=".",
        has_unit_row=True,
        block_marker="Datenerfassung",
        time={"column": "Laufzeit", "unit": "s"},
        position={"column": "Ch 1 Weg", "unit": "mm"},
        tension={"column": "Ch 1 Kraft", "unit": "kN", "sign": -1},
    )
    record = read("machine-exports/example4.csv", mts)
    assert record.n_samples == 931
    assert record.tension.max() == pytest.approx(472_881, abs=0.5)
    assert record.metadata["Masse"] == "5646,2"
    assert "1 blocks of another kind with 2 rows are not read, the first at row 948" in tuple(
        map(str, record.notes)
    )
    position = {"column": "Ch 1 W2TK Mittel", "unit": "mm", "datum": "displacement"}
    second = Layout(
        format="blocks",
        delimiter="\t",
        has_unit_row=True,
        block_marker="Datenerfassung",
        channels={"crosshead_position": position},
    )
    log = read_log(LOGS / "machine-exports/example4.csv", second, name="x")
    assert log.columns["crosshead_position"].tolist() == [2.0349319, 2.0347652]
    assert (log.first_row, log.n_rows_read, log.row) == (951, 2, None)


def test_a_bluehill_export_of_cyclic_compression():
    bluehill = layout(
        preamble_rows=3,
        has_unit_row=True,
        time={"column": "Time", "unit": "s"},
        position={"column": "Extension", "unit": "mm"},
        tension={"column": "Load", "unit": "N", "sign": -1},
        more={"cycle_counter": {"column": "Total Cycle Count"}},
    )
    record = read("bluehill-compression/Specimen_RawData_6.csv", bluehill)
    assert record.n_samples == 18_011
    assert np.median(np.diff(record.time)) == pytest.approx(1 / 50, abs=1e-5)
    assert record.tension.max() == pytest.approx(52.97507)
    assert record.crosshead_position.min() == pytest.approx(-12.04865e-3)
    assert record.metadata["Text Inputs : Specimen label"] == "22L.3"
    assert not record.quality_flag.any() and not record.crosshead_position_quality_flag.any()


SILICONES = [
    ("Dragon Skin 20", 404, 4.434225, 9.20455, []),
    ("Dragon Skin 30", 311, 4.15491, 7.09091, []),
    ("Ecoflex 00-35 FAST", 272, 0.63899, 6.22727, [271]),  # the last row says 24.4 after 27.3
    ("Mold Star 20T", 358, 3.265639857, 8.136341209, []),
    # 40.9 is followed by 40.10: a time printed without its point where it should be
    ("PlatSil Gel 10", 465, 2.19264, 10.59091, list(range(408, 465))),
    ("WAGNERSIL 20 NF", 651, 1.502422222, 3.27259697, []),
]


@pytest.mark.parametrize(("name", "n_rows", "stress", "strain", "backward"), SILICONES)
def test_silicones_pulled_to_failure(name, n_rows, stress, strain, backward):
    silicone = layout(
        delimiter=";",
        preamble_rows=17,
        time={"column": "Time (s)", "unit": "s"},
        # 3 x 6 mm2 and 33 mm, as the preamble says
        tension={"column": "Engineering Stress (MPa)", "unit": "N", "factor": 18.0},
        position={
            "column": "Engineering Strain", "unit": "mm", "factor": 33.0, "reference_length": "33 mm",
        },
        more={"strain.1": {"column": "Engineering Strain", "unit": "1"}},
    )  # fmt: skip
    record = read(f"soft-silicones/{name}.csv", silicone, length_needed=True)
    assert record.n_samples == n_rows
    assert record.tension.max() == pytest.approx(18 * stress)
    assert record.measured_strain.max() == pytest.approx(strain)
    assert record.crosshead_position.max() == pytest.approx(0.033 * (1 + strain))
    assert record.metadata["Standard"] == "ASTM D412"
    assert flagged(record, Quality.REPEATED_OR_BACKWARD_TIME) == backward


def test_a_timber_shear_log_with_a_name_row_and_a_unit_row_but_no_time():
    shear = layout(
        has_unit_row=True,
        sample_interval="1 s",
        position={"column": "Lead Actuator Displacment", "unit": "mm"},
        tension={"column": "Lead Actuator Force", "unit": "kN"},
    )
    record = read("damper-hysteresis/clt_SPC1/SPC1.csv", shear)
    assert record.n_samples == 33_028
    assert (record.tension.max(), record.tension.min()) == (
        pytest.approx(51_410),
        pytest.approx(-52_460),
    )
    assert record.crosshead_position.max() == pytest.approx(84.53e-3)
    # row 18813 reads -4.59 kN between -4.96 and -5.01
    assert flagged(record, ~Quality(0)) == [18_810]


def test_a_damper_log_without_names():
    damper = layout(
        has_name_row=False,
        sample_interval="1 s",
        position={"column": 1, "unit": "in"},
        tension={"column": 2, "unit": "kip"},
    )
    record = read("damper-hysteresis/ganey_damper/xyTestData.csv", damper)
    assert record.n_samples == 308
    assert record.tension.max() == pytest.approx(5.311602419 * 1000 * POUND)
    assert record.crosshead_position.min() == pytest.approx(-2.87755102 * INCH)


FRICTION = [
    ("0.5Hz30lbtension1.5amplitude", 14_337, 1.5081532448530197, 3.3572888374328613),
    ("1Hz36lbtension1amplitude", 7_169, 1.008971929550171, 3.700065314769745),
    ("2Hz36lbtension0.5amplitude", 3_585, 0.5090834498405457, 3.872254490852356),
]


@pytest.mark.parametrize(("name", "n_rows", "inches", "kips"), FRICTION)
def test_friction_damper_matrices_with_unit_strings(name, n_rows, inches, kips):
    friction = layout(
        format="json",
        matrix="data",
        time={"column": 1, "unit": "s", "unit_key": "time units"},
        position={"column": 2, "unit": "in", "unit_key": "displacement units"},
        tension={"column": 3, "unit": "kip", "unit_key": "friction force units"},
        more={"tension.2": {"column": 5, "unit": "lb", "unit_key": "actuator force units"}},
    )
    record = read(f"friction-damper/{name}.json", friction, specimens=("friction", "actuator"))
    assert record.n_samples == n_rows
    assert 1 / np.median(np.diff(record.time)) == pytest.approx(1024)
    assert record.crosshead_position.max() == pytest.approx(inches * INCH)
    assert record.tension[0].max() == pytest.approx(kips * 1000 * POUND)
    assert record.metadata["sampling freq"] == "1024"

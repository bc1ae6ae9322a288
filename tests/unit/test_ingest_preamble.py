import pytest

from reduction.readers.columns import check_units, declared_columns, keep_line
from reduction.readers.layout import Layout
from reduction.record.errors import LogError

COMMENTED = Layout(format="delimited", comment="#", channels={})
SEMICOLONS = Layout(format="delimited", delimiter=";", channels={})


@pytest.mark.parametrize(
    ("line", "one", "kept"),
    [
        ("Speed (mm/min);450;;;", SEMICOLONS, {"Speed (mm/min)": "450"}),
        ("Standard;ASTM;D412", SEMICOLONS, {"Standard": "ASTM D412"}),
        ("Projekt Name: PMD", SEMICOLONS, {"Projekt Name": "PMD"}),
        ("Prüfer :;Kh", SEMICOLONS, {"Prüfer": "Kh"}),
        ("free text", SEMICOLONS, {"row 7": "free text"}),
        ("nothing:", SEMICOLONS, {"row 7": "nothing:"}),
        (";;;;", SEMICOLONS, {}),
        ("   ", SEMICOLONS, {}),
        ("# loads [lbf]; 10 Hz", COMMENTED, {"row 7": "loads [lbf]; 10 Hz"}),
        ("#", COMMENTED, {}),
    ],
)
def test_a_line_is_kept_by_name_where_it_has_one_and_else_by_row(line, one, kept):
    metadata = {}
    keep_line(metadata, line, 7, one)
    assert metadata == kept


def test_a_name_that_comes_twice_keeps_both():
    metadata = {}
    keep_line(metadata, "a;1", 1, SEMICOLONS)
    keep_line(metadata, "a;2", 2, SEMICOLONS)
    assert metadata == {"a": "1", "a (row 2)": "2"}


def check(tmp_path, column, unit, *, unit_row=None, stated="", **channel):
    one = Layout(
        format="delimited", channels={"tension.1": {"column": column, "unit": unit} | channel}
    )
    name = column if isinstance(column, str) else "Force (kN)"
    check_units(
        tmp_path / "log.csv",
        [(declared_columns(one)[0], 0)],
        names=[name],
        units=[stated] if unit_row else [],
        unit_row=unit_row,
    )


def passes(tmp_path, column, unit):
    try:
        check(tmp_path, column, unit)
    except LogError:
        return False
    return True


@pytest.mark.parametrize(
    ("column", "units"),
    [
        ("Force (kN)", {"kN"}),
        ("Load [lb]", {"lbf"}),
        ("Total Force (Linear Waveform)", {"N", "kN", "lbf"}),
        ("Force (1)", {"N", "kN", "lbf"}),
        ("Force (mm)", {"N", "kN", "lbf"}),
        ("Force", {"N", "kN", "lbf"}),
        (1, {"N", "kN", "lbf"}),
    ],
)
def test_words_in_brackets_are_a_unit_only_where_they_are_one_of_the_channel(
    tmp_path, column, units
):
    assert {unit for unit in ("N", "kN", "lbf") if passes(tmp_path, column, unit)} == units


@pytest.mark.parametrize(("column", "unit"), [("Force (kN)", "N"), ("Load [lb]", "kgf")])
def test_a_unit_in_a_name_has_to_agree(tmp_path, column, unit):
    with pytest.raises(
        LogError, match=r"the unit in the column's name is not the declared one.*by its number"
    ):
        check(tmp_path, column, unit)


def test_volts_with_a_factor_are_not_compared(tmp_path):
    check(tmp_path, "Force (V)", "N", unit_row=2, stated="V", factor=250.0)
    with pytest.raises(LogError, match=r"log\.csv:2"):
        check(tmp_path, "Force (V)", "N", unit_row=2, stated="V")


def check_unit_row(tmp_path, place, units, **channels):
    one = Layout(format="delimited", channels=channels)
    wanted = [(declared_columns(one)[0], place)]
    names = [""] * place + ["F"]
    check_units(tmp_path / "log.csv", wanted, names=names, units=units, unit_row=2)


@pytest.mark.parametrize("stated", ["t", "[to]", "tonnes", "tf"])
def test_a_load_in_tonnes_is_a_force(tmp_path, stated):
    load = {"tension": {"column": 1, "unit": "tf"}}
    check_unit_row(tmp_path, 0, [stated], **load)
    with pytest.raises(LogError, match="not the declared one"):
        check_unit_row(tmp_path, 0, [stated], tension={"column": 1, "unit": "kN"})


def test_a_counter_may_have_any_word_for_its_unit(tmp_path):
    check_unit_row(tmp_path, 0, ["cycles"], cycle_counter={"column": "n"})
    with pytest.raises(LogError, match="'cycles' is not a unit of force"):
        check_unit_row(tmp_path, 0, ["cycles"], **{"tension.1": {"column": "F", "unit": "N"}})


def test_a_unit_row_that_ends_early_says_nothing(tmp_path):
    tension = {"tension.1": {"column": "F", "unit": "N"}}
    check_unit_row(tmp_path, 3, ["s"], **tension)
    with pytest.raises(LogError, match="found 'kN'; needed 'N'"):
        check_unit_row(tmp_path, 3, ["s", "s", "s", "kN"], **tension)

import pytest

from reduction.readers.spreadsheet import _CheckedMarkup
from reduction.record.errors import LogError


@pytest.fixture
def check(tmp_path):
    def check_part(text, name="xl/worksheets/sheet1.xml"):
        part = _CheckedMarkup(tmp_path / "log.xlsx", name)
        data = text.encode()
        part.add(data[:20])
        part.add(data[20:])
        part.finish()

    return check_part


def test_a_sound_part_passes_in_pieces(check):
    check("<row><c r='A1'><v>1</v></c></row>")


@pytest.mark.parametrize(
    "text",
    [
        "<row><c><v>1</v></row>",
        "<row><c><v>1<v></c></row>",
        "<row>&no;</row>",
        "",
        "<row/>x",
        "<?xml version='1.0' encoding='TF-8'?><row/>",
    ],
)
def test_a_part_that_is_not_well_formed_is_refused_by_its_name(check, text):
    with pytest.raises(
        LogError, match=r"the workbook is damaged; found xl/worksheets/sheet1\.xml: "
    ):
        check(text)


def test_a_part_that_declares_entities_is_refused(check):
    bomb = '<!DOCTYPE row [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;">]><row>&b;</row>'
    with pytest.raises(LogError, match=r"'xl/_rels/workbook\.xml\.rels' declares a document type"):
        check(bomb, name="xl/_rels/workbook.xml.rels")

"""Spreadsheets that mean harm: each is a function that writes one, by what it does."""

import io
import struct
import zipfile

from workbook import write_xlsx

ROWS = [["t", "x", "F"], *([0.1 * i, 1.0 + 0.01 * i, 5.0 + i] for i in range(30))]
_HEAD = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>'
_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_RELATION = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006"


def _replaced(path, replace=None, add=None, compression=zipfile.ZIP_DEFLATED):
    """A good workbook with members replaced (by a function of their text) and others added."""
    good = io.BytesIO()
    write_xlsx(good, {"log": ROWS})
    with zipfile.ZipFile(good) as source, zipfile.ZipFile(path, "w", compression) as target:
        for name in source.namelist():
            text = source.read(name).decode()
            target.writestr(name, replace[name](text) if name in (replace or {}) else text)
        for name, text in (add or {}).items():
            target.writestr(name, text)
    return path


def _sheet(body):
    return lambda text: text.replace("</sheetData>", body + "</sheetData>")


def _pieces(path, name, before, piece, count, after):
    """A workbook in which one member is a piece, many times."""
    good = io.BytesIO()
    write_xlsx(good, {"log": ROWS})
    with (
        zipfile.ZipFile(good) as source,
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as target,
    ):
        for held in source.namelist():
            if held != name:
                target.writestr(held, source.read(held))
        with target.open(name, "w", force_zip64=True) as stream:
            stream.write(before.encode())
            for _ in range(count):
                stream.write(piece)
            stream.write(after.encode())
    return path


_MEGA = 1 << 20
SIZE = 64  # MB that the bombs unpack to: more than the limit of the tests


def bomb_of_a_sheet(path, size=SIZE):
    """Blanks inside the sheet, more than memory may hold."""
    before = f'{_HEAD}<worksheet xmlns="{_MAIN}"><sheetData>'
    return _pieces(
        path, "xl/worksheets/sheet1.xml", before, b" " * _MEGA, size, "</sheetData></worksheet>"
    )


_STRINGS = {
    "xl/_rels/workbook.xml.rels": lambda text: text.replace(
        "</Relationships>",
        f'<Relationship Id="rId98" Type="{_RELATION}/sharedStrings" '
        'Target="sharedStrings.xml"/></Relationships>',
    )
}


def strings_that_claim_billions(path):
    text = f'{_HEAD}<sst xmlns="{_MAIN}" count="1" uniqueCount="9000000000"><si><t>a</t></si></sst>'
    return _replaced(path, _STRINGS, {"xl/sharedStrings.xml": text})


def overlapping_members(path):
    """A thousand entries of the directory that share one deflated piece of 20 MB."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a", b"\0" * (20 * _MEGA))
    data = path.read_bytes()
    start = data.index(b"PK\x01\x02")
    end = data.index(b"PK\x05\x06")
    entry = data[start:end]
    name_at = 46
    count = 1000
    entries = b""
    for number in range(count):
        name = f"{number:04d}".encode()
        entries += (
            entry[:28] + struct.pack("<H", 4) + entry[30:name_at] + name + entry[name_at + 1 :]
        )
    tail = bytearray(data[end:])
    struct.pack_into("<HHII", tail, 8, count, count, len(entries), start)
    path.write_bytes(data[:start] + entries + tail)
    return path


def external_entity(path, target="file:///etc/passwd"):
    doctype = f'<!DOCTYPE worksheet [<!ENTITY x SYSTEM "{target}">]>'
    cell = '<row r="1"><c r="D1" t="inlineStr"><is><t>&x;</t></is></c></row>'
    return _replaced(
        path,
        {
            "xl/worksheets/sheet1.xml": lambda text: text.replace("?>", "?>" + doctype, 1).replace(
                "<sheetData>", "<sheetData>" + cell
            )
        },
    )


def external_link(path):
    """A cell whose formula takes its value from another workbook on the net."""
    link = f'{_HEAD}<externalLink xmlns="{_MAIN}"><externalBook xmlns:r="{_RELATION}" r:id="rId1"/></externalLink>'
    relations = (
        f'{_HEAD}<Relationships xmlns="{_PACKAGE}/relationships"><Relationship Id="rId1" '
        f'Type="{_RELATION}/externalLinkPath" Target="file:///etc/passwd" TargetMode="External"/>'
        "</Relationships>"
    )
    cell = '<row r="32"><c r="A32"><f>[1]Sheet1!A1</f><v>3</v></c><c r="B32"><v>1.3</v></c><c r="C32"><v>4</v></c></row>'
    return _replaced(
        path,
        {"xl/worksheets/sheet1.xml": _sheet(cell)},
        {
            "xl/externalLinks/externalLink1.xml": link,
            "xl/externalLinks/_rels/externalLink1.xml.rels": relations,
        },
    )


def sheet_outside_the_file(path, target="file:///etc/passwd", mode=' TargetMode="External"'):
    """The sheet itself is said to stand elsewhere."""
    return _replaced(
        path,
        {
            "xl/_rels/workbook.xml.rels": lambda text: text.replace(
                'Target="worksheets/sheet1.xml"', f'Target="{target}"{mode}'
            )
        },
    )


def formulas_with_values(path):
    cell = '<row r="32"><c r="A32"><f>A31+0.1</f><v>3</v></c><c r="B32"><f>B31</f><v>1.3</v></c><c r="C32"><f>C31+1</f><v>36</v></c></row>'
    return _replaced(path, {"xl/worksheets/sheet1.xml": _sheet(cell)})


def formulas_without_values(path):
    cell = '<row r="32"><c r="A32"><f>A31+0.1</f></c><c r="B32"><f>B31</f></c><c r="C32"><f>C31+1</f></c></row><row r="33"><c r="A33"><v>3.1</v></c><c r="B33"><v>1</v></c><c r="C33"><v>1</v></c></row>'
    return _replaced(path, {"xl/worksheets/sheet1.xml": _sheet(cell)})


def macros(path):
    return _replaced(
        path,
        {
            "xl/_rels/workbook.xml.rels": lambda text: text.replace(
                "</Relationships>",
                '<Relationship Id="rId97" Type="http://schemas.microsoft.com/office/2006/relationships/'
                'vbaProject" Target="vbaProject.bin"/></Relationships>',
            )
        },
        {"xl/vbaProject.bin": b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + b"\xff" * 5000},
    )


def one_cell_in_the_last_corner(path):
    return _replaced(
        path,
        {
            "xl/worksheets/sheet1.xml": _sheet(
                '<row r="1048576"><c r="XFD1048576"><v>1</v></c></row>'
            )
        },
    )


def one_cell_in_the_last_row(path):
    return _replaced(
        path,
        {"xl/worksheets/sheet1.xml": _sheet('<row r="1048576"><c r="A1048576"><v>1</v></c></row>')},
    )


def _cfb(streams):
    """A compound file with streams, in sectors of 512 bytes."""
    sectors, starts = [], {}
    for name, data in streams.items():
        data = data.ljust(4096, b"\0")
        data += b"\0" * (-len(data) % 512)
        starts[name] = (len(sectors), len(data) // 512, len(data))
        sectors += [data[i : i + 512] for i in range(0, len(data), 512)]
    entries = [("Root Entry", 5, -2, 0), *((n, 2, starts[n][0], starts[n][2]) for n in streams)]
    directory = b""
    for place, (name, kind, start, size) in enumerate(entries):
        text = (name + "\0").encode("utf-16-le")
        child = 1 if place == 0 and streams else -1
        right = place + 1 if 0 < place < len(entries) - 1 else -1
        directory += text.ljust(64, b"\0") + struct.pack(
            "<HBBiii16sIQQiQ", len(text), kind, 1, -1, right, child, b"", 0, 0, 0, start, size
        )
    directory += b"\0" * (-len(directory) % 512)
    at = len(sectors)
    n_directory = len(directory) // 512
    sectors += [directory[i : i + 512] for i in range(0, len(directory), 512)]
    fat = [-1] * (128 * ((len(sectors) + 129) // 128))
    for start, count, _ in [*starts.values(), (at, n_directory, 0)]:
        for i in range(start, start + count):
            fat[i] = i + 1
        fat[start + count - 1] = -2
    n_fat = len(fat) // 128
    for i in range(n_fat):
        fat[len(sectors) + i] = -3
    first_fat = len(sectors)
    sectors += [struct.pack("<128i", *fat[i : i + 128]) for i in range(0, len(fat), 128)]
    header = struct.pack(
        "<8s16sHHHHH6xIIiIIiIiI",
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", b"", 0x3E, 3, 0xFFFE, 9, 6, 0, n_fat, at, 0, 4096, -2, 0, -2, 0,
    )  # fmt: skip
    header += struct.pack("<109i", *([first_fat + i for i in range(n_fat)] + [-1] * 109)[:109])
    return header + b"".join(sectors)


def encrypted(path):
    """As a password makes it: a compound file of two streams."""
    path.write_bytes(_cfb({"EncryptionInfo": b"\4\0\4\0", "EncryptedPackage": b"\1" * 5000}))
    return path


def compound_file_that_lies(path, at, value):
    data = bytearray(_cfb({"Workbook": b"\x09\x08\x10\x00\x00\x06\x05\x00" + b"\0" * 5000}))
    struct.pack_into("<I", data, at, value)
    path.write_bytes(data)
    return path


def xls_with_a_huge_table(path):
    return compound_file_that_lies(path, 44, 0xFFFFFFFF)


def xls_whose_sectors_run_in_a_circle(path):
    data = bytearray(_cfb({"Workbook": b"\x09\x08\x10\x00\x00\x06\x05\x00" + b"\0" * 5000}))
    place = data.rindex(struct.pack("<ii", 1, 2))
    struct.pack_into("<ii", data, place, 1, 0)
    path.write_bytes(data)
    return path


def xls_that_is_text(path):
    path.write_text("t\tx\tF\n0\t1\t2\n")
    return path


def _ods(path, body):
    office = "urn:oasis:names:tc:opendocument:xmlns"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
        archive.writestr(
            "META-INF/manifest.xml",
            f'<manifest:manifest xmlns:manifest="{office}:manifest:1.0"></manifest:manifest>',
        )
        archive.writestr(
            "content.xml",
            f'<?xml version="1.0" encoding="UTF-8"?><office:document-content '
            f'xmlns:office="{office}:office:1.0" xmlns:table="{office}:table:1.0" '
            f'xmlns:text="{office}:text:1.0"><office:body><office:spreadsheet>'
            f'<table:table table:name="log">{body}</table:table></office:spreadsheet>'
            "</office:body></office:document-content>",
        )
    return path


_ODS_CELL = '<table:table-cell{} office:value-type="float" office:value="1"/>'


def ods_with_a_row_that_repeats(path):
    cell = _ODS_CELL.format(' table:number-columns-repeated="16384"')
    row = f'<table:table-row table:number-rows-repeated="1048576">{cell}</table:table-row>'
    return _ods(path, row)


WORKBOOKS = {
    "log.xlsx": [
        bomb_of_a_sheet, strings_that_claim_billions, overlapping_members, external_entity,
        external_link, sheet_outside_the_file, formulas_with_values,
        formulas_without_values, one_cell_in_the_last_corner, one_cell_in_the_last_row,
        encrypted,
    ],
    "log.xlsm": [macros],
    "log.xls": [
        xls_with_a_huge_table, xls_whose_sectors_run_in_a_circle, xls_that_is_text,
    ],
    "log.ods": [
        ods_with_a_row_that_repeats,
    ],
}  # fmt: skip

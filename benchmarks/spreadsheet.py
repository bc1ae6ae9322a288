"""Time and memory of reading a log of 1,000,000 rows and four columns from an .xlsx workbook.

    python benchmarks/spreadsheet.py [ROWS] [REPEATS]

The workbook is written once, by hand as zipped XML, in the folder BENCHMARK_DATA, or a
temporary one; its numbers are made up (synthetic).  Each reading runs in a process of its
own; hashing of the file is part of it.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np
from figures import Figure, hand_on

RELATIONS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006"
SHEET = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
CONTENT = "application/vnd.openxmlformats-officedocument.spreadsheetml"
PARTS = {
    "[Content_Types].xml": f'<Types xmlns="{PACKAGE}/content-types">'
    '<Default Extension="rels" '
    'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    f'<Override PartName="/xl/workbook.xml" ContentType="{CONTENT}.sheet.main+xml"/>'
    f'<Override PartName="/xl/worksheets/sheet1.xml" ContentType="{CONTENT}.worksheet+xml"/>'
    "</Types>",
    "_rels/.rels": f'<Relationships xmlns="{PACKAGE}/relationships">'
    f'<Relationship Id="r1" Type="{RELATIONS}/officeDocument" Target="xl/workbook.xml"/>'
    "</Relationships>",
    "xl/workbook.xml": f'<workbook xmlns="{SHEET}" xmlns:r="{RELATIONS}">'
    '<sheets><sheet name="log" sheetId="1" r:id="r1"/></sheets></workbook>',
    "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{PACKAGE}/relationships">'
    f'<Relationship Id="r1" Type="{RELATIONS}/worksheet" Target="worksheets/sheet1.xml"/>'
    "</Relationships>",
}
WANTED = 8.0  # s, of a million rows
HEADER = (("time", "crosshead", "load_a", "load_b"), ("s", "ft", "lbf", "lbf"))
READ = """
import time, json, resource, sys
from pathlib import Path
from reduction.readers.layout import Layout
from reduction.readers.spreadsheet import read_spreadsheet
layout = Layout(format="spreadsheet", has_unit_row=True, channels={
    "time": {"column": "time", "unit": "s"},
    "crosshead_position": {"column": "crosshead", "unit": "ft", "datum": "pin-to-pin"},
    "tension": {"1": {"column": "load_a", "unit": "lbf"}, "2": {"column": "load_b", "unit": "lbf"}},
})
start = time.perf_counter()
log = read_spreadsheet(Path(sys.argv[1]), layout, name="log.xlsx")
print(json.dumps({"seconds": time.perf_counter() - start, "rows": log.n_rows_read,
    "sum": sum(float(column.sum()) for column in log.columns.values()),
    "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024}))
"""


def columns(n_rows: int) -> np.ndarray:
    """Time, position and two tensions, shape (4, n_rows), as they are printed."""
    time = np.arange(n_rows) / 10
    wave = np.sin(time / 5)
    table = [time, np.round(20 + 3 * wave, 4), np.round(60 + 20 * wave, 3)]
    return np.stack([*table, np.round(62 + 19 * wave, 3)])


def write_workbook(path: Path, n_rows: int) -> None:
    """One sheet, name and unit row as inline text, numbers with their cell names."""
    with ZipFile(path, "w", ZIP_DEFLATED) as archive:
        for name, text in PARTS.items():
            archive.writestr(name, '<?xml version="1.0" encoding="UTF-8"?>' + text)
        with archive.open("xl/worksheets/sheet1.xml", "w", force_zip64=True) as sheet:
            sheet.write(f'<worksheet xmlns="{SHEET}"><sheetData>'.encode())
            for row, texts in enumerate(HEADER, start=1):
                cells = "".join(
                    f'<c r="{letter}{row}" t="inlineStr"><is><t>{text}</t></is></c>'
                    for letter, text in zip("ABCD", texts, strict=True)
                )
                sheet.write(f'<row r="{row}">{cells}</row>'.encode())
            for row, numbers in enumerate(columns(n_rows).T.tolist(), start=len(HEADER) + 1):
                cells = "".join(
                    f'<c r="{letter}{row}"><v>{number:.15g}</v></c>'
                    for letter, number in zip("ABCD", numbers, strict=True)
                )
                sheet.write(f'<row r="{row}">{cells}</row>'.encode())
            sheet.write(b"</sheetData></worksheet>")


def main(n_rows: int, repeats: int) -> list[Figure]:
    """Print a Markdown table."""
    folder = Path(os.environ.get("BENCHMARK_DATA", tempfile.gettempdir())) / "reduction-benchmark"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"log_{n_rows}.xlsx"
    if not path.exists():
        write_workbook(path, n_rows)
    runs = []
    for _ in range(repeats + 1):
        done = subprocess.run(
            [sys.executable, "-c", READ, str(path)], capture_output=True, text=True, check=True
        )
        runs.append(json.loads(done.stdout))
    expected = float(columns(n_rows).sum())
    if runs[0]["rows"] != n_rows or abs(runs[0]["sum"] - expected) > 1e-9 * expected:
        raise SystemExit(f"read {runs[0]}, written {n_rows} rows that sum to {expected}")
    seconds = sorted(run["seconds"] for run in runs[1:])
    print(
        f"{n_rows} rows x 4 columns, {path.stat().st_size / 1e6:.0f} MB, "
        f"{os.cpu_count()} processors, {repeats} runs after one warm-up"
    )
    print("| | median s | min | max | peak MB |\n|---|---|---|---|---|")
    print(
        f"| read_spreadsheet | {median(seconds):.2f} | {seconds[0]:.2f} | {seconds[-1]:.2f} "
        f"| {max(run['peak_mb'] for run in runs):.0f} |"
    )
    return [
        Figure(
            what=f"workbook of {n_rows:,} rows read",
            values=tuple(seconds),
            at_most=WANTED,
            of="value",
        ),
        Figure(what="its peak memory", unit="MB", values=tuple(run["peak_mb"] for run in runs[1:])),
    ]


if __name__ == "__main__":
    hand_on(
        main(
            int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000,
            int(sys.argv[2]) if len(sys.argv) > 2 else 3,
        )
    )

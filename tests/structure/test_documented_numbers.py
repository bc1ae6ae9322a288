"""The counts of docs/printed-numbers.md are those of the command, and docs/lookup.md runs."""

import re
from pathlib import Path

import numpy as np

from reduction.published.reproduce_page import counts_of, reproduce

ROOT = Path(__file__).parents[2]
VERDICTS = (
    "derived", "closed", "repeated", "erratum", "open", "measured", "unexplained",
)  # fmt: skip


def test_the_page_of_printed_numbers_counts_what_reproduce_counts():
    page = (ROOT / "docs" / "printed-numbers.md").read_text(encoding="utf-8")
    for report, items in reproduce().items():
        (row,) = re.findall(rf"^\| {report} \|(.*)\|$", page, re.M)
        shown = [int(cell) for cell in row.split("|")]
        counts = counts_of(items)
        assert shown == [len(items), *(counts[name] for name in VERDICTS)], report


def test_the_example_of_the_look_up_runs():
    page = (ROOT / "docs" / "lookup.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"^```python\n(.*?)^```$", page, re.M | re.S)
    names = {}
    exec(code, names)  # noqa: S102 - the documentation's own example
    values = names["values"]
    assert np.all(values.low < values.value) and np.all(values.value < values.high)

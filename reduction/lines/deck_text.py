"""Text in the files of every mooring code: numbers, remarks, and the header.

The header gives the sources of the numbers of an export, and their range.
"""

from __future__ import annotations

import re
import textwrap

from reduction import __version__
from reduction.lines.export_line import (
    ExportLine,
    ThinnedCurve,
    doubts_first,
    guards_of,
    local_words,
    range_of,
)
from reduction.quantities.digits import plain_number

_WIDTH = 100


def number(value: float) -> str:
    """Shortest form with 15 digits: rounded values stay round after a change of unit."""
    return f"{value:.15g}"


def real_number(value: float) -> str:
    """The same with a decimal point, where a number without one is not real."""
    head, sign, power = number(value).partition("e")
    return (head if "." in head else f"{head}.0") + sign + power


def one_line(text: str) -> str:
    """Text valid as a remark in every grammar: one line, ASCII, no comment or rule characters."""
    plain = " ".join(text.split()).encode("ascii", "replace").decode()
    return re.sub(
        "-{3,}",
        "-",
        re.sub(r"[#!%*\\\"|{}&]", " ", plain.replace(" %", "%").replace("%", " percent")),
    )


def header_lines(line: ExportLine, curve: ThinnedCurve | None, *remarks: str) -> list[str]:
    """Header of a file, without comment characters."""
    told = [f"Line {line.name}, written by reduction {__version__}"]
    if line.is_synthetic:
        told.append("SYNTHETIC: generated from a formula, nothing was tested")
    told += [f"Note: {text}" for text in doubts_first((*line.notes, *guards_of(line)))[0]]
    if curve is not None:
        told += [
            f"Curve: {line.curve}",
            f"Range: {range_of(line)}. The curve ends at strain {curve.strain[-1]:.6g} and "
            f"tension {plain_number(curve.tension[-1], 6)} N; not known beyond",
            f"{min(curve.strain.size, line.strain.size)} points of {line.strain.size}; greatest"
            f" error {plain_number(curve.error, 3)} N {local_words(curve)}",
        ]
        if curve.words:
            told.append(f"At the start: {curve.words}")
    told += [f"Source: {text}" for text in line.sources]
    told += [f"Note: {text}" for text in doubts_first(line.notes)[1]]
    told += [f"Remark: {text}" for text in remarks if text]
    return [
        part
        for text in told
        # a hyphen also begins an option, which would be lost when cut
        for part in textwrap.wrap(
            one_line(text), _WIDTH, subsequent_indent="  ", break_on_hyphens=False
        )
    ]

"""The page of the variables of archives, made from the schemas and the vocabulary."""

from __future__ import annotations

from reduction.quantities.names import (
    COMPARISON_SCHEMA,
    OUTCOME_SCHEMA,
    PREDICTION_SCHEMA,
    PROPERTY_SCHEMA,
    SURFACE_SCHEMA,
    TEST_SCHEMA,
)
from reduction.quantities.row import GROUPS, SUFFIXES, Quantity

__all__ = ["pages"]

_FILES = {
    "A reduced test: TEST.nc": TEST_SCHEMA,
    "Response surfaces: surfaces.nc": SURFACE_SCHEMA,
    "Predicted hoses: predictions.nc": PREDICTION_SCHEMA,
    "Measured against predicted: comparisons.nc": COMPARISON_SCHEMA,
    "Outcomes without a log: outcomes.nc": OUTCOME_SCHEMA,
    "Change-in-length properties: change_in_length.nc": PROPERTY_SCHEMA,
}


def _rows(schema: dict[str, Quantity]) -> list[str]:
    """One row a variable; its uncertainty, count and bounds stand with it as suffixes."""
    lines: list[str] = []
    group = None
    for name, one in sorted(schema.items(), key=lambda row: row[1].group):
        base = next((name.removesuffix(end) for end in SUFFIXES if name.endswith(end)), "")
        if base in schema:
            continue
        if one.group != group:
            group = one.group
            lines += ["", f"Group `{group}`: {GROUPS[group]}." if group else "Root:", ""]
            lines += ["| variable | dimensions | unit | what |", "|---|---|---|---|"]
        beside = [end for end in SUFFIXES if f"{name}{end}" in schema]
        words = one.long_name + (
            f". Beside it: {', '.join(f'`{end}`' for end in beside)}" if beside else ""
        )
        if one.flags:
            kind = "masks" if one.is_mask else "values"
            meanings = ", ".join(f"{value} {flag}" for flag, value in one.flags.items())
            words += f". {kind.capitalize()}: {meanings}"
        unit = one.unit or "text"
        unit = f"`{unit}`" if "<" in unit else unit
        dims = ", ".join(one.dims) or "one number"
        lines.append(f"| `{name}` | {dims} | {unit} | {words.replace('<', '&lt;')} |")
    return lines


def pages() -> dict[str, str]:
    """Name below ``reference/`` to text."""
    lines = [
        "# Variables of the archives", "",
        "Made from the schemas of the archives and the vocabulary. A file has those that its test "
        "or campaign gives; SI. The root holds what somebody looks for, groups the rest. A suffix "
        "is part of the name, `tension_standard_uncertainty`. How "
        "to read them: [Reading the archives](../archive.md).", "",
        "| suffix | means |", "|---|---|",
        *(f"| `{end}` | {words.format('...')} |" for end, (words, _, _) in SUFFIXES.items()), "",
    ]  # fmt: skip
    for title, schema in _FILES.items():
        lines += [f"## {title}", "", *_rows(schema), ""]
    return {"variables.md": "\n".join(lines)}

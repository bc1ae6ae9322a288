"""Campaign folders: campaign.toml, logs, marks, and the truth beside them."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from strangers.materials import Array

# Names that the contract leaves open: change them here, or with make(..., keys={...}).
# An empty name leaves the statement out of campaign.toml (it stays in the truth).
KEYS = {
    "tape": "tape",  # [uncertainty] tape = "0.004 ft"
    "attached_mass_uncertainty": "attached_mass",  # [uncertainty] attached_mass = "0.1 kg"
    "machine_compliance_uncertainty": "machine_compliance",  # [uncertainty] machine_compliance = "2e-8 m/N"
}
NOTICE = "SYNTHETIC: generated from a known law; no specimen was pulled."


class Inline(dict[str, Any]):
    """A table that is written on one line."""


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | np.integer):
        return str(int(value))
    if isinstance(value, float | np.floating):
        return repr(float(value))
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + " }"
    if isinstance(value, Sequence):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    raise TypeError(f"cannot write {type(value)} as TOML")


def _key(key: str) -> str:
    bare = key.replace("-", "").replace("_", "")
    return key if bare.isalnum() and bare.isascii() else json.dumps(key)


def _tables(name: list[str], table: Mapping[str, Any], lines: list[str]) -> None:
    plain = {k: v for k, v in table.items() if not _is_table(v)}
    nested = {k: v for k, v in table.items() if _is_table(v)}
    if name and (plain or not nested):
        lines.extend(["", f"[{'.'.join(name)}]"])
    lines.extend(f"{_key(k)} = {_value(v)}" for k, v in plain.items())
    for key, value in nested.items():
        path = [*name, _key(key)]
        if isinstance(value, Mapping):
            _tables(path, value, lines)
            continue
        for item in value:
            lines.extend(["", f"[[{'.'.join(path)}]]"])
            lines.extend(f"{_key(k)} = {_value(v)}" for k, v in item.items())


def _is_table(value: Any) -> bool:
    if isinstance(value, Inline):
        return False
    if isinstance(value, list) and value and isinstance(value[0], Mapping):
        return not isinstance(value[0], Inline)
    return isinstance(value, Mapping)


def write_toml(path: Path, document: Mapping[str, Any]) -> None:
    """Write a document of nested tables; lists of dict become arrays of tables."""
    lines = [f"# {NOTICE}"]
    _tables([], document, lines)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_log(path: Path, columns: Mapping[str, tuple[Array, int]], note: str) -> None:
    """Write a log; each column is (values, decimals)."""
    names = list(columns)
    pattern = ",".join(f"%.{decimals}f" for _, decimals in columns.values())
    table = np.column_stack([values for values, _ in columns.values()]) + 0.0
    head = f"# {NOTICE}\n# {note}\n" + ",".join(names) + "\n"
    body = "\n".join(pattern % tuple(row) for row in table.tolist())
    path.write_text(head + body + "\n", encoding="utf-8")


def header(law: str, seed: int, title: str) -> dict[str, Any]:
    """Return the table [campaign] of a generated campaign."""
    return {
        "id": f"{law}-{seed}",
        "title": f"{title} (synthetic)",
        "institution": "none: generated data",
        "source": "synthetic, from a known material law",
        "synthetic": True,
        "license": "CC0-1.0",
    }


def make_document(law: str, seed: int, title: str, specimens: Mapping[str, Any]) -> dict[str, Any]:
    """Start a campaign document."""
    return {"campaign": header(law, seed, title), "specimens": dict(specimens)}


@dataclass
class Truth:
    """What is true of one generated campaign.

    Attributes
    ----------
    tests
        test -> specimen -> quantity -> number or list (SI; units in ``units``).
    arrays
        curves and per-cycle values by "test/specimen/name" (SI).
    constants
        constants of the law; enough to evaluate it again.
    errors
        name -> form, stated, stated_standard, drawn, unit.
    response
        a function of (frequency [Hz], mean tension [N], tension amplitude [N]) of a rope.
    """

    law: str
    seed: int
    family: str
    about: str
    units: dict[str, str] = field(default_factory=dict)
    constants: dict[str, Any] = field(default_factory=dict)
    errors: dict[str, dict[str, float | str]] = field(default_factory=dict)
    tests: dict[str, dict[str, dict[str, Any]]] = field(default_factory=dict)
    arrays: dict[str, Array] = field(default_factory=dict)
    response: Callable[[Array, Array, Array], dict[str, Array]] | None = None

    def dump(self, folder: Path) -> None:
        """Write truth.json and truth.npz."""
        text = {
            "notice": NOTICE,
            "law": self.law,
            "seed": self.seed,
            "family": self.family,
            "about": self.about,
            "units": self.units,
            "constants": self.constants,
            "errors": self.errors,
            "tests": self.tests,
        }
        path = folder / "truth.json"
        path.write_text(json.dumps(text, indent=1, default=_plain) + "\n", encoding="utf-8")
        arrays: dict[str, Any] = dict(self.arrays)
        np.savez_compressed(folder / "truth.npz", **arrays)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"cannot write {type(value)} as JSON")

"""Pages of the Python interface: the public names, and the physics functions, a page for each room.

A physics function is documented where its docstring says what it takes, gives and refuses; the
others are for their neighbours.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Iterator

import reduction

__all__ = ["pages"]

BESIDE = {
    "reduction.archive.csv_tables.table_of": "autofunction",
    "reduction.cli.export.ExportedFiles": "autoclass",
    "reduction.quantities.units.parse_quantity": "autofunction",
    **{
        f"reduction.record.errors.{name}Error": "autoexception"
        for name in ("Reduction", "Settings", "Log", "Data", "Fit", "Archive")
    },
}
"""What the public functions give and raise, and what their users need beside them."""

ROOMS = {
    "stages": "standstills, the lag between channels, and the load train",
    "stages.strain": "position to strain of the splice-free length; load to stress",
    "stages.cycles": "reversals, cycles, loops, energy",
    "stages.moduli": "tangent, secant and chord moduli, segments, slips, elastomer laws",
    "stages.holds": "relaxation and creep",
    "stages.three_parameter_line": "the three-parameter line, slow pulls, rope programmes",
    "experiments": "response surfaces, screening, stiffness forms; breaks, abrasion, lives",
    "prediction": "hoses, armour and waves from theory; measured against predicted",
}
"""Rooms of the physics functions."""


def _physics(room: str) -> Iterator[tuple[str, list[str]]]:
    """Modules of a room, each with the names of its documented functions."""
    package = importlib.import_module(f"reduction.{room}")
    for info in pkgutil.iter_modules(package.__path__, f"reduction.{room}."):
        module = importlib.import_module(info.name)
        names = [
            name
            for name, thing in vars(module).items()
            if inspect.isfunction(thing)
            and thing.__module__ == info.name
            and not name.startswith("_")
            and "Parameters\n---" in (inspect.getdoc(thing) or "")
        ]
        if names:
            yield info.name, names


def _first_line(thing: object) -> str:
    text = inspect.getdoc(thing) or ""
    return " ".join(text.partition("\n\n")[0].split())


def _titled(title: str, rule: str) -> str:
    return f"{title}\n{rule * len(title)}\n"


def _room_page(room: str, words: str) -> str:
    """A table of the functions, then each module with those it has."""
    rows, parts = [], []
    for name, functions in _physics(room):
        module = importlib.import_module(name)
        rows += [
            f"* :py:func:`~{name}.{one}`: {_first_line(getattr(module, one))}" for one in functions
        ]
        parts.append(
            f"{_titled(f'``{name}``', '-')}\n"
            f".. automodule:: {name}\n   :members: {', '.join(functions)}\n"
        )
    return "\n".join(
        [
            _titled(f"``reduction.{room}``", "="),
            f"{words[0].upper()}{words[1:]}.\n",
            *rows,
            "",
            *parts,
        ]
    )


def pages() -> dict[str, str]:
    """Name below ``reference/`` to text: the public names, then one page for each room."""
    public = [f"reduction.{name}" for name in reduction.__all__ if not name.startswith("_")]
    made = {f"api/{room}.rst": _room_page(room, words) for room, words in ROOMS.items()}
    rooms = "\n".join(f"* :doc:`{room}`: {words}" for room, words in ROOMS.items())
    toc = "\n".join(f"   {room}" for room in ROOMS)
    names = "\n".join(f".. autofunction:: {name}\n" for name in public)
    beside = "\n".join(
        f".. {directive}:: {name}\n" + ("   :members: plot\n" if directive == "autoclass" else "")
        for name, directive in BESIDE.items()
    )
    made["api/index.rst"] = (
        f"{_titled('Python interface', '=')}\n"
        "A script needs little more than the functions of the package itself "
        "(:doc:`how they are used </python>`). What lies behind them may change from one version "
        "to the next; these names, and the files that they write, do not.\n\n"
        f"{_titled('Functions', '-')}\n{names}\n"
        f"{_titled('What they give, raise and need', '-')}\n{beside}\n"
        f"{_titled('Physics', '-')}\n"
        "Physics functions take arrays and return arrays, in SI; nothing in them reads a file or "
        "the clock. In parameters ``[1]`` is the unit of a number without dimension.\n\n"
        f"{rooms}\n\n.. toctree::\n   :hidden:\n   :titlesonly:\n\n{toc}\n"
    )
    return made

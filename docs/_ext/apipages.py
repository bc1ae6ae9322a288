"""Pages of the application programming interface: one for each room, with a section a module.

Public is what a script may well import: every room of physics, what the reports print, exports,
and the doors of the edges (one that opens, one that reads, one that runs). How an archive is laid
out or a page put together inside is not.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Iterator
from types import ModuleType

__all__ = ["pages", "public_modules"]

ROOMS = {
    "stages": "standstills, and the lag between channels",
    "stages.strain": "position to strain of the splice-free length; load to stress",
    "stages.cycles": "reversals, cycles, loops, energy",
    "stages.moduli": "tangent, secant and chord moduli, segments, slips, elastomer laws",
    "stages.holds": "relaxation and creep",
    "stages.three_parameter_line": "the three-parameter line, slow pulls, rope programmes",
    "experiments": "response surfaces, screening, stiffness forms; breaks, abrasion, lives",
    "uncertainty": "what errors that samples share do to each number",
    "prediction": "hoses, armour and waves from theory; measured against predicted",
    "lines": "design values, composite curves, assemblies, line types for mooring codes",
    "published": "what the reports print",
}
"""Rooms of which every module is public."""

DOORS = {
    "reduction": "the package",
    "reduction.python_interface": "what a script calls: run, look up",
    "reduction.archive.campaign_tree": "processed campaigns as trees of datasets",
    "reduction.archive.csv_tables": "tables as pandas DataFrames",
    "reduction.archive.open": "one archive",
    "reduction.archive.surfaces_dataset": "surfaces out of their archive",
    "reduction.archive.uncertainty_budget": "uncertainty budgets out of an archive",
    "reduction.batch.run_campaign": "a campaign from its logs to its products",
    "reduction.campaign.load": "campaign.toml",
    "reduction.batch.catalogue": "the catalogues of campaigns",
    "reduction.record.errors": "errors and their exit statuses",
    "reduction.experiments.experiment": "an experiment in one piece",
    "reduction.readers.layout": "declared layouts of logs",
    "reduction.readers.raw_log": "a log as it was read",
    "reduction.readers.read_log": "readers of every format",
    "reduction.pipeline.reduce_test": "a record to a reduced test",
    "reduction.prediction.hose_prediction": "a prediction in one piece",
    "reduction.stages.reduced_test": "a reduced test in one piece",
    "reduction.record.contributions": "errors of a measurement, and what each adds to a number",
    "reduction.record.measurement": "records, specimens, flags",
    "reduction.published.reproduced_item": "a printed number beside the computed one",
    "reduction.published.reproduce_page": "every printed number again",
    "reduction.record.settings": "numbers of the reduction",
    "reduction.quantities.units": "numbers with units",
    "reduction.quantities.names": "names of quantities",
}
"""Single public modules."""


def _of_room(room: str) -> list[str]:
    package = importlib.import_module(f"reduction.{room}")
    found = [
        info.name
        for info in pkgutil.iter_modules(package.__path__, f"reduction.{room}.")
        if not info.ispkg and info.name not in DOORS
    ]
    return [name for name in found if _offers(importlib.import_module(name))]


def _offers(module: ModuleType) -> bool:
    """Whether a module defines a function, a class or a constant without an underscore."""
    return any(
        not name.startswith("_")
        and (getattr(thing, "__module__", None) == module.__name__ or name.isupper())
        for name, thing in vars(module).items()
    )


def public_modules() -> Iterator[str]:
    """Names of all of them."""
    yield from DOORS
    for room in ROOMS:
        yield from _of_room(room)


def _first_line(name: str) -> str:
    text = inspect.getdoc(importlib.import_module(name)) or ""
    return " ".join(text.partition("\n\n")[0].split())


def _titled(title: str, rule: str) -> str:
    return f"{title}\n{rule * len(title)}\n"


def _page(title: str, words: str, names: list[str]) -> str:
    """A table of the modules, then each with what it offers."""
    rows = "\n".join(f"* :py:mod:`{name}`: {_first_line(name)}" for name in names)
    parts = "\n".join(f"{_titled(f'``{name}``', '-')}\n.. automodule:: {name}\n" for name in names)
    return f"{_titled(title, '=')}\n{words}\n\n{rows}\n\n{parts}"


def pages() -> dict[str, str]:
    """Name below ``reference/`` to text: the index, the entry points, one page a room."""
    made = {
        f"api/{room}.rst": _page(
            f"``reduction.{room}``", f"{words[0].upper()}{words[1:]}.", _of_room(room)
        )
        for room, words in ROOMS.items()
    }
    made["api/doors.rst"] = _page(
        "Entry points", "Modules that open, read and run, and what they return.", list(DOORS)
    )
    rooms = "\n".join(f"* :doc:`{room}`: {words}" for room, words in ROOMS.items())
    toc = "\n".join(f"   {name}" for name in ("doors", *ROOMS))
    made["api/index.rst"] = (
        f"{_titled('Python interface', '=')}\n"
        "Physics functions take arrays and return arrays, in SI; nothing in them reads a file or "
        "the clock. Most scripts need little more than "
        ":py:func:`~reduction.archive.campaign_tree.open_campaign` and :doc:`the other entry "
        "points <doors>`. In parameters ``[1]`` is the unit of a number without dimension.\n\n"
        f"{rooms}\n\n.. toctree::\n   :hidden:\n   :titlesonly:\n\n{toc}\n"
    )
    return made

"""Questions to the design-value page, and what the command line shows for them."""

from pathlib import Path

import numpy as np

from reduction.cli import lookup as command
from reduction.cli.lookuppoints import Wanted
from reduction.errors import ReductionError
from reduction.units import display_unit

CLI_HINT = "--extrapolate flag gives the number and flags it."


class Told:
    """What a command shows, kept in place of being printed."""

    is_text = True

    def __init__(self, units):
        self.units = units
        self.tables, self.texts = [], []

    def show(self, table):
        self.tables.append(table)

    def say(self, text):
        self.texts.append(text)

    def answer(self, document):
        self.document = document


def level_text(number, unit):
    return f"{number} {unit}" if unit != "1" else str(number)


def shown_by_command(question, lines, monkeypatch):
    """Row of the table, sentences, or the refusal, of `reduction lookup` for a question."""
    monkeypatch.setattr(command, "lines_of", lambda source: lines)
    output = Told(question["system"])
    wanted = Wanted(
        quantity=question["quantity"],
        levels={name: level_text(*given) for name, given in question["levels"].items()},
        name=question["name"],
        branch=question["branch"],
        extrapolate="flag" if question["flag"] else "refuse",
    )
    try:
        command.look_up_values("of the page", wanted, output=output)
    except ReductionError as error:
        return {"refused": str(error)}
    (table,) = output.tables
    heads = [str(column.header).replace("\\[", "[") for column in table.columns]
    cells = [next(iter(column.cells)) for column in table.columns]
    headline, *said = output.texts
    return {
        "headline": headline,
        "row": [list(pair) for pair in zip(heads, cells, strict=True)],
        "said": said,
    }


def levels_of(line, quantity, branch):
    """Names and tested ranges of what a quantity is asked at. [SI]"""
    name = "dissipation_spring_constant" if quantity == "dashpot_coefficient" else quantity
    surface = line.surfaces.get(name)
    if surface is not None:
        return {
            factor: (surface.low[place], surface.high[place])
            for place, factor in enumerate(line.factor_names)
        }
    (curve,) = [
        one for one in line.curves if one.quantity == name and one.branch in ("", branch)
    ]  # fmt: skip
    return {curve.variable: (curve.low, curve.high)}


def questions(sources, count, seed):
    """Random questions about lines: `sources` are (key, line) of the page, each is asked."""
    chance = np.random.default_rng(seed)
    found = []
    pairs = [(key, line, quantity) for key, line in sources for quantity in line.quantities]
    order = chance.permutation(len(pairs))
    for number in range(count):
        key, line, quantity = pairs[order[number % len(pairs)]]
        branches = [one.branch for one in line.curves if one.quantity == quantity and one.branch]
        branch = str(chance.choice(branches)) if branches else None
        system = str(chance.choice(["si", "us"]))
        levels = {}
        where = chance.choice(["inside", "inside", "inside", "edge", "outside"])
        for name, (low, high) in levels_of(line, quantity, branch).items():
            share = {
                "inside": chance.uniform(0, 1),
                "edge": chance.choice([0.0, 0.5, 1.0]),
                "outside": chance.uniform(-0.3, 1.3),
            }[where]
            levels[name] = _written(low + share * (high - low), name, line, system, chance)
        found.append(
            {
                "line": key, "name": line.name, "quantity": quantity, "levels": levels,
                "branch": branch, "flag": bool(chance.integers(2)), "system": system,
            }
        )  # fmt: skip
    return found


def _written(value, name, line, system, chance):
    """A level as a person writes it: a number of few or of many digits, and a unit."""
    digits = int(chance.choice([3, 5, 17]))
    if name == "frequency":
        unit, factor = "Hz", 1.0
    elif name == "strain":
        unit, factor = str(chance.choice(["%", "1"])), 1.0
        factor = 100.0 if unit == "%" else 1.0
    elif np.isfinite(line.rated_break_strength) and chance.integers(2):
        unit, factor = "%RBS", 100 / line.rated_break_strength
    else:
        unit, factor = display_unit("N", system)
    return [float(f"{factor * value:.{digits}g}"), unit]


def page_lines(processed, lines_of):
    """Lines of a page by their keys, as the page has them, with what the command reads."""
    published = lines_of("published")
    found = [(line.name, line, published) for line in published]
    for folder in sorted(Path(processed).glob("*/")):
        own = lines_of(str(folder))
        found += [(f"{folder.name}/{line.name}", line, own) for line in own]
    return found

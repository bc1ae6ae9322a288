"""Write docs/glossary.md from `reduction.vocabulary`: ``python docs/make_glossary.py``."""

from __future__ import annotations

import re
from pathlib import Path

from reduction.record import Quality
from reduction.vocabulary import BRANCH_VALUES, PHASE_VALUES, QUANTITIES

__all__ = ["glossary"]

_SOURCES = {"002": "WHOI-2005-10", "003": "CG-D-39-80"}
_HEAD = """\
# Glossary

<!-- Written by docs/make_glossary.py from reduction/vocabulary.py; change it there. -->

One name a quantity, the same in code, archives and tables; files are SI. A variable
`NAME_standard_uncertainty` has the unit of `NAME`. A table's header is `NAME [unit]`.

| word | means |
|---|---|
| strain | nominal (engineering) strain of the splice-free length |
| stretch ratio | 1 + strain |
| amplitude | half a range |
| spring constant | force per unit strain |
| modulus | slope of nominal stress on strain, on the area at zero tension |
| stress at an elongation | the M100 of the rubber trade, which is a stress and no modulus |
| free length | splice toe to splice toe |
| hold, rest | the crosshead stands still under tension; with every specimen slack |
| ascending, descending | the control channel (position, or tension) rises; falls |
| type A | found from scatter or residuals; nothing that all samples share is in it |

## Values of flags

| variable | values |
|---|---|
"""


def _symbol(text: str) -> str:
    return re.sub(r"\b00[23]\b", lambda match: _SOURCES[match[0]], text)


def _row(*cells: str) -> str:
    return "|" + "|".join(f" {cell} " if cell else " " for cell in cells) + "|"


def glossary() -> str:
    """Text of docs/glossary.md."""
    flags = {"phase": PHASE_VALUES, "branch": BRANCH_VALUES}
    masks = {str(mask.name).lower(): mask.value for mask in Quality}
    flags |= dict.fromkeys(("quality_flag", "crosshead_position_quality_flag"), masks)
    lines = [
        _row(f"`{name}`", ", ".join(f"{value} {word}" for word, value in values.items()))
        for name, values in flags.items()
    ]
    lines += ["", "## Quantities", "", _row("name", "unit", "what", "symbol in the source")]
    lines += ["|---|---|---|---|"]
    lines += [
        _row(f"`{one.name}`", one.unit or "text", one.long_name, _symbol(one.symbol))
        for one in sorted(QUANTITIES.values(), key=lambda one: one.name)
    ]
    return _HEAD + "\n".join(lines) + "\n"


if __name__ == "__main__":
    Path(__file__).with_name("glossary.md").write_text(glossary(), encoding="utf-8", newline="\n")

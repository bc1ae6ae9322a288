"""
From tests to a deployed line
=============================

The windows of all tests of a tether become one curve from zero; four tethers with their splices become
an assembly; and the curve becomes a line type for a mooring code.
"""

from pathlib import Path

import matplotlib.pyplot as plt

from reduction.lines.assembly import _assemble, _equal_tethers, _Tether
from reduction.lines.composite import CompositeRule, compose, used_of
from reduction.lines.deck_formats import export_line
from reduction.lines.export_sources import line_from_composite
from reduction.lines.published_source import published_piece_sources

# %%
# The used tether of WHOI-2005-10: the printed pieces of six tests, and the static test.

source = published_piece_sources()["rubber-tether-used"]
curve = compose(source, CompositeRule())
figure, axes = plt.subplots()
for piece in source.pieces:
    axes.plot(100 * piece.strain, piece.tension, color="grey", linewidth=0.8)
half = 1.96 * curve.standard_uncertainty
(line,) = axes.plot(100 * curve.strain, curve.tension, label="composite")
axes.fill_between(100 * curve.strain, curve.tension - half, curve.tension + half, alpha=0.25)
axes.set(xlabel="strain [%]", ylabel="tension [N]", title="used tether: published, WHOI-2005-10")
axes.legend()

# %%
# Four of them side by side, as long as the tested one, splices included.

four = _assemble(_equal_tethers(_Tether(curve=curve, model=source.model), 4))
figure, axes = plt.subplots()
axes.plot(four.total_length, four.tension / 1e3)
axes.set(
    xlabel="length from thimble to thimble [m]",
    ylabel="tension of four tethers [kN]",
    title="assembly of four used tethers: published pieces",
)

# %%
# And the curve of one as a line type of MoorDyn. What a tension test does not measure is stated.

line = line_from_composite(used_of(source, curve), curve, linear_density=0.6)
paths = export_line(line, "moordyn", Path("tether.dat"))
text = Path("tether.dat").read_text(encoding="utf-8")
print(*(path.name for path in paths))
print(text[text.index("LINE TYPES") - 23 :][:330])

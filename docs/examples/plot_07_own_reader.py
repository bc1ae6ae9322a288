"""
A log of your own, read by yourself
===================================

Where no layout fits, a few lines of Python do: physics functions take arrays in SI, wherever they are
from. (A reader for everybody belongs into the package; :doc:`how </develop>`.)
"""

import matplotlib.pyplot as plt
import numpy as np

from reduction.record.settings import CycleSettings, ModulusSettings, PhaseSettings
from reduction.stages.cycles.cycle_search import find_cycles
from reduction.stages.moduli.tangent_modulus import tangent_curves
from reduction.stages.standstills import find_standstills

# %%
# A log as no program should write it: minutes, millimetres and kilonewtons in one field, with decimal
# commas. It is made here from a known law: 10 MPa.

AREA, LENGTH, MODULUS = 5e-4, 2.0, 10e6
rng = np.random.default_rng(1)
seconds = np.arange(0.0, 260.0, 0.1)
turns = np.arange(20, 261, 10)
stroke = np.interp(seconds, [0, 10, *turns], [0, 0, *np.where(turns % 20 == 0, 0.4, 0.3)])
force = MODULUS * AREA * stroke / LENGTH + rng.normal(0, 0.3, stroke.size)
log = "\n".join(
    f"t={time / 60:.5f} s={1e3 * x:.2f} F={f / 1e3:.5f}".replace(".", ",")
    for time, x, f in zip(seconds, stroke, force, strict=True)
)
print(*log.splitlines()[300:303], sep="\n")


# %%
# The reader: every field is a number or an error, and the units are left behind here.


def read(text: str) -> np.ndarray:
    """Time [s], position [m] and tension [N] of each line."""
    fields = [part.partition("=")[2].replace(",", ".") for part in text.split()]
    return np.array(fields, dtype=np.float64).reshape(-1, 3).T * [[60.0], [1e-3], [1e3]]


time, position, tension = read(log)

# %%
# And the stages: standstills, cycles, moduli.

strain = position / LENGTH
still = find_standstills(time, position, [tension], settings=PhaseSettings())
cycles = find_cycles(time, position, [tension], still, settings=CycleSettings())
curves = tangent_curves([strain], [tension], area=[AREA], cycles=cycles, settings=ModulusSettings())
print(f"{cycles.first.size} cycles")
for name, modulus in zip(("ascending", "descending"), curves.tangent_modulus[0], strict=True):
    print(f"{name:10} {np.nanmean(modulus) / 1e6:.2f} MPa")

figure, axes = plt.subplots()
axes.plot(100 * curves.strain_bin, curves.tangent_modulus[0].T / 1e6, "o-")
axes.set(
    ylim=(0, 12),
    xlabel="strain [%]",
    ylabel="tangent modulus [MPa]",
    title="a log of its own: synthetic data",
)

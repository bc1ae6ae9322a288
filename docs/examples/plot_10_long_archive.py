"""
A long archive, a chunk at a time
=================================

With ``chunks`` the tree is made of Dask arrays: what is asked for is computed in pieces, and the record
need not fit into memory. Dask comes with ``pip install "mooring-reduction[cluster]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

import reduction

with reduction.open_campaign("processed/tmt-synthetic", chunks={"sample": 65536}) as campaign:
    test = campaign["T-4-extended"].to_dataset().sel(specimen="new")
    stress = test["nominal_stress"]
    print(f"{stress.size} samples in {stress.data.numblocks[0]} piece")
    print(f"highest stress {float(stress.max().compute()) / 1e6:.3f} MPa")
    peaks = test["peak_tension"].compute()

# %%
# This record fits into one piece; one of ten million samples has 153, and the lines are the same.
#
# The peaks of 3,000 cycles: what rubber loses, and two steps at which a splice slipped.

figure, axes = plt.subplots()
axes.semilogx(np.arange(1, peaks.size + 1), peaks)
axes.set(
    xlabel="cycle",
    ylabel="peak tension [N]",
    title="extended test, new tether: synthetic data",
)

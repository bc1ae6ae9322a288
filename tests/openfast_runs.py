"""MoorDyn of OpenFAST, by its driver: the line of a deck, stretched as it is told."""

import shutil
import subprocess

import numpy as np
from export_readers import moordyn_sections

from reduction.lines.client_runs import _OPENFAST

DRIVER = shutil.which("moordyn_driver")


def stretched(folder, deck, time, strain):
    """Strain, as MoorDyn had it, and tension at the upper end, at every step of its own."""
    text = (folder / deck).read_text().replace("\nFairTen1\n", "\nFairTen1\nPoint2Pz\n")
    (folder / deck).write_text(text)
    sections = moordyn_sections(text)
    length = float(sections["LINES"][0][4])
    anchor = float(sections["POINTS"][0][4])
    (depth,) = (row[0] for row in sections["OPTIONS"] if row[1] == "WtrDpth")
    height = anchor + length * (1 + np.asarray(strain))
    motion = np.column_stack([time, 0 * height, 0 * height, height])
    np.savetxt(folder / "motion.txt", motion, fmt="%.10g")
    (folder / "driver.inp").write_text(
        _OPENFAST.format(depth=depth, deck=deck, end=time[-1], step=time[1] - time[0])
    )
    done = subprocess.run(
        [DRIVER, "driver.inp"], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout[-1500:]
    rows = (folder / "out.MD.out").read_text().split("\n")
    (head,) = (place for place, row in enumerate(rows) if row.split()[:1] == ["Time"])
    table = np.array([row.split() for row in rows[head + 2 :] if row.strip()], dtype=float)
    column = {name.lower(): place for place, name in enumerate(rows[head].split())}
    at = table[:, column["point2pz"]]
    return table[:, 0], (at - anchor) / length - 1, table[:, column["fairten1"]]

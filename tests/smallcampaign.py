"""Two tests of the synthetic campaign as a campaign of their own, for the tests of the command."""

import shutil
from pathlib import Path

RAW = Path(__file__).parents[1] / "raw" / "tmt-synthetic"
CAMPAIGN = """
[campaign]
id = "small"
title = "Small campaign (synthetic)"
source = "synthetic"
[specimens.new]
kind = "rubber tether"
diameter = ["1.04 in"]
[specimens.used]
kind = "rubber tether"
diameter = ["0.94 in"]
[layouts.logger]
format = "delimited"
comment = "#"
[layouts.logger.channels]
time = { column = "time_s", unit = "s" }
crosshead_position = { column = "crosshead_ft", unit = "ft", datum = "pin-to-pin" }
tension.1 = { column = "load_new_lb", unit = "lbf" }
tension.2 = { column = "load_used_lb", unit = "lbf" }
[defaults]
layout = "logger"
specimens = ["new", "used"]
"""


def write_logs(folder, logs="."):
    """Copy the logs of T-1 and T-2 as A and B into a folder of their own, and their marks."""
    (folder / logs).mkdir(parents=True)
    shutil.copy(RAW / "T-1.csv", folder / logs / "A.csv")
    shutil.copy(RAW / "T-2.csv", folder / logs / "B.csv")
    lines = (RAW / "marks.csv").read_text().splitlines()
    kept = [line for line in lines if line.startswith(("test,", "T-1,", "T-2,"))]
    text = "\n".join(kept).replace("T-1,", "A,").replace("T-2,", "B,") + "\n"
    (folder / "marks.csv").write_text(text)

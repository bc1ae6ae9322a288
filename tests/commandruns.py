"""The command in a process of its own, and a campaign of the project that it ran."""

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]


def reduction(*arguments, cwd=ROOT, **environment):
    """Run the command as a user would, in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "reduction", *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"PYTHONPATH": str(ROOT)} | environment,
    )


@dataclass(frozen=True)
class Run:
    processed: Path
    reports: Path
    done: subprocess.CompletedProcess


def run_campaign(name, folder, *options, **environment):
    done = reduction(
        "run", ROOT / "raw" / name / "campaign.toml", "--processed", folder / "processed",
        "--reports", folder / "reports", *options, **environment,
    )  # fmt: skip
    return Run(folder / "processed" / name, folder / "reports" / name, done)

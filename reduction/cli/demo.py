"""Implements the command demo: the synthetic campaigns, for users who have only the package."""

from __future__ import annotations

import shutil
from pathlib import Path

from reduction.campaign.load import load_campaign
from reduction.cli.campaigns import run_campaign
from reduction.cli.output import CommandOutput
from reduction.record.errors import SettingsError

_NAMES = ("tmt-synthetic", "nylon-synthetic", "hose-synthetic")

_PACKAGE = Path(__file__).parents[1]

_MADE_HERE = shutil.ignore_patterns("__pycache__")


def _campaigns() -> Path:
    """Location of the campaigns: in an installed package, or in its checkout."""
    installed = _PACKAGE / "demo"
    return installed if installed.is_dir() else _PACKAGE.parent / "raw"


def run_demo(folder: Path, output: CommandOutput) -> None:
    """Copy each campaign to ``raw`` in a folder and run it; existing files are not replaced."""
    raw = folder / "raw"
    standing = [name for name in _NAMES if (raw / name).exists()]
    if standing:
        raise SettingsError(
            f"{raw}: campaigns are there already", found=", ".join(standing),
            needed="a folder without them",
            hint="Name another folder, or run them as they are: "
            f'reduction run "{raw / standing[0] / "campaign.toml"}"',
        )  # fmt: skip
    for name in _NAMES:
        shutil.copytree(_campaigns() / name, raw / name, ignore=_MADE_HERE)
    documents = []
    for name in _NAMES:
        campaign = load_campaign(raw / name / "campaign.toml")
        output.say(f"{campaign.attributes['title']}: {raw / name / 'campaign.toml'}\n")
        documents.append(
            run_campaign(
                campaign, processed=folder / "processed", reports=folder / "reports", tests=(),
                force=False, jobs=None, scheduler=None, output=output,
            )
        )  # fmt: skip
        output.say("")
    output.answer({"folder": str(folder), "campaigns": documents})

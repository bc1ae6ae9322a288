"""The command ``verify`` with its options; the work is elsewhere."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.commandoutput import CommandOutput, guarded
from reduction.cli.options import AllowRemote, Json, OwnCampaign, Quiet
from reduction.cli.usage import here


def verify(
    processed_dir: Annotated[
        Path,
        typer.Argument(
            metavar="PROCESSED_DIR",
            help="processed/CAMPAIGN, or processed/ for all.",
            show_default=False,
            callback=here,
        ),
    ],
    campaign: OwnCampaign = None,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Look whether raw files and products still belong together; change nothing."""
    with guarded(CommandOutput(json=json, quiet=quiet)) as output:
        from reduction.cli.verify import verify_products

        verify_products(processed_dir, campaign=campaign, allow_remote=allow_remote, output=output)

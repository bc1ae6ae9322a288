"""The command ``explore`` with its options; the work is elsewhere."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.commandoutput import CommandOutput, guarded
from reduction.cli.options import Json, OwnCampaign, Quiet, Units
from reduction.cli.usage import here


def explore(
    processed_dir: Annotated[
        Path,
        typer.Argument(
            metavar="PROCESSED_DIR", help="processed/CAMPAIGN.", show_default=False, callback=here
        ),
    ],
    campaign: OwnCampaign = None,
    port: Annotated[int, typer.Option(min=0, max=65535, help="Of 127.0.0.1; 0: a free one.")] = 0,
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page.")] = True,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Move the settings of a test on a local page, see what follows, save them."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.explore import serve

        serve(processed_dir, campaign=campaign, port=port, opens=browser, output=output)

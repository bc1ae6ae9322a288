"""Options and arguments that several commands share, each with its words in ``--help``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.usage import here

__all__ = ["AllowRemote", "CampaignPath", "Json", "OwnCampaign", "Quiet", "SpecPath", "Units"]


def _here(path: Path | None) -> Path | None:
    return None if path is None else here(path)


Json = Annotated[bool, typer.Option("--json", help="One JSON object on standard output, SI.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Nothing but errors.")]
Units = Annotated[str, typer.Option("--units", help="What is shown: si or us (psi, lbf, ft).")]
SpecPath = Annotated[Path, typer.Argument(metavar="SPEC.toml", show_default=False, callback=here)]
CampaignPath = Annotated[str, typer.Argument(metavar="CAMPAIGN.toml", show_default=False)]
AllowRemote = Annotated[
    bool,
    typer.Option("--allow-remote", help="Let files be addresses, such as s3://bucket/T-1.csv."),
]
OwnCampaign = Annotated[
    Path | None,
    typer.Option(
        metavar="CAMPAIGN.toml",
        help="Where the campaign is, if in neither raw/CAMPAIGN/ nor CAMPAIGN/.",
        show_default=False,
        callback=_here,
    ),
]

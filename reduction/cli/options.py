"""Options and arguments that several commands share, each with its words in ``--help``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.usage import here, written_here


def here_if_given(path: Path | None) -> Path | None:
    """A path of this machine, where one is given."""
    return None if path is None else here(path)


Json = Annotated[bool, typer.Option("--json", help="One JSON object on standard output, SI.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Nothing but errors.")]
Units = Annotated[str, typer.Option("--units", help="What is shown: si or us (psi, lbf, ft).")]
SpecPath = Annotated[Path, typer.Argument(metavar="SPEC.toml", show_default=False, callback=here)]
CampaignPath = Annotated[
    Path, typer.Argument(metavar="CAMPAIGN.toml", show_default=False, callback=here)
]
ProcessedOut = Annotated[Path, typer.Option(help="Where products go.", callback=written_here)]
ReportsOut = Annotated[Path, typer.Option(help="Where the report goes.", callback=written_here)]
AllowRemote = Annotated[
    bool,
    typer.Option("--allow-remote", help="Let logs and archives be addresses: s3://bucket/T-1.csv."),
]
OwnCampaign = Annotated[
    Path | None,
    typer.Option(
        metavar="CAMPAIGN.toml",
        help="Where the campaign is, if in neither raw/CAMPAIGN/ nor CAMPAIGN/.",
        show_default=False,
        callback=here_if_given,
    ),
]

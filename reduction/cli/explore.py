"""Implements the command explore."""

from __future__ import annotations

import os
import traceback
import webbrowser
from contextlib import suppress
from pathlib import Path

from reduction.campaign.load import find_campaign
from reduction.cli.output import INTERRUPTED, CommandOutput
from reduction.cli.progress import campaign_progress
from reduction.cli.remote_paths import in_order
from reduction.pages.explorer_campaign import Session
from reduction.pages.explorer_server import ExploreServer
from reduction.record.errors import SettingsError


def serve(
    processed: Path, *, campaign: Path | None, port: int, opens: bool, output: CommandOutput
) -> None:
    """Serve the page of a campaign until Ctrl-C or a request of the system to end."""
    if output.quiet and not opens:
        raise SettingsError(
            "the address would not be shown anywhere",
            found="--quiet and --no-browser",
            needed="at most one of them",
        )
    path = find_campaign(processed, campaign)
    with campaign_progress(output) as progress:
        session = Session(path, processed, progress=progress)

    def on_defect(error: Exception) -> None:
        if os.environ.get("REDUCTION_DEBUG"):
            output.error("".join(traceback.format_exception(error)))
        output.defect(error)

    with in_order(), ExploreServer(session, output.system, port, on_defect) as server:
        output.say(f"{path}: {len(session.surveys)} tests")
        output.say(f"Open {server.address}")
        output.say("Ctrl-C ends it. It answers only this machine, and only at this address.")
        output.answer(
            {"address": server.address, "campaign": str(path), "port": server.server_port}
        )
        if opens:
            with suppress(webbrowser.Error):  # the address has been printed
                webbrowser.open(server.address)
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            output.say("Ended.")
            output.raise_status(INTERRUPTED)

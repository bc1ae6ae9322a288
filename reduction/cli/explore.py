"""The explorer's server, from its start until it is interrupted."""

from __future__ import annotations

import os
import signal
import threading
import webbrowser
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import cast

from reduction.cli.commandoutput import CommandOutput
from reduction.cli.progress import campaign_progress
from reduction.explore.find import find_campaign
from reduction.explore.routes import Routes
from reduction.explore.server import ExploreServer
from reduction.explore.session import Session
from reduction.explore.work import Work
from reduction.units import UnitSystem

__all__ = ["serve"]


def serve(
    processed: Path, *, campaign: Path | None, port: int, opens: bool, output: CommandOutput
) -> None:
    """Serve the page of a campaign until Ctrl-C or SIGTERM."""
    path = find_campaign(processed, campaign)
    with campaign_progress(output) as progress:
        session = Session(path, processed, progress=progress)

    def told_of_defect(error: Exception) -> None:
        if os.environ.get("REDUCTION_DEBUG"):
            raise error
        output.error(
            f"internal error, a defect of this program: {type(error).__name__}: {error}. "
            "Set REDUCTION_DEBUG=1 to see where, and please report it."
        )

    work = Work(told_of_defect)
    units = cast("UnitSystem", output.units)
    with ExploreServer(Routes(session, work, units), port) as server:
        output.say(f"{path}: {len(session.surveys)} tests")
        output.say(f"Open {server.address}")
        output.say("Ctrl-C ends it. Only this machine is answered, and only with this address.")
        output.answer(
            {"address": server.address, "campaign": str(path), "port": server.server_port}
        )
        if opens:
            with suppress(webbrowser.Error):  # the address was printed
                webbrowser.open(server.address)
        thread = threading.Thread(target=server.serve_forever, daemon=True, name="server")
        thread.start()
        try:
            _wait_for_end()
        finally:
            server.shutdown()
            work.close()


def _wait_for_end() -> None:
    """Return at SIGTERM; an interrupt from the keyboard is raised as ever."""
    ended = threading.Event()

    def end(number: int, frame: FrameType | None) -> None:
        ended.set()

    signal.signal(signal.SIGTERM, end)
    while not ended.wait(0.5):
        pass

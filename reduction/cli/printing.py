"""A report as PDF, printed by a browser that is installed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from reduction.archive.whole import whole_file
from reduction.errors import ArchiveError, SettingsError

_NAMES = (
    "chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome",
    "microsoft-edge", "microsoft-edge-stable", "msedge",
)  # fmt: skip
# where installers put a browser that is not on the path
_PLACES = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
    r"C:\Program Files\Google\Chrome\Application\chrome.exe",
    r"C:\Program Files (x86)\Microsoft\Edge\Application\msedge.exe",
)
# the page is all that it may read: no network, no profile, nothing of what a browser does by itself
_ALONE = (
    "--headless", "--disable-gpu", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-default-apps", "--disable-extensions",
    "--disable-sync", "--proxy-server=127.0.0.1:9", "--proxy-bypass-list=<-loopback>",
    "--host-resolver-rules=MAP * ~NOTFOUND",
    "--no-pdf-header-footer",
)  # fmt: skip
_LONGEST = 180.0
_BY_HAND = "Open the page in any browser and print it to PDF, without headers and footers."


def find_browser() -> str:
    """Return the program that prints: ``BROWSER_PROGRAM``, or the first browser that is there.

    Raises
    ------
    SettingsError
        If there is none.
    """
    asked = os.environ.get("BROWSER_PROGRAM")
    if asked:
        found = shutil.which(asked)
        if found is None:
            raise SettingsError(
                "BROWSER_PROGRAM is no program", found=repr(asked),
                needed="Chromium, Chrome or Edge", hint=_BY_HAND,
            )  # fmt: skip
        return found
    candidates = (shutil.which(name) for name in (*_NAMES, *_PLACES))
    program = next(filter(None, candidates), None)
    if program is None:
        raise SettingsError(
            "there is no browser that could print the report",
            found="neither Chromium nor Chrome nor Edge",
            needed="one of them on the path, or its path in BROWSER_PROGRAM",
            hint=_BY_HAND,
        )
    return program


def print_page(page: Path, pdf: Path, *, browser: str) -> None:
    """Print a page to PDF; the file appears whole or not at all.

    Parameters
    ----------
    page : pathlib.Path
        HTML with its paper and its margins in it.
    pdf : pathlib.Path
        The file.
    browser : str
        Program, as `find_browser` found it.

    Raises
    ------
    ArchiveError
        If the browser fails, or takes longer than three minutes.
    """
    with tempfile.TemporaryDirectory(prefix="reduction-print-") as profile, whole_file(pdf) as part:
        # a browser that is run by root refuses its own sandbox
        is_root = sys.platform != "win32" and os.geteuid() == 0
        printed = Path(profile) / "printed.pdf"
        command = [
            browser, *_ALONE, *(["--no-sandbox"] if is_root else []),
            f"--user-data-dir={Path(profile) / 'profile'}", f"--print-to-pdf={printed}",
            page.absolute().as_uri(),
        ]  # fmt: skip
        said = _run(command, browser)
        if not (printed.is_file() and printed.read_bytes()[:5] == b"%PDF-"):
            raise ArchiveError(
                f"{pdf} was not printed", found=f"{browser}: {said or 'no word of why'}",
                needed="a browser that prints without a window", hint=_BY_HAND,
            )  # fmt: skip
        shutil.copyfile(printed, part)


def _run(command: list[str], browser: str) -> str:
    """Run the browser; return the last thing that it said."""
    try:
        done = subprocess.run(  # noqa: S603  # a list, no shell; the page is one of ours
            command, capture_output=True, timeout=_LONGEST, check=False
        )
    except subprocess.TimeoutExpired as error:
        raise ArchiveError(
            "the browser did not finish the report", found=f"{browser}, ended after {_LONGEST:g} s",
            hint=_BY_HAND,
        ) from error  # fmt: skip
    except OSError as error:
        raise ArchiveError(
            "the browser cannot be started", found=f"{browser}: {error.strerror or error}",
            hint=_BY_HAND,
        ) from error  # fmt: skip
    lines = done.stderr.decode("utf-8", "replace").strip().splitlines()
    return lines[-1] if lines else ""

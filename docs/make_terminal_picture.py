"""Draw what `reduction run` prints: docs/images/terminal.png.

    python docs/make_terminal_picture.py

Needs Chromium.
"""

from __future__ import annotations

import html
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
CAMPAIGN = "raw/tmt-synthetic/campaign.toml"
COLUMNS, LINE_HEIGHT, MARGIN, CHARACTER = 176, 17, 14, 7.24  # [1], [px], [px], [px]
PAGE = """<!DOCTYPE html><meta charset="utf-8"><style>
body {{ margin: 0; background: #1b1f27 }}
pre {{ margin: {margin}px; width: {columns}ch; color: #e6e6e6; white-space: pre-wrap;
      font: 12px/{height}px "DejaVu Sans Mono", monospace }}
b {{ color: #8fd18f; font-weight: normal }}
</style><pre><b>$ reduction run {campaign}</b>
{text}</pre>"""


def output_of_run(folder: Path) -> str:
    """What a run of the campaign prints."""
    shutil.copytree(ROOT / "raw" / "tmt-synthetic", folder / "raw" / "tmt-synthetic")
    done = subprocess.run(  # noqa: S603 - our own command
        [sys.executable, "-m", "reduction", "run", CAMPAIGN], cwd=folder, check=True,
        capture_output=True, text=True, env=os.environ | {"PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    return done.stdout.rstrip()


def draw(text: str, picture: Path, folder: Path) -> None:
    """Draw a text as a terminal shows it."""
    page = folder / "page.html"
    page.write_text(
        PAGE.format(margin=MARGIN, columns=COLUMNS, height=LINE_HEIGHT, campaign=CAMPAIGN,
                    text=html.escape(text)),
        encoding="utf-8",
    )  # fmt: skip
    lines = 1 + sum(1 + max(len(line) - 1, 0) // (COLUMNS - 4) for line in text.split("\n"))
    size = f"{2 * MARGIN + CHARACTER * COLUMNS:.0f},{2 * MARGIN + LINE_HEIGHT * lines}"
    browser = next(
        filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome")))
    )
    subprocess.run(  # noqa: S603 - the browser that is installed
        [browser, "--headless", "--no-sandbox", "--hide-scrollbars", f"--window-size={size}",
         f"--screenshot={picture}", page.as_uri()],
        check=True, capture_output=True,
    )  # fmt: skip


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        draw(output_of_run(Path(scratch)), ROOT / "docs" / "images" / "terminal.png", Path(scratch))

"""Draw what `reduction run` printed before the answers came first, and what it prints now.

    python docs/make_terminal_pictures.py

The pictures, docs/images/terminal-*.png, are of real output: the first of commit `BEFORE`, from its
own files. Needs git and Chromium.
"""

from __future__ import annotations

import html
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
BEFORE = "4205a881"
CAMPAIGN = "raw/tmt-synthetic/campaign.toml"
COLUMNS, LINE_HEIGHT, MARGIN, CHARACTER = 176, 17, 14, 7.24  # [1], [px], [px], [px]
PAGE = """<!DOCTYPE html><meta charset="utf-8"><style>
body {{ margin: 0; background: #1b1f27 }}
pre {{ margin: {margin}px; width: {columns}ch; color: #e6e6e6; white-space: pre-wrap;
      font: 12px/{height}px "DejaVu Sans Mono", monospace }}
b {{ color: #8fd18f; font-weight: normal }}
</style><pre><b>$ reduction run {campaign}</b>
{text}</pre>"""


def output_of(source: Path, folder: Path) -> str:
    """What a run of the campaign prints with the package of a folder."""
    shutil.copytree(ROOT / "raw" / "tmt-synthetic", folder / "raw" / "tmt-synthetic")
    done = subprocess.run(  # noqa: S603 - our own command
        [sys.executable, "-m", "reduction", "run", CAMPAIGN], cwd=folder, check=True,
        capture_output=True, text=True, env=os.environ | {"PYTHONPATH": str(source)},
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


def main() -> None:
    """Run and draw both."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        old = folder / "before"
        old.mkdir()
        packed = folder / "before.tar"
        git = ["git", "archive", "--output", str(packed), BEFORE, "reduction"]
        subprocess.run(git, cwd=ROOT, check=True)  # noqa: S603 - of this repository
        with tarfile.open(packed) as archive:
            archive.extractall(old, filter="data")
        for name, source in (("before", old), ("now", ROOT)):
            own = folder / f"run-{name}"
            own.mkdir()
            text = output_of(source, own)
            draw(text, ROOT / "docs" / "images" / f"terminal-{name}.png", own)


if __name__ == "__main__":
    main()

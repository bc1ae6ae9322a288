"""The commands for a first start: init and sniff.  What they print is for a person to confirm."""

from __future__ import annotations

from pathlib import Path

from reduction.cli.commandoutput import CommandOutput
from reduction.errors import SettingsError
from reduction.ingest.sniff import sniff_layout
from reduction.ingest.starter import starter_campaign
from reduction.visible import toml_comment


def print_layout(file: Path, output: CommandOutput) -> None:
    """Print a proposed layout in TOML, and what in it is a guess."""
    sniffed = sniff_layout(file)
    output.say(sniffed.toml, is_verbatim=True)
    for remark in sniffed.remarks:
        output.say(f"# {toml_comment(remark)}", is_verbatim=True)
    output.say("# `reduction init FOLDER` writes it into a campaign.toml beside the logs")
    output.answer({"layout": sniffed.toml, "remarks": list(sniffed.remarks)})


def start_campaign(folder: Path, output: CommandOutput) -> None:
    """Write campaign.toml and tests.csv into a folder of logs; never over an existing file."""
    if not folder.is_dir():
        raise SettingsError(f"{folder}: is not a folder", needed="a folder of logs")
    texts = starter_campaign(folder)
    standing = sorted(name for name in texts if (folder / name).exists())
    if standing:
        raise SettingsError(
            f"{folder}: a campaign is there already",
            found=", ".join(standing),
            needed="a folder without these files",
            hint="Move them away first; nothing is written over.",
        )
    for name, text in texts.items():
        with (folder / name).open("x", encoding="utf-8", newline="") as file:
            file.write(text)
        output.say(f"wrote {folder / name}")
    output.say(f"next: replace every ? in them, then: reduction check {folder / 'campaign.toml'}")
    output.answer({"written": [str(folder / name) for name in texts]})

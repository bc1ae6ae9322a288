"""docs/remote.md names the commands that have the option, the packages, and messages that there are."""

import re
from pathlib import Path

import typer

from reduction.cli.main import app
from reduction.readers.remote_files import PACKAGES

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "remote.md").read_text(encoding="utf-8")


def test_the_commands_with_the_option_are_named_and_so_are_those_without():
    commands = typer.main.get_command(app).commands
    having = {
        name
        for name, command in commands.items()
        if any("--allow-remote" in one.opts for one in command.params)
    }
    part = PAGE.partition("## Where URLs are accepted")[2].partition("\n## ")[0]
    table, _, below = part.partition("\ncampaign.toml, ")
    assert {name for name in commands if f"`{name}`" in table} == having
    without = {name for name in commands if f"`{name}`" in below}
    # these take no file, or none that is a product or a log
    assert without | having | {"demo", "reproduce", "schema"} == set(commands)
    assert not without & having


def test_the_packages_are_those_that_messages_name():
    told = {}
    for names, package in re.findall(r"^\| (`.*://`) \| (\w+)", PAGE, re.M):
        told |= dict.fromkeys(re.findall(r"`(\w+)://`", names), package)
    assert told == PACKAGES


def test_the_messages_are_those_of_the_program():
    source = (ROOT / "reduction" / "readers" / "remote_files.py").read_text(encoding="utf-8")
    part = PAGE.partition("## When it fails")[2]
    messages = re.findall(r"^\| `(?:\.\. )?(.*?)` \|", part, re.M)
    assert len(messages) == 8
    for message in messages:
        assert message.replace("gs://", "{protocol}://") in source, message

"""Reports usage errors in one line on standard error, or as JSON."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer
from typer.core import TyperGroup

from reduction.record.plain_text import shown_address

_NUMBERS = re.compile(r"[-+]?[\d.]+(?: to [-+]?[\d.]+)?")

_MANY = re.compile(r"(?<![\d.])\d{6,}")


def grouped(text: str) -> str:
    """A number or interval with a blank between thousands from 100000 on.

    Examples
    --------
    >>> grouped("98000 to 283100"), grouped("-123456.5"), grouped("0.0001234567")
    ('98000 to 283 100', '-123 456.5', '0.0001234567')
    >>> grouped("T-123456")
    'T-123456'
    """
    if not _NUMBERS.fullmatch(text):
        return text
    return _MANY.sub(lambda found: f"{int(found[0]):,}".replace(",", " "), text)


USAGE = 2

_LONGEST = 500

# the class of click, which some versions of typer include
_UsageError: type[Exception] = typer.BadParameter.__mro__[1]

_URL = re.compile(r"^([a-z][a-z0-9+.-]+):/+", re.IGNORECASE)


def here(path: Path) -> Path:
    """A local path; a remote address is refused with an explanation."""
    shown = _address_in(path)
    if shown:
        raise typer.BadParameter(
            f"this command reads no URLs; found '{shown}'; needed a local file. Download it first."
        )
    return path


def written_here(path: Path | None) -> Path | None:
    """A local path to write to, if given; an address is refused with an explanation."""
    shown = _address_in(path)
    if shown:
        raise typer.BadParameter(
            f"this command writes to no URLs; found '{shown}'; needed a local path"
        )
    return path


def _address_in(path: Path | None) -> str:
    """Safe form of an address given as a path; empty if there is none."""
    address = _URL.match(str(path))
    if address is None:
        return ""
    return shown_address(f"{address[1]}://{str(path)[address.end() :]}")


class Commands(TyperGroup):
    """The command group; unparsable lines get an answer in the form of its commands."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Print the full description of each command if no frame is drawn."""
        known = [(name, self.commands[name]) for name in self.list_commands(ctx)]
        with formatter.section("Commands"):
            formatter.write_dl([(name, one.get_short_help_str(_LONGEST)) for name, one in known])

    def main(self, args: Sequence[str] | None = None, *rest: Any, **options: Any) -> Any:
        """Run the command in the arguments."""
        given = list(sys.argv[1:] if args is None else args)
        options["standalone_mode"] = False
        _draw_help(self, is_drawn=sys.stdout.isatty())
        try:
            status = super().main(given, *rest, **options)
        except _UsageError as error:
            status = _refuse(given, error)
        except typer.Abort:
            status = 1
        sys.exit(status if isinstance(status, int) else 0)


def _draw_help(command: Any, *, is_drawn: bool) -> None:
    """Set frames and colours for the help of a command and its subcommands, or plain text."""
    command.rich_markup_mode = "rich" if is_drawn else None
    for below in getattr(command, "commands", {}).values():
        _draw_help(below, is_drawn=is_drawn)


def _refuse(given: Sequence[str], error: Any) -> int:
    """Print one line on standard error, or the help if there are no arguments."""
    message = error.format_message()
    if not given:
        typer.echo(message, err=True)
        return USAGE
    about = "" if error.ctx is None else f" See '{error.ctx.command_path} --help'."
    line = " ".join(message.split())
    line = f"{line}{'' if line.endswith(('.', '?')) else '.'}{about}"
    typer.echo(line, err=True)
    if "--json" in given:
        typer.echo(json.dumps({"tests": [], "error": line, "exit_status": USAGE}, indent=2))
    return USAGE

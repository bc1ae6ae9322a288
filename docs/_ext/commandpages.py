"""The page of the commands, made from the commands: their signatures, as typer reads them."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from types import NoneType
from typing import Any, Literal, get_args, get_origin, get_type_hints

from typer.models import ArgumentInfo, OptionInfo

from reduction.cli.main import app

__all__ = ["pages"]

_WORDS = {str: "text", int: "whole number", float: "number", Path: "path", bool: ""}


@dataclass(frozen=True)
class _Given:
    """One argument or option of a command."""

    names: str
    kind: str
    default: str
    words: str
    is_argument: bool
    is_required: bool


def _cell(text: str) -> str:
    """Words of a help text in a cell of a table: options in code, no markup by accident."""
    text = " ".join(text.split()).replace("|", "\\|").replace("<", "&lt;")
    return re.sub(r"(?<![`\w])(--[a-z][\w-]*)", r"`\1`", text)


def _kind(annotation: Any) -> str:
    inner = [one for one in get_args(annotation) if one is not NoneType]
    if get_origin(annotation) is Literal:
        return " \\| ".join(f"`{one}`" for one in inner)
    if get_origin(annotation) is list:
        return f"{_kind(inner[0])}, as often as wanted"
    if inner:
        return _kind(inner[0])
    if inspect.isclass(annotation) and issubclass(annotation, Enum):
        return " \\| ".join(f"`{one.value}`" for one in annotation)
    return _WORDS[annotation]


def _default(value: object, *, is_required: bool) -> str:
    if is_required:
        return "required"
    return "" if value in (None, False, "") else f"`{value}`"


def _spellings(name: str, info: ArgumentInfo | OptionInfo, *, is_switch: bool) -> list[str]:
    """How an option is written; the first that is stated stands where a default might."""
    stated = [*(one for one in [info.default] if isinstance(one, str)), *(info.param_decls or ())]
    if stated:
        return [one for text in stated for one in text.split("/")]
    option = name.replace("_", "-")
    return [f"--{option}", f"--no-{option}"] if is_switch else [f"--{option}"]


def _given(callback: Callable[..., Any]) -> list[_Given]:
    hints = get_type_hints(callback, include_extras=True)
    found = []
    for name, parameter in inspect.signature(callback).parameters.items():
        annotation, *extras = get_args(hints[name])
        info = next(one for one in extras if isinstance(one, ArgumentInfo | OptionInfo))
        is_argument = isinstance(info, ArgumentInfo)
        default = parameter.default
        is_required = default is inspect.Parameter.empty
        shown = getattr(default, "value", default)
        option = ", ".join(
            f"`{one}`" for one in _spellings(name, info, is_switch=annotation is bool)
        )
        found.append(
            _Given(
                names=(info.metavar or name.upper()).strip("[]") if is_argument else option,
                kind=_kind(annotation),
                default=_default(shown, is_required=is_required),
                words=_cell(info.help or ""),
                is_argument=is_argument,
                is_required=is_required,
            )
        )
    return found


def _command(name: str, callback: Callable[..., Any]) -> list[str]:
    given = _given(callback)
    arguments = [one for one in given if one.is_argument]
    paragraphs = [_cell(part) for part in (inspect.getdoc(callback) or "").split("\n\n")]
    usage = [one.names if one.is_required else f"[{one.names}]" for one in arguments]
    lines = [f"## reduction {name}", "", "\n\n".join(paragraphs), ""]
    lines += ["```text", " ".join(["reduction", name, *usage, "[OPTIONS]"]), "```", ""]
    if any(one.words or "`" in one.kind for one in arguments):
        lines += ["| argument | kind | what |", "|---|---|---|"]
        lines += [f"| `{one.names}` | {one.kind} | {one.words} |" for one in arguments]
        lines.append("")
    lines += ["| option | kind | default | what |", "|---|---|---|---|"]
    lines += [
        f"| {one.names} | {one.kind} | {one.default} | {one.words} |"
        for one in given
        if not one.is_argument
    ]
    return [*lines, ""]


def pages() -> dict[str, str]:
    """Name below ``reference/`` to text."""
    lines = [
        "# Commands", "",
        "Made from the commands themselves: what `reduction COMMAND --help` says. Exit status: "
        "0 done, 1 internal error or lost workers, 2 settings, 3 log, 4 data, 5 fit, 6 archive, "
        "130 interrupted.", "",
    ]  # fmt: skip
    for one in app.registered_commands:
        if one.callback is not None:
            lines += _command(one.name or one.callback.__name__.replace("_", "-"), one.callback)
    return {"commands.md": "\n".join(lines)}

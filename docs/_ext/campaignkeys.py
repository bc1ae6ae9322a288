"""The page of the keys of campaign.toml, made from its JSON Schema."""

from __future__ import annotations

from typing import Any

from reduction.campaign.model import CampaignFile

__all__ = ["pages"]

_NAME = "NAME"


def _parts(schema: dict[str, Any]) -> list[tuple[str, dict[str, Any]]]:
    """What a value may be: how it hangs below its key (``.NAME``, ``[]``), and its own schema."""
    for word in ("anyOf", "oneOf"):
        if word in schema:
            return [part for one in schema[word] for part in _parts(one)]
    inner = [*schema.get("patternProperties", {}).values()]
    if isinstance(schema.get("additionalProperties"), dict):
        inner.append(schema["additionalProperties"])
    if inner:
        return [(f".{_NAME}{below}", part) for one in inner for below, part in _parts(one)]
    if schema.get("type") == "array":
        return [(f"[]{below}", part) for below, part in _parts(schema.get("items", {}))]
    return [("", schema)]


def _sections(schema: dict[str, Any]) -> dict[str, list[str]]:
    """Places of each definition, by its name, in the order in which a file has them."""
    found: dict[str, list[str]] = {}

    def walk(place: str, one: dict[str, Any]) -> None:
        for key, value in one.get("properties", {}).items():
            for below, part in _parts(value):
                if "$ref" not in part:
                    continue
                name = part["$ref"].rpartition("/")[2]
                where = f"{place}.{key}{below}".lstrip(".")
                is_new = name not in found
                found.setdefault(name, []).append(where)
                if is_new:
                    walk(where, schema["$defs"][name])

    walk("", schema)
    return found


def _kind(schema: dict[str, Any]) -> str:
    words = []
    for below, part in _parts(schema):
        if part.get("type") == "null":
            continue
        if "$ref" in part:
            name = part["$ref"].rpartition("/")[2]
            word = f"[table](#key-{name.lower()})"
        elif "enum" in part or "const" in part:
            word = " \\| ".join(
                f"`{one}`" if str(one).strip() else "empty" if one == "" else "a blank"
                for one in part.get("enum", [part.get("const")])
            )
        else:
            kind = str(part.get("type", "any"))
            word = {
                "string": "text", "integer": "whole number", "boolean": "true or false",
                "object": "table",
            }.get(kind, kind)  # fmt: skip
        around = below.replace(f".{_NAME}", "by name: ").replace("[]", "list of ")
        words.append(around + word)
    return " or ".join(dict.fromkeys(words))


def _default(schema: dict[str, Any], *, is_required: bool) -> str:
    if is_required:
        return "required"
    value = schema.get("default")
    if isinstance(value, dict) or value in (None, [], ""):
        return ""
    return f"`{str(value).lower() if isinstance(value, bool) else value}`"


def _table(schema: dict[str, Any]) -> list[str]:
    lines = ["| key | kind of value | default |", "|---|---|---|"]
    wanted = schema.get("required", [])
    return lines + [
        f"| `{key}` | {_kind(one)} | {_default(one, is_required=key in wanted)} |"
        for key, one in schema.get("properties", {}).items()
    ]


def pages() -> dict[str, str]:
    """Name below ``reference/`` to text."""
    schema = CampaignFile.model_json_schema()
    lines = [
        "# Keys of campaign.toml", "",
        "Made from the JSON Schema that `reduction schema` prints, so that no key is missing. What "
        "the keys mean stands in [campaign.toml](../campaign.md) and [layouts](../layouts.md). "
        f"`{_NAME}` is a name of your own, `[]` one of a list.", "",
        "## The file", "", *_table(schema), "",
    ]  # fmt: skip
    for name, places in _sections(schema).items():
        heads = ", ".join(f"`{one}`" for one in dict.fromkeys(places))
        lines += [
            f"(key-{name.lower()})=",
            "",
            f"## {heads}",
            "",
            *_table(schema["$defs"][name]),
            "",
        ]
    return {"campaign-keys.md": "\n".join(lines)}

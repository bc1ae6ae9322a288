"""The page of the keys of campaign.toml, made from its JSON Schema."""

from __future__ import annotations

from typing import Any

from reduction.campaign.model import CampaignFile

__all__ = ["pages"]


def _type(schema: dict[str, Any]) -> str:
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        return f"[{name}](#{name.lower()})"
    if "enum" in schema or "const" in schema:
        return " \\| ".join(f"`{one}`" for one in schema.get("enum", [schema.get("const")]))
    for word in ("anyOf", "oneOf"):
        if word in schema:
            kinds = [_type(one) for one in schema[word] if one.get("type") != "null"]
            return " or ".join(dict.fromkeys(kinds))
    kind = schema.get("type")
    if kind == "array":
        return f"list of {_type(schema.get('items', {}))}"
    if kind == "object":
        inner = schema.get("additionalProperties")
        return f"table of {_type(inner)}" if isinstance(inner, dict) else "table"
    return {"string": "text", "integer": "whole number", "boolean": "true or false"}.get(
        str(kind), str(kind or "any")
    )


def _default(schema: dict[str, Any], *, is_required: bool) -> str:
    if is_required:
        return "required"
    value = schema.get("default")
    return (
        ""
        if isinstance(value, dict) or value in (None, [], "")
        else f"`{str(value).lower() if isinstance(value, bool) else value}`"
    )


def _section(name: str, schema: dict[str, Any]) -> list[str]:
    lines = [f"## {name}", ""]
    if text := schema.get("description"):
        lines += [" ".join(text.partition("\n\n")[0].split()), ""]
    if schema.get("properties"):
        lines += ["| key | kind of value | default |", "|---|---|---|"]
        wanted = schema.get("required", [])
        lines += [
            f"| `{key}` | {_type(one)} | {_default(one, is_required=key in wanted)} |"
            for key, one in schema["properties"].items()
        ]
    elif "enum" in schema:
        lines.append(_type(schema))
    return [*lines, ""]


def pages() -> dict[str, str]:
    """Name below ``reference/`` to text."""
    schema = CampaignFile.model_json_schema()
    lines = [
        "# Keys of campaign.toml", "",
        "Made from the JSON Schema that `reduction schema` prints, so that no key is missing. What "
        "the keys mean stands in [campaign.toml](../campaign.md) and [layouts](../layouts.md).", "",
        *_section("The file", schema),
    ]  # fmt: skip
    for name, one in schema["$defs"].items():
        lines += _section(name, one)
    return {"campaign-keys.md": "\n".join(lines)}

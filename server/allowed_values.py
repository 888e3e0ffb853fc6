"""Texts of the allowed values of a setting, derived from the JSON schema of the settings."""

from functools import cache
from typing import Any

from server.config import Config

TYPE_TEXTS = {
    "integer": "a whole number",
    "number": "a number",
    "string": "a text",
    "boolean": "true or false",
}


def key_text(key: tuple[str | int, ...]) -> str:
    """Return a key as text: `tools.drill.tip_in_marker_mm[1]`."""
    text = ""
    for part in key:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else str(part)
    return text


def allowed_keys(key: tuple[str | int, ...]) -> list[str]:
    """Return the keys of a section; empty if its keys are free names."""
    return list(_node(key).get("properties", {}))


def allowed_text(key: tuple[str | int, ...]) -> str:
    """Return the allowed values of a key: "a whole number from 0 to 65535"."""
    return _text(_node(key))


@cache
def _schema() -> dict[str, Any]:
    return Config.model_json_schema()


def _node(key: tuple[str | int, ...]) -> dict[str, Any]:
    """Return the schema of a key."""
    node = _schema()
    for part in key:
        if isinstance(part, int):
            node = _resolved(node.get("items", {}))
        elif part in node.get("properties", {}):
            node = _section(_resolved(node["properties"][part]))
        else:
            patterns = list(node.get("patternProperties", {}).values())
            node = _resolved(patterns[0] if patterns else node.get("additionalProperties") or {})
    return node


def _section(node: dict[str, Any]) -> dict[str, Any]:
    """Return the section of a key that may be null; any other node unchanged."""
    return next((_resolved(one) for one in node.get("anyOf", ()) if "$ref" in one), node)


def _resolved(node: dict[str, Any]) -> dict[str, Any]:
    reference = node.get("$ref")
    if reference is None:
        return node
    return dict(_schema()["$defs"][reference.rsplit("/", 1)[-1]])


def _text(node: dict[str, Any]) -> str:
    node = _resolved(node)
    if "anyOf" in node:
        return " or ".join(_text(member) for member in node["anyOf"])
    if "enum" in node:
        return " or ".join(str(value) for value in node["enum"])
    kind = node.get("type")
    if kind == "null":
        return "null"
    if kind == "array":
        return f"a list of {node.get('minItems', 'any number of')} values, each {_text(node['items'])}"
    if kind == "object":
        keys = list(node.get("properties", {}))
        return f"a section with the keys {', '.join(keys)}" if keys else "a section with names as keys"
    if node.get("format") == "path":
        return "the path of a file"
    return f"{TYPE_TEXTS.get(str(kind), 'a value')}{_range(node)}"


def _range(node: dict[str, Any]) -> str:
    low, above, high = node.get("minimum"), node.get("exclusiveMinimum"), node.get("maximum")
    start = f" above {above:.10g}" if above is not None else f" from {low:.10g}" if low is not None else ""
    end = "" if high is None else f" to {high:.10g}" if low is not None else f" and at most {high:.10g}"
    return start + end

"""Exact conversion of records of the program to JSON and back, for the states in a recording.

Floats are written with all digits, arrays with their bytes. Pickle is not used, because a file may come from
an untrusted source: only dataclasses, enums and named tuples of `tracker` and of a few modules of `server`
are created, without running their code. Unknown fields, and missing fields without a default, are errors.
"""

import base64
import dataclasses
import math
from collections import deque
from enum import Enum
from importlib import import_module
from types import MappingProxyType
from typing import Any, Literal, TypeAlias

import numpy as np

Json: TypeAlias = Any
Value: TypeAlias = Any

PACKAGE = "tracker."
MODULES = frozenset(
    {
        "server.alarms.evaluation",
        "server.capture.local_camera",
        "server.live",
        "server.loop.tracking_state",
        "server.setup",
    }
)
ARRAY_KINDS = "biuf"


class CodecError(ValueError):
    """A value cannot be encoded, or was encoded by another version."""


def encoded_value(value: Value) -> Json:
    """Encode a value as JSON.

    Raises:
        CodecError: The value contains an unknown type.
    """
    if value is None or type(value) in (bool, int, str):
        return value
    if type(value) is float:
        return value if math.isfinite(value) else {"float": str(value)}
    if isinstance(value, Enum):
        return {"enum": _name_of(type(value)), "value": encoded_value(value.value)}
    if isinstance(value, np.ndarray):
        return _encoded_array(value)
    if isinstance(value, np.generic):
        return {"scalar": _encoded_array(np.asarray(value))}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = {one.name: encoded_value(getattr(value, one.name)) for one in dataclasses.fields(value)}
        return {"class": _name_of(type(value)), "fields": fields}
    return _encoded_container(value)


def _encoded_container(value: Value) -> Json:
    kind = type(value)
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return {"named": _name_of(kind), "items": [encoded_value(one) for one in value]}
    if isinstance(value, (dict, MappingProxyType)):
        pairs = [[encoded_value(key), encoded_value(one)] for key, one in value.items()]
        return {"mapping" if isinstance(value, MappingProxyType) else "dict": pairs}
    if kind is list:
        return [encoded_value(one) for one in value]
    for name, container in (("tuple", tuple), ("set", set), ("frozenset", frozenset)):
        if kind is container:
            return {name: [encoded_value(one) for one in value]}
    if kind is deque:
        return {"deque": [encoded_value(one) for one in value], "maxlen": value.maxlen}
    if kind is slice:
        return {"slice": [encoded_value(one) for one in (value.start, value.stop, value.step)]}
    if kind is bytes:
        return {"bytes": base64.b64encode(value).decode("ascii")}
    raise CodecError(f"a {kind.__module__}.{kind.__qualname__} cannot be recorded")


def decoded_value(content: Json) -> Value:
    """Decode the result of `encoded_value`.

    Raises:
        CodecError: Another version encoded it, or it is damaged.
    """
    if isinstance(content, list):
        return [decoded_value(one) for one in content]
    if not isinstance(content, dict):
        return content
    if not content:
        raise CodecError("an object has no kind of value")
    try:
        return _decoded(content)
    except (LookupError, TypeError, ValueError, AttributeError, ArithmeticError, RecursionError) as error:
        if isinstance(error, CodecError):
            raise
        raise CodecError(f"a value is damaged: {error}") from error


def _decoded(content: dict[str, Json]) -> Value:
    tag = next(iter(content))
    value = content[tag]
    match tag:
        case "float":
            return float(value)
        case "enum":
            return _class_of(value, Enum)(decoded_value(content["value"]))
        case "array":
            return _decoded_array(content)
        case "scalar":
            return _decoded_array(value)[()]
        case "class":
            return _decoded_fields(_class_of(value, object), content["fields"])
        case "named":
            return _class_of(value, tuple)(*(decoded_value(one) for one in content["items"]))
        case "dict" | "mapping":
            pairs = {decoded_value(key): decoded_value(one) for key, one in value}
            return pairs if tag == "dict" else MappingProxyType(pairs)
        case "tuple" | "set" | "frozenset":
            items = [decoded_value(one) for one in value]
            return {"tuple": tuple, "set": set, "frozenset": frozenset}[tag](items)
        case "deque":
            return deque((decoded_value(one) for one in value), maxlen=content["maxlen"])
        case "slice":
            return slice(*(decoded_value(one) for one in value))
        case "bytes":
            return base64.b64decode(value, validate=True)
        case _:
            raise CodecError(f"{tag!r} is not a kind of value")


def _encoded_array(array: np.ndarray) -> Json:
    if array.dtype.kind not in ARRAY_KINDS:
        raise CodecError(f"an array of {array.dtype} cannot be recorded")
    # The last digit of a matrix product depends on the memory order of the matrices.
    order: Literal["F", "C"] = "F" if array.flags.f_contiguous and not array.flags.c_contiguous else "C"
    return {
        "array": base64.b64encode(array.tobytes(order=order)).decode("ascii"),
        "dtype": array.dtype.str,
        "shape": list(array.shape),
        "order": order,
        "writeable": bool(array.flags.writeable),
    }


def _decoded_array(content: dict[str, Json]) -> np.ndarray:
    kind = np.dtype(content["dtype"])
    if kind.kind not in ARRAY_KINDS:
        raise CodecError(f"an array of {kind} cannot be read")
    flat = np.frombuffer(bytearray(base64.b64decode(content["array"], validate=True)), dtype=kind)
    array = flat.reshape(content["shape"], order=content["order"])
    array.flags.writeable = bool(content["writeable"])
    return array


def _decoded_fields(kind: type, recorded: dict[str, Json]) -> Value:
    if not dataclasses.is_dataclass(kind):
        raise CodecError(f"{kind.__qualname__} is not a dataclass")
    fields = {one.name: one for one in dataclasses.fields(kind)}
    unknown = sorted(recorded.keys() - fields.keys())
    if unknown:
        raise CodecError(f"{kind.__qualname__} has no {', '.join(unknown)} in this version")
    made = object.__new__(kind)
    for name, one in fields.items():
        if name in recorded:
            value = decoded_value(recorded[name])
        elif one.default is not dataclasses.MISSING:
            value = one.default
        elif one.default_factory is not dataclasses.MISSING:
            value = one.default_factory()
        else:
            raise CodecError(f"{kind.__qualname__} needs {name}, which was not recorded")
        object.__setattr__(made, name, value)
    return made


def _name_of(kind: type) -> str:
    if not _is_known(kind.__module__):
        raise CodecError(f"a {kind.__module__}.{kind.__qualname__} cannot be recorded")
    return f"{kind.__module__}:{kind.__qualname__}"


def _class_of(name: str, base: type) -> Value:
    module, _, qualified = name.partition(":")
    if not _is_known(module):
        raise CodecError(f"{name} cannot be read from a recording")
    try:
        kind: Value = import_module(module)
        for part in qualified.split("."):
            kind = getattr(kind, part)
    except (ImportError, AttributeError) as error:
        raise CodecError(f"this version has no {name}") from error
    if not (isinstance(kind, type) and issubclass(kind, base) and kind.__module__ == module):
        raise CodecError(f"{name} cannot be read from a recording")
    return kind


def _is_known(module: str) -> bool:
    return module.startswith(PACKAGE) or module in MODULES

"""Conversion of a plan to and from JSON-compatible mappings."""

import dataclasses
import math
import typing
from collections.abc import Mapping
from enum import Enum
from typing import Any

import numpy as np

from tracker.errors import NavigationError, PlanError, Remark
from tracker.plan.channel import Channel
from tracker.plan.document.records import FORMAT_VERSION, READABLE_VERSIONS, PlanDocument
from tracker.plan.pedicle import PedicleMeasure

MAX_INTEGER = 1e300
# Code of a warning of an older plan, which has its sentence alone.
SENTENCE = "PEDICLE_WARNING"


def plan_to_mapping(plan: PlanDocument) -> dict[str, Any]:
    """Return the plan as a JSON-compatible mapping; the inverse of `plan_from_mapping`."""
    mapped = plain(plan)
    assert isinstance(mapped, dict)  # noqa: S101  for the type checker: a record becomes a mapping
    return mapped


def plain(value: object) -> Any:  # noqa: ANN401  JSON values have no narrower type
    """Convert records to mappings, arrays and tuples to lists, enums to strings."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {field.name: plain(getattr(value, field.name)) for field in dataclasses.fields(value)}
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, Mapping):
        return {str(key): plain(one) for key, one in value.items()}
    if isinstance(value, (tuple, list)):
        return [plain(one) for one in value]
    return value


def plan_from_mapping(mapped: object) -> PlanDocument:
    """Return the plan of a mapping; every record validates itself.

    Raises:
        PlanError: PLAN_INVALID, a key is missing, unknown or of a wrong type; PLAN_VERSION_UNKNOWN; or
            an error of a record.
    """
    if isinstance(mapped, Mapping):
        mapped = _in_newest_version(mapped)
    plan = _read(PlanDocument, mapped, "plan")
    assert isinstance(plan, PlanDocument)  # noqa: S101  for the type checker
    return plan


def _in_newest_version(mapped: Mapping[str, object]) -> Mapping[str, object]:
    """Migrate a mapping of an older format version."""
    version = mapped.get("format_version")
    if type(version) is not int or version not in READABLE_VERSIONS:
        found, known = repr(version)[:20], ", ".join(map(str, READABLE_VERSIONS))
        raise PlanError(
            "PLAN_VERSION_UNKNOWN",
            f"the plan has format version {found}, this program reads {known}",
            "Open it with the program that wrote it, or plan again.",
            {"found": found, "known": known},
        )
    return {**mapped, "format_version": FORMAT_VERSION}


def measure_from_mapping(mapped: object) -> PedicleMeasure:
    """Return the pedicle measurement from the output of `plain`.

    Raises:
        PlanError: PLAN_INVALID.
    """
    measure = _read(PedicleMeasure, mapped, "pedicle")
    assert isinstance(measure, PedicleMeasure)  # noqa: S101  for the type checker
    return measure


def channel_from_mapping(mapped: object) -> Channel:
    """Return the channel from the output of `plain`.

    Raises:
        PlanError: PLAN_INVALID, CHANNEL_INVALID.
    """
    channel = _read(Channel, mapped, "channel")
    assert isinstance(channel, Channel)  # noqa: S101  for the type checker
    return channel


def _read(kind: Any, value: object, where: str) -> Any:  # noqa: ANN401  the annotation decides the type
    origin, given = typing.get_origin(kind), typing.get_args(kind)
    if kind is Remark and isinstance(value, str):
        return Remark(code=SENTENCE, message=value)
    if dataclasses.is_dataclass(kind) and isinstance(kind, type):
        return _record(kind, value, where)
    if kind is object:
        return value
    if origin is np.ndarray:
        return _array(value, where)
    if origin is tuple:
        return tuple(_read(given[0], one, f"{where}[{n}]") for n, one in enumerate(_list(value, where)))
    if origin is typing.Literal:
        if value not in given:
            raise _invalid(where, f"is {repr(value)[:60]}, allowed are {', '.join(map(str, given))}")
        return value
    if origin is not None and isinstance(origin, type) and issubclass(origin, Mapping):
        if not isinstance(value, Mapping):
            raise _invalid(where, "is no mapping")
        return {str(key): _read(given[1], one, f"{where}.{str(key)[:40]}") for key, one in value.items()}
    return _single(kind, value, where)


def _single(kind: Any, value: object, where: str) -> object:  # noqa: ANN401  as above
    if isinstance(kind, type) and issubclass(kind, Enum):
        try:
            return kind(value)
        except ValueError as error:
            raise _invalid(
                where, f"is {repr(value)[:60]}, allowed are {', '.join(str(one.value) for one in kind)}"
            ) from error
    if kind is float and isinstance(value, int | float) and not isinstance(value, bool):
        # An integer of JSON may exceed the range of a float.
        number = float(value) if abs(value) < MAX_INTEGER else math.inf
        if not math.isfinite(number):
            raise _invalid(where, "is not a finite number")
        return number
    if isinstance(kind, type) and type(value) is kind:
        return value
    raise _invalid(where, f"is {repr(value)[:60]}, needed {getattr(kind, '__name__', kind)}")


def _record(kind: type, value: object, where: str) -> object:
    if not isinstance(value, Mapping):
        raise _invalid(where, "is no mapping")
    hints = typing.get_type_hints(kind)
    fields = {field.name: field for field in dataclasses.fields(kind)}
    unknown = sorted(str(key) for key in value if key not in fields)
    if unknown:
        raise _invalid(where, f"has unknown keys {', '.join(unknown)[:200]}")
    missing = [name for name, field in fields.items() if name not in value and _is_needed(field)]
    if missing:
        raise _invalid(where, f"lacks {', '.join(missing)}")
    read = {name: _read(hints[name], value[name], f"{where}.{name}") for name in fields if name in value}
    try:
        return kind(**read)
    except NavigationError:
        raise
    except (TypeError, ValueError) as error:
        raise _invalid(where, f"cannot be read: {error}") from error


def _is_needed(field: "dataclasses.Field[Any]") -> bool:
    return field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING


def _array(value: object, where: str) -> object:
    try:
        array = np.array(_list(value, where), dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise _invalid(where, "is not a rectangular list of numbers") from error
    if not np.isfinite(array).all():
        raise _invalid(where, "contains a number that is not finite")
    return array


def _list(value: object, where: str) -> list[Any]:
    if not isinstance(value, (list, tuple)):
        raise _invalid(where, "is no list")
    return list(value)


def _invalid(where: str, what: str) -> PlanError:
    return PlanError(
        "PLAN_INVALID",
        f"the plan cannot be read: {where} {what}",
        "Export the plan again.",
        {"where": where, "plan_fault": what},
    )

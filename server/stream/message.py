"""Base class of all messages."""

import math

from pydantic import BaseModel, ConfigDict

from server.field_descriptions import FieldDescriptions


class Message(FieldDescriptions, BaseModel):
    """Base class of all messages: frozen, unknown fields are forbidden."""

    model_config = ConfigDict(frozen=True, extra="forbid")


def finite(value: float) -> float | None:
    """Return the number, or None where it is infinite or NaN, which JSON lacks."""
    return value if math.isfinite(value) else None

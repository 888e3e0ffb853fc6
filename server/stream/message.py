"""Base class of all messages."""

import math

from pydantic import BaseModel, ConfigDict


class Message(BaseModel):
    """Base class of all messages: frozen, unknown fields are forbidden."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)


def finite(value: float) -> float | None:
    """Return the number, or None where it is infinite or NaN, which JSON lacks."""
    return value if math.isfinite(value) else None

"""What is common to all messages."""

import math

from pydantic import BaseModel, ConfigDict


class Message(BaseModel):
    """Common to all messages: nothing unknown, nothing changed after it was made."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)


def finite(value: float) -> float | None:
    """The number, or null where it is infinite or NaN: JSON has neither."""
    return value if math.isfinite(value) else None

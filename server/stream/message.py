"""What is common to all messages."""

from pydantic import BaseModel, ConfigDict


class Message(BaseModel):
    """Common to all messages: nothing unknown, nothing changed after it was made."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

"""Base class of all messages."""

from pydantic import BaseModel, ConfigDict

from server.field_descriptions import FieldDescriptions


class Message(FieldDescriptions, BaseModel):
    """Base class of all messages: frozen, unknown fields are forbidden."""

    model_config = ConfigDict(frozen=True, extra="forbid")

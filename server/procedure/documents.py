"""Parsing of case documents into typed records."""

from typing import TypeVar

from pydantic import BaseModel, ValidationError

from server.store import Document
from tracker.errors import InvalidInput

Record = TypeVar("Record", bound=BaseModel)


def parse_document(model: type[Record], document: Document, *, code: str, remedy: str) -> Record:
    """Parse and validate the content of a document.

    Raises:
        InvalidInput: with the given code and remedy, if the content does not match the model.
    """
    try:
        # Not strict: the content comes from JSON, where times are strings.
        return model.model_validate(dict(document.content), strict=False)
    except ValidationError as error:
        raise InvalidInput(
            code,
            f"{document.title} cannot be read: {error.error_count()} values are invalid",
            remedy,
            {"document_id": document.id},
        ) from None

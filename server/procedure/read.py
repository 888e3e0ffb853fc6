"""A document of a case, read as what it must be."""

from typing import TypeVar

from pydantic import BaseModel, ValidationError

from server.store import Document
from tracker.errors import InvalidInput

Kept = TypeVar("Kept", bound=BaseModel)


def read_document(model: type[Kept], document: Document, *, code: str, remedy: str) -> Kept:
    """What a document says.

    Raises:
        InvalidInput: of this code, with this remedy.
    """
    try:
        # As JSON, where times are text.
        return model.model_validate(dict(document.content), strict=False)
    except ValidationError as error:
        raise InvalidInput(
            code,
            f"{document.title} cannot be read: {error.error_count()} of its values are wrong",
            remedy,
            {"document_id": document.id},
        ) from None

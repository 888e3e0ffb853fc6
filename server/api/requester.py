"""Identity of the person behind a request, from the session where sign-in is required.

Request models take the name through the types of this module. `set_requester` is a dependency of the whole
application, so that no route can trust a name in the request while sign-in is on.
"""

from collections.abc import Mapping
from contextvars import ContextVar
from typing import Annotated, TypeAlias

from fastapi import Depends, Query
from fastapi.exceptions import RequestValidationError
from pydantic import Field, StringConstraints, ValidatorFunctionWrapHandler, WrapValidator
from pydantic_core import PydanticKnownError
from starlette.requests import HTTPConnection

from server.security import LOCAL_USER, Person, person_of
from server.store.validation import validate_name

BY_SESSION = "Name of the person. With sign-in the name of the session is used and this one is ignored."

_asking: ContextVar[Person] = ContextVar("asking", default=LOCAL_USER)


async def set_requester(asking: HTTPConnection) -> None:
    """Store the person of this request for the validators. Async: a thread has its own context."""
    _asking.set(person_of(asking.scope))


def _maker(value: object, read: ValidatorFunctionWrapHandler) -> str:
    """Return the author; rejects an invalid name before a long upload or job starts."""
    person = _asking.get()
    if person != LOCAL_USER:
        return person.name
    if value == "":
        raise PydanticKnownError("missing")
    return validate_name(str(read(value)), of="name of who makes it")


def _doer(value: object, read: ValidatorFunctionWrapHandler) -> str | None:
    person = _asking.get()
    return read(value) if person == LOCAL_USER else person.name


MadeBy: TypeAlias = Annotated[
    str,
    Field(default_factory=str, validate_default=True, max_length=200, description=BY_SESSION),
    WrapValidator(_maker),
]
"""Author of a change, in a request body."""

_Name = Annotated[
    str, StringConstraints(strip_whitespace=True, min_length=1, max_length=200, pattern=r"^[^\x00-\x1f]+$")
]
DoneBy: TypeAlias = Annotated[
    _Name | None,
    Field(default_factory=lambda: None, validate_default=True, description=BY_SESSION),
    WrapValidator(_doer),
]
"""Person who acts on an alarm, in a request body; optional."""


async def maker_in_query(
    asking: HTTPConnection,
    made_by: Annotated[str, Query(max_length=200, description=BY_SESSION)] = "",
) -> str:
    """Return the author of a change from the query, for requests without a JSON body."""
    person = person_of(asking.scope)
    if person != LOCAL_USER:
        return person.name
    if not made_by:
        missing: Mapping[str, object] = {
            "type": "missing",
            "loc": ("query", "made_by"),
            "msg": "Field required",
        }
        raise RequestValidationError([missing])
    return validate_name(made_by, of="name of who makes it")


MadeByQuery: TypeAlias = Annotated[str, Depends(maker_in_query)]
"""Author of a change, in the query."""

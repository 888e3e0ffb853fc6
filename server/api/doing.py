"""Who does what is asked: the session says it wherever people sign in, whatever the request says.

Every request that has a name of who does it takes it through one of the types here, and `know_who_asks` is
a dependency of the whole application: so a new address that asks for such a name cannot believe it.
"""

from collections.abc import Mapping
from contextvars import ContextVar
from typing import Annotated, TypeAlias

from fastapi import Depends, Query
from fastapi.exceptions import RequestValidationError
from pydantic import Field, StringConstraints, ValidatorFunctionWrapHandler, WrapValidator
from pydantic_core import PydanticKnownError
from starlette.requests import HTTPConnection

from server.security import ANYBODY, Person, person_of
from server.store.checks import checked_name

BY_SESSION = "Where people sign in, their session says it, and this is not looked at; elsewhere it is needed."

_asking: ContextVar[Person] = ContextVar("asking", default=ANYBODY)


async def know_who_asks(asking: HTTPConnection) -> None:
    """Let the types below know whose request it is that they read. In a thread it would be lost."""
    _asking.set(person_of(asking.scope))


def _maker(said: object, read: ValidatorFunctionWrapHandler) -> str:
    """Refused here, before a long upload or job, and not when its result is to be kept."""
    person = _asking.get()
    if person != ANYBODY:
        return person.name
    if said == "":
        raise PydanticKnownError("missing")
    return checked_name(str(read(said)), of="name of who makes it")


def _doer(said: object, read: ValidatorFunctionWrapHandler) -> str | None:
    person = _asking.get()
    return read(said) if person == ANYBODY else person.name


MadeBy: TypeAlias = Annotated[
    str,
    Field(default_factory=str, validate_default=True, max_length=200, description=BY_SESSION),
    WrapValidator(_maker),
]
"""In a body: who makes or changes something."""

_Name = Annotated[
    str, StringConstraints(strip_whitespace=True, min_length=1, max_length=200, pattern=r"^[^\x00-\x1f]+$")
]
DoneBy: TypeAlias = Annotated[
    _Name | None,
    Field(default_factory=lambda: None, validate_default=True, description=BY_SESSION),
    WrapValidator(_doer),
]
"""In a body: who answers an alarm; not needed."""


async def maker_in_query(
    asking: HTTPConnection,
    made_by: Annotated[str, Query(max_length=200, description=BY_SESSION)] = "",
) -> str:
    """Who makes or changes something, where the body is a file or there is none."""
    person = person_of(asking.scope)
    if person != ANYBODY:
        return person.name
    if not made_by:
        missing: Mapping[str, object] = {
            "type": "missing",
            "loc": ("query", "made_by"),
            "msg": "Field required",
        }
        raise RequestValidationError([missing])
    return checked_name(made_by, of="name of who makes it")


MadeByQuery: TypeAlias = Annotated[str, Depends(maker_in_query)]
"""In the query: who makes or changes something."""

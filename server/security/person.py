"""Who it is that asks: a name and a role, put into each request by the session's guard."""

from collections.abc import MutableMapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

STATE_KEY = "coaxial_person"


class Role(StrEnum):
    """What somebody is here for; `server/security` has the table of what each may do."""

    OPERATOR = "operator"  # sets up, registers, confirms
    SUPERVISOR = "supervisor"  # sees all, points, co-signs, asks to hold; moves nothing
    VIEWER = "viewer"  # sees
    SCREEN = "screen"  # the screen in theatre: sees, sounds, acknowledges
    CAMERA = "camera"  # a phone or tablet that sends its camera's images; sees nothing


@dataclass(frozen=True, slots=True, kw_only=True)
class Person:
    """Somebody who is signed in.

    Attributes:
        id: of the session's owner, the same over all their sessions.
        name: as they are called in the log.
        role: what they may do.
        invited_by: who invited them, by name; empty where that is not known, and where nobody did.
    """

    id: str
    name: str
    role: Role
    invited_by: str = ""


# Where nobody has to sign in (a server on this computer alone, by its settings).
ANYBODY = Person(id="anybody", name="this computer", role=Role.OPERATOR)
# Who has not signed in where people have to, at what is open to all.
NOBODY = Person(id="nobody", name="nobody", role=Role.VIEWER)
# Who writes down what nobody asked for.
SERVER = Person(id="server", name="Coaxial", role=Role.OPERATOR)


def person_of(scope: MutableMapping[str, Any]) -> Person:
    """Who asks, of an ASGI scope; `ANYBODY` where nobody has to sign in."""
    person = scope.get("state", {}).get(STATE_KEY)
    return person if isinstance(person, Person) else ANYBODY


def acting(scope: MutableMapping[str, Any], said: str | None) -> str:
    """The name under which something is done: of who is signed in, else what was said."""
    person = person_of(scope)
    return (said or ANYBODY.name) if person == ANYBODY else person.name

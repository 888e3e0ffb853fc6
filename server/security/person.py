"""Person and role of a request, set in its ASGI scope by `SessionGuard`."""

from collections.abc import MutableMapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

STATE_KEY = "coaxial_person"


class Role(StrEnum):
    """Role of a person; `access_rules.py` has the permissions."""

    OPERATOR = "operator"  # full access: sets up, registers, confirms
    SUPERVISOR = "supervisor"  # reads all data, points, co-signs, requests a hold; changes nothing else
    VIEWER = "viewer"  # reads the live data
    SCREEN = "screen"  # the screen in theatre: reads the live data, sounds and acknowledges alarms
    CAMERA = "camera"  # a phone or tablet that sends the images of its camera; reads nothing


@dataclass(frozen=True, slots=True, kw_only=True)
class Person:
    """A signed-in person.

    Attributes:
        id: the same over all their sessions.
        name: display name, as in the log.
        role: what they may do.
        invited_by: name of who invited them; empty where unknown or not invited.
    """

    id: str
    name: str
    role: Role
    invited_by: str = ""


# Person of all requests if sign-in is off (a server for this computer only).
LOCAL_USER = Person(id="anybody", name="this computer", role=Role.OPERATOR)
# Person of a public request without a session.
ANONYMOUS = Person(id="nobody", name="nobody", role=Role.VIEWER)
# Person of the server's own audit entries.
SERVER = Person(id="server", name="Coaxial", role=Role.OPERATOR)


def person_of(scope: MutableMapping[str, Any]) -> Person:
    """Return the person of an ASGI scope; `LOCAL_USER` where sign-in is off."""
    person = scope.get("state", {}).get(STATE_KEY)
    return person if isinstance(person, Person) else LOCAL_USER


def actor_name(scope: MutableMapping[str, Any], stated: str | None) -> str:
    """Return the name of who acts: of the signed-in person, else the name in the request."""
    person = person_of(scope)
    return (stated or LOCAL_USER.name) if person == LOCAL_USER else person.name

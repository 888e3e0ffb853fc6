"""People on the disk: one small file that is written anew, whole, with each change.

People and the audit log are kept outside of the cases' database: a database restored from a backup brings
back no ended session, and a copied case carries no token. A change and its audit line are therefore not one
transaction.
"""

import json
from collections.abc import Iterable, Mapping
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

from server.security.audit.whole import write_private
from server.security.people.records import Invitation, Session
from server.security.person import Person, Role
from server.store import StoreError
from server.store.home import sync_folder

FORM = 1


def read_people(file: Path) -> tuple[list[Invitation], list[Session]]:
    """What was kept; nothing where nothing was.

    Raises:
        StoreError: PEOPLE_DAMAGED.
        OSError: the file cannot be read.
    """
    if not file.exists():
        return [], []
    try:
        kept = json.loads(file.read_bytes())
        if kept["form"] != FORM:
            raise ValueError(f"its form is {kept['form']!r}")  # noqa: TRY301  told below with all others
        return [_invitation(one) for one in kept["invitations"]], [_session(one) for one in kept["sessions"]]
    except (ValueError, KeyError, TypeError) as error:
        raise StoreError(
            "PEOPLE_DAMAGED",
            f"the file of people {file} cannot be read: {error}",
            "Move the file away and start again: everybody then has to be invited anew.",
            {"file": str(file)},
        ) from error


def write_people(file: Path, invitations: Iterable[Invitation], sessions: Iterable[Session]) -> None:
    """Keep them.

    Raises:
        OSError: the file cannot be written.
    """
    told = {
        "form": FORM,
        "invitations": [_told_invitation(one) for one in invitations],
        "sessions": [_told_session(one) for one in sessions],
    }
    write_private(file, json.dumps(told, indent=1).encode())
    sync_folder(file.parent)


def _told_person(person: Person) -> dict[str, str]:
    return {
        "id": person.id,
        "name": person.name,
        "role": person.role.value,
        "invited_by": person.invited_by,
    }


def _person(told: Mapping[str, Any], *, invited_by: str = "") -> Person:
    invited_by = str(told.get("invited_by", invited_by))
    return Person(id=str(told["id"]), name=str(told["name"]), role=Role(told["role"]), invited_by=invited_by)


def _time(text: str | None) -> datetime | None:
    return None if text is None else datetime.fromisoformat(text)


def _told_invitation(one: Invitation) -> dict[str, object]:
    return {
        "id": one.id,
        "person": _told_person(one.person),
        "made_by": one.made_by,
        "made_at": one.made_at.isoformat(),
        "expires_at": one.expires_at.isoformat(),
        "single_use": one.single_use,
        "for_machine": one.for_machine,
        "session_s": one.session_lasts.total_seconds(),
        "token_sum": one.token_sum,
        "uses": one.uses,
        "revoked_at": None if one.revoked_at is None else one.revoked_at.isoformat(),
    }


def _invitation(told: Mapping[str, Any]) -> Invitation:
    return Invitation(
        id=str(told["id"]),
        person=_person(told["person"], invited_by=str(told["made_by"])),
        made_by=str(told["made_by"]),
        made_at=datetime.fromisoformat(told["made_at"]),
        expires_at=datetime.fromisoformat(told["expires_at"]),
        single_use=bool(told["single_use"]),
        for_machine=bool(told["for_machine"]),
        session_lasts=timedelta(seconds=float(told["session_s"])),
        token_sum=str(told["token_sum"]),
        uses=int(told["uses"]),
        revoked_at=_time(told["revoked_at"]),
    )


def _told_session(one: Session) -> dict[str, object]:
    return {
        "id": one.id,
        "person": _told_person(one.person),
        "invitation_id": one.invitation_id,
        "started_at": one.started_at.isoformat(),
        "expires_at": one.expires_at.isoformat(),
        "for_machine": one.for_machine,
        "token_sum": one.token_sum,
        "ended_at": None if one.ended_at is None else one.ended_at.isoformat(),
    }


def _session(told: Mapping[str, Any]) -> Session:
    return Session(
        id=str(told["id"]),
        person=_person(told["person"]),
        invitation_id=str(told["invitation_id"]),
        started_at=datetime.fromisoformat(told["started_at"]),
        expires_at=datetime.fromisoformat(told["expires_at"]),
        for_machine=bool(told["for_machine"]),
        token_sum=str(told["token_sum"]),
        ended_at=_time(told["ended_at"]),
    )

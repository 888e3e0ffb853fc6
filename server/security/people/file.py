"""File of invitations and sessions: one small file that is rewritten as a whole with each change.

People and the audit log are stored outside of the case database: a database restored from a backup revives no
ended session, and a copied case contains no token. A change and its audit entry are therefore not one
transaction.
"""

from collections.abc import Iterable, Mapping
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

from server.security.people.records import Invitation, Session
from server.security.person import Person, Role
from server.store import StoreError
from server.store.private_file import PrivateJsonFile

FORM = 1


def read_people(file: Path) -> tuple[list[Invitation], list[Session]]:
    """Return the stored invitations and sessions; empty without a file.

    Raises:
        StoreError: PEOPLE_DAMAGED.
        OSError: the file cannot be read.
    """
    try:
        stored = PrivateJsonFile(file, form=FORM).read()
        if stored is None:
            return [], []
        return [_invitation(one) for one in stored["invitations"]], [
            _session(one) for one in stored["sessions"]
        ]
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError) as error:
        raise StoreError(
            "PEOPLE_DAMAGED",
            f"the file of people {file} cannot be read: {error}",
            "Move the file to another folder and start again; everybody then has to be invited again.",
            {"file": str(file), "library_error": str(error)},
        ) from error


def write_people(file: Path, invitations: Iterable[Invitation], sessions: Iterable[Session]) -> None:
    """Store invitations and sessions.

    Raises:
        OSError: the file cannot be written.
    """
    reported = {
        "invitations": [_invitation_json(one) for one in invitations],
        "sessions": [_session_json(one) for one in sessions],
    }
    PrivateJsonFile(file, form=FORM).write(reported)


def _person_json(person: Person) -> dict[str, str]:
    return {
        "id": person.id,
        "name": person.name,
        "role": person.role.value,
        "invited_by": person.invited_by,
    }


def _person(reported: Mapping[str, Any], *, invited_by: str = "") -> Person:
    invited_by = str(reported.get("invited_by", invited_by))
    return Person(
        id=str(reported["id"]), name=str(reported["name"]), role=Role(reported["role"]), invited_by=invited_by
    )


def _time(text: str | None) -> datetime | None:
    return None if text is None else datetime.fromisoformat(text)


def _invitation_json(one: Invitation) -> dict[str, object]:
    return {
        "id": one.id,
        "person": _person_json(one.person),
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


def _invitation(reported: Mapping[str, Any]) -> Invitation:
    return Invitation(
        id=str(reported["id"]),
        person=_person(reported["person"], invited_by=str(reported["made_by"])),
        made_by=str(reported["made_by"]),
        made_at=datetime.fromisoformat(reported["made_at"]),
        expires_at=datetime.fromisoformat(reported["expires_at"]),
        single_use=bool(reported["single_use"]),
        for_machine=bool(reported["for_machine"]),
        session_lasts=timedelta(seconds=float(reported["session_s"])),
        token_sum=str(reported["token_sum"]),
        uses=int(reported["uses"]),
        revoked_at=_time(reported["revoked_at"]),
    )


def _session_json(one: Session) -> dict[str, object]:
    return {
        "id": one.id,
        "person": _person_json(one.person),
        "invitation_id": one.invitation_id,
        "started_at": one.started_at.isoformat(),
        "expires_at": one.expires_at.isoformat(),
        "for_machine": one.for_machine,
        "token_sum": one.token_sum,
        "ended_at": None if one.ended_at is None else one.ended_at.isoformat(),
    }


def _session(reported: Mapping[str, Any]) -> Session:
    return Session(
        id=str(reported["id"]),
        person=_person(reported["person"]),
        invitation_id=str(reported["invitation_id"]),
        started_at=datetime.fromisoformat(reported["started_at"]),
        expires_at=datetime.fromisoformat(reported["expires_at"]),
        for_machine=bool(reported["for_machine"]),
        token_sum=str(reported["token_sum"]),
        ended_at=_time(reported["ended_at"]),
    )

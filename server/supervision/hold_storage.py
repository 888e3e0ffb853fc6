"""Storage of hold requests: one small file that is rewritten as a whole with each change.

The file belongs to the home folder and not to a case: a hold concerns the theatre. It can be requested
without an open case, and stays when another case is opened or the server restarts. A request is announced
before it is written, so a full disk silences nobody. A case's archive has holds in its alarm log only.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import structlog

from server.store import translate_errors
from server.store.private_file import PrivateJsonFile

FORM = 1
HOLDS_FILE = "holds.json"
UNREADABLE_ID = "unreadable"
UNKNOWN_NAME = "somebody (unknown: the file of holds was damaged)"

_log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class HoldRequest:
    """One person's request to hold.

    Attributes:
        person_id: the person, the same over all sessions and restarts.
        name: the person's display name.
        at: time of the request, UTC, ISO 8601.
    """

    person_id: str
    name: str
    at: str


class HoldStorage(Protocol):
    """Storage of the open hold requests."""

    def read(self) -> tuple[HoldRequest, ...]:
        """Return the stored requests, oldest first."""

    def write(self, asking: Iterable[HoldRequest]) -> None:
        """Replace all stored requests; they are on the disk on return."""


class NoHoldStorage:
    """No storage: a restart of the server forgets the requests."""

    def read(self) -> tuple[HoldRequest, ...]:
        """Return no request."""
        return ()

    def write(self, asking: Iterable[HoldRequest]) -> None:
        """Do nothing."""


class HoldRequestFile:
    """Hold requests of one theatre in a file, with or without an open case.

    Args:
        folder: home folder.
    """

    def __init__(self, folder: Path) -> None:
        self._file = PrivateJsonFile(folder / HOLDS_FILE, form=FORM)

    def read(self) -> tuple[HoldRequest, ...]:
        """Return the last written requests. A damaged file yields one of an unknown person: the hold stays.

        Raises:
            StoreError: the file cannot be read at all.
        """
        try:
            with translate_errors(self._file.path.parent):
                stored = self._file.read()
            return () if stored is None else tuple(_requested(one) for one in stored["asking"])
        except (ValueError, KeyError, TypeError) as error:
            _log.error(
                "the file of hold requests is damaged; a hold is assumed",
                file=str(self._file.path),
                why=str(error),
            )
            return (HoldRequest(person_id=UNREADABLE_ID, name=UNKNOWN_NAME, at=""),)

    def write(self, asking: Iterable[HoldRequest]) -> None:
        """Replace all stored requests.

        Raises:
            StoreError: STORE_FULL and others; the stored requests stay.
        """
        lines = [{"id": one.person_id, "name": one.name, "at": one.at} for one in asking]
        with translate_errors(self._file.path.parent):
            self._file.write({"asking": lines})


def _requested(entry: Mapping[str, Any]) -> HoldRequest:
    return HoldRequest(person_id=str(entry["id"]), name=str(entry["name"]), at=str(entry["at"]))

"""Who asks to hold, on the disk: a small file that is written anew, whole, with each change.

It is a file of the home and not of a case, because a hold is about the theatre: it can be asked for without
an open case, and stays when another case is opened or the server starts again. It is announced before it is
written, so a full disk silences nobody. A case's archive has holds in its alarm log only.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import structlog

from server.security.audit.whole import write_private
from server.store import told
from server.store.home import sync_folder

FORM = 1
HOLDS_FILE = "holds.json"
UNREADABLE_ID = "unreadable"
SOMEBODY = "somebody (who is not known: the file of holds was damaged)"

_log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """That somebody asks to hold.

    Attributes:
        person_id: who, the same over all their sessions and over restarts.
        name: the same, as they are called.
        at: since when, UTC, ISO 8601.
    """

    person_id: str
    name: str
    at: str


class Keeping(Protocol):
    """Where it is kept who asks to hold."""

    def read(self) -> tuple[Asked, ...]:
        """Those who asked, in the order in which they did."""

    def write(self, asking: Iterable[Asked]) -> None:
        """Keep these alone; they are on the disk when this returns."""


class NotKept:
    """Where nothing is kept, a start of the server forgets who asked."""

    def read(self) -> tuple[Asked, ...]:
        """Nobody."""
        return ()

    def write(self, asking: Iterable[Asked]) -> None:
        """Nothing."""


class HoldsFile:
    """Holds of one theatre, whichever case is open in it, and also where none is.

    Args:
        folder: of the home.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._file = folder / HOLDS_FILE

    def read(self) -> tuple[Asked, ...]:
        """As written last. Of a damaged file only this is known: that it was about a hold.

        Raises:
            StoreError: the file cannot be read at all.
        """
        with told(self._folder):
            if not self._file.exists():
                return ()
            content = self._file.read_bytes()
        try:
            kept = json.loads(content)
            if kept["form"] != FORM:
                raise ValueError(f"its form is {kept['form']!r}")  # noqa: TRY301  told below with all others
            return tuple(_asked(one) for one in kept["asking"])
        except (ValueError, KeyError, TypeError) as error:
            _log.error("the file of holds is damaged, so a hold stands", file=str(self._file), why=str(error))
            return (Asked(person_id=UNREADABLE_ID, name=SOMEBODY, at=""),)

    def write(self, asking: Iterable[Asked]) -> None:
        """Keep these alone.

        Raises:
            StoreError: STORE_FULL and others; what was kept before stays.
        """
        lines = [{"id": one.person_id, "name": one.name, "at": one.at} for one in asking]
        with told(self._folder):
            write_private(self._file, json.dumps({"form": FORM, "asking": lines}, indent=1).encode())
            sync_folder(self._folder)


def _asked(told_line: Mapping[str, Any]) -> Asked:
    return Asked(person_id=str(told_line["id"]), name=str(told_line["name"]), at=str(told_line["at"]))

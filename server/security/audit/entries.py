"""An audit entry before it is added to the chain."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from server.security.person import Person

MAX_TEXT = 200


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """An action or attempt.

    Attributes:
        who: the person; `ANONYMOUS` without a session.
        what: route as documented ("POST /api/plan/vertebrae/{name}"), or another fixed name.
        address: client address; empty for the server's own entries.
        of: path parameters.
        status: HTTP status; None without a request.
        code: error code; empty without an error.
        changes: the changes, each with `from` and `to`.
    """

    who: Person
    what: str
    address: str = ""
    of: Mapping[str, str] = field(default_factory=dict)
    status: int | None = None
    code: str = ""
    changes: tuple[Mapping[str, object], ...] = ()

    def to_json(self) -> dict[str, object]:
        """Return the entry as a JSON object without empty fields."""
        line: dict[str, object] = {
            "who": {"id": self.who.id, "name": self.who.name, "role": self.who.role.value},
            "what": self.what[:MAX_TEXT],
        }
        if self.address:
            line["address"] = self.address
        if self.of:
            line["of"] = {key: value[:MAX_TEXT] for key, value in self.of.items()}
        if self.status is not None:
            line["status"] = self.status
        if self.code:
            line["code"] = self.code
        if self.changes:
            line["changes"] = [dict(change) for change in self.changes]
        return line

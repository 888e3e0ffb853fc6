"""One line of the audit log before it has its number and its place in the chain."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from server.security.person import Person

MAX_TEXT = 200


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """What somebody did, or tried.

    Attributes:
        who: the person; `NOBODY` where nobody was signed in.
        what: the address as it is documented ("POST /api/plan/vertebrae/{name}"), or a word of our own.
        address: of the machine that asked; empty where the server did it itself.
        of: the parts of the address that name things.
        status: of the answer; None where nothing was asked.
        code: why it was refused; empty where it was not.
        changes: what it changed, each with `from` and `to`.
    """

    who: Person
    what: str
    address: str = ""
    of: Mapping[str, str] = field(default_factory=dict)
    status: int | None = None
    code: str = ""
    changes: tuple[Mapping[str, object], ...] = ()

    def told(self) -> dict[str, object]:
        """The line's own words, as JSON takes them; empty ones are left out."""
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

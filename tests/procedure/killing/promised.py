"""What a server has confirmed, and whether it still exists after a kill."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from tests.procedure.real_server import RealServer

MANY_LINES = 10_000


@dataclass(slots=True)
class Promised:
    """Everything that was answered with 2xx, or read.

    Attributes:
        names: of users, each of whom made one confirmed change: in a document, a case or the log.
        documents: by id, a checksum of their content; empty if only the id is known.
        lines: of the alarm log of the open case, as last read.
        opened: the open case, as last confirmed; None if none is open.
        steps: states as last read, with the ids of the documents at that time.
        holding: who asks to hold, empty for nobody, as last confirmed; None if unknown.
        changes: number of confirmed changes.

    """

    names: set[str] = field(default_factory=set)
    documents: dict[str, str] = field(default_factory=dict)
    lines: list[str] = field(default_factory=list)
    opened: str | None = None
    steps: Mapping[str, str] = field(default_factory=dict)
    seen_ids: frozenset[str] = frozenset()
    holding: str | None = ""
    changes: int = 0

    def note(self, answer: Any) -> None:  # noqa: ANN401  JSON
        """Record a change that was confirmed with this answer."""
        self.changes += 1
        for document_id in _heading_ids(answer):
            self.documents.setdefault(document_id, "")

    def observe(self, server: RealServer) -> None:
        """Read everything: what was read once must persist."""
        ask = server.ask
        self.opened = ask("GET", "/api/cases", 200)["opened_id"]
        if self.opened is None:
            return
        ids = _ids(server, self.opened)
        for document_id in ids:
            if not self.documents.get(document_id):
                self.documents[document_id] = _sum(server, self.opened, document_id)
        self.lines = _lines(server)
        steps = ask("GET", "/api/procedure", 200)["steps"]
        self.steps = {one["step"]: one["state"] for one in steps}
        # Alarms are logged at any time and change no step.
        self.seen_ids = frozenset(_ids(server, self.opened, without="alarm"))

    def broken(self, server: RealServer) -> Iterator[str]:
        """Differences from what was confirmed; to be called directly after the start."""
        reported = server.ask("GET", "/api/cases", 200)
        if reported["opened_id"] != self.opened:
            yield f"the open case was {self.opened}, and is {reported['opened_id']}"
        requested_by = server.ask("GET", "/api/supervision/room", 200)["hold"]["requested_by"]
        if self.holding is not None and requested_by != [name for name in [self.holding] if name]:
            yield f"{self.holding or 'nobody'} asked to hold, and now {requested_by} does"
        if self.opened is None:
            return
        outline = server.ask("GET", f"/api/cases/{self.opened}/documents", 200)["documents"]
        ids = {one["id"] for one in outline}
        for document_id, content in self.documents.items():
            if document_id not in ids:
                yield f"document {document_id} is missing"
            elif content and _sum(server, self.opened, document_id) != content:
                yield f"document {document_id} has another content"
        lines = _lines(server)
        if lines[: len(self.lines)] != self.lines:
            yield f"the alarm log of {len(self.lines)} lines is not continued by its {len(lines)} lines"
        there = "\n".join([*lines, json.dumps(outline), json.dumps(reported, ensure_ascii=False)])
        yield from (f"what {name} did is missing" for name in sorted(self.names) if f'"{name}"' not in there)
        damage = server.ask("POST", f"/api/cases/{self.opened}/verification", 200)["damages"]
        yield from (one["message"] for one in damage)

    def changed_steps(self, server: RealServer) -> dict[str, tuple[str, str]]:
        """Steps whose state changed without a new document."""
        if self.opened is None or frozenset(_ids(server, self.opened, without="alarm")) != self.seen_ids:
            return {}
        steps = server.ask("GET", "/api/procedure", 200)["steps"]
        now = {one["step"]: one["state"] for one in steps}
        return {step: (was, now[step]) for step, was in self.steps.items() if now[step] != was}


def _ids(server: RealServer, case_id: str, *, without: str = "") -> list[str]:
    outline = server.ask("GET", f"/api/cases/{case_id}/documents", 200)["documents"]
    return [one["id"] for one in outline if one["kind"] != without]


def _sum(server: RealServer, case_id: str, document_id: str) -> str:
    content = server.ask("GET", f"/api/cases/{case_id}/documents/{document_id}", 200)["content"]
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _lines(server: RealServer) -> list[str]:
    lines = server.ask("GET", f"/api/alarms/log?last={MANY_LINES}", 200)["lines"]
    return [json.dumps(line, sort_keys=True, ensure_ascii=False) for line in lines]


def _heading_ids(answer: Any) -> Iterator[str]:  # noqa: ANN401  JSON
    if isinstance(answer, list):
        for one in answer:
            yield from _heading_ids(one)
    if isinstance(answer, dict):
        heading = answer.get("heading")
        if isinstance(heading, dict) and isinstance(heading.get("id"), str):
            yield heading["id"]
        for one in answer.values():
            yield from _heading_ids(one)

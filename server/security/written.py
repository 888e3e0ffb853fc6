"""What is done is in the audit log before its answer begins.

It is written before the answer and not before the act, so that on a full disk an alarm is still silenced
and a case still deleted. A reserve on the disk keeps room for the line; the next request is refused before
it begins.
"""

import asyncio
import json
from collections.abc import Sequence
from dataclasses import dataclass, replace

import structlog
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from server.security.audit import AuditLog, Entry, noting
from server.security.hosts import reject
from tracker.errors import NavigationError

REJECTED = 400
NO_ROOM = 507
log = structlog.get_logger(__name__)


async def pass_and_write(
    app: ASGIApp,
    scope: Scope,
    receive: Receive,
    send: Send,
    *,
    audit: AuditLog,
    entry: Entry,
    is_answered: bool = False,
) -> None:
    """Pass on; hold the answer back until its line is written, with what was changed on the way.

    Where it cannot be written, the answer says honestly that it was done all the same; with `is_answered`
    it stays as it is, and only the server's own log says so.
    """
    with noting() as changes:
        answer = _Answer(
            scope=scope,
            receive=receive,
            send=send,
            audit=audit,
            entry=entry,
            changes=changes,
            is_answered=is_answered,
        )
        try:
            await app(scope, receive, answer.take)
        finally:
            if answer.status is None:
                # Whoever asked has gone; what was done is done.
                await answer.write()


@dataclass(slots=True, kw_only=True)
class _Answer:
    """The answer of one request on its way out."""

    scope: Scope
    receive: Receive
    send: Send
    audit: AuditLog
    entry: Entry
    changes: Sequence[dict[str, object]]
    is_answered: bool
    status: int | None = None
    start: Message | None = None
    replaced: bool = False
    code: str = ""

    async def take(self, message: Message) -> None:
        """Send on, once the line is written; a refusal's line waits for its code, which is in its body."""
        if message["type"] == "http.response.start":
            self.status, self.start = int(message["status"]), message
            if self.status >= REJECTED:
                return
        if self.start is not None:
            start, self.start = self.start, None
            await self._begin(start, message)
            if message is start:
                return
        if not self.replaced:
            await self.send(message)

    async def _begin(self, start: Message, message: Message) -> None:
        if message is not start:
            self.code = _code_in(message.get("body", b""))
        problem = await self.write()
        if problem is not None and self.is_answered:
            log.warning(
                "it was done, but is not in the audit log yet", what=self.entry.what, code=problem.code
            )
            problem = None
        if problem is not None and self.status is not None and self.status < REJECTED:
            self.replaced = True
            await reject(self.scope, self.receive, self.send, status=NO_ROOM, body=_unwritten(problem))
            return
        await self.send(start)

    async def write(self) -> NavigationError | None:
        """Write the line; what is refused and changed nothing, no more often than refusals are written."""
        line = replace(self.entry, status=self.status, code=self.code, changes=tuple(self.changes))
        rejected = self.status is not None and self.status >= REJECTED and not self.changes
        try:
            await asyncio.to_thread(self.audit.rejected if rejected else self.audit.append, line)
        except NavigationError as error:
            return error
        return None


def _code_in(body: bytes) -> str:
    try:
        told = json.loads(body)
    except ValueError:
        return ""
    return str(told.get("code", "")) if isinstance(told, dict) else ""


def _unwritten(problem: NavigationError) -> dict[str, object]:
    return {
        "code": "AUDIT_NOT_WRITTEN",
        "message": f"it was done, but is not in the audit log yet: {problem.message}",
        "remedy": "Do not do it again; make room on the server's disk, and it is written by itself.",
        "context": problem.context,
    }

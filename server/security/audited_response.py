"""Writes the audit entry of a request before its response begins.

The entry is written before the response and not before the action, so that on a full disk an alarm can still
be silenced and a case deleted. Reserved disk space holds the entry; the next request is rejected before it
begins.
"""

import asyncio
import json
from collections.abc import Sequence
from dataclasses import dataclass, replace

import structlog
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from server.security.audit import AuditLog, Entry, collect_changes
from server.security.hosts import reject
from tracker.errors import NavigationError

REJECTED = 400
NO_ROOM = 507
log = structlog.get_logger(__name__)


async def run_audited(
    app: ASGIApp,
    scope: Scope,
    receive: Receive,
    send: Send,
    *,
    audit: AuditLog,
    entry: Entry,
    keeps_answer: bool = False,
) -> None:
    """Run the application; hold the response back until its audit entry, with all changes, is written.

    If it cannot be written, the response is replaced by an error that says that the action was done; with
    `keeps_answer` the response stays and only the server's log reports the failure.
    """
    with collect_changes() as changes:
        answer = _AuditedResponse(
            scope=scope,
            receive=receive,
            send=send,
            audit=audit,
            entry=entry,
            changes=changes,
            keeps_answer=keeps_answer,
        )
        try:
            await app(scope, receive, answer.take)
        finally:
            if answer.status is None:
                # The client has gone; the action is done.
                await answer.write()


@dataclass(slots=True, kw_only=True)
class _AuditedResponse:
    """Response of one request."""

    scope: Scope
    receive: Receive
    send: Send
    audit: AuditLog
    entry: Entry
    changes: Sequence[dict[str, object]]
    keeps_answer: bool
    status: int | None = None
    start: Message | None = None
    replaced: bool = False
    code: str = ""

    async def take(self, message: Message) -> None:
        """Pass a message on once the entry is written; an error's entry needs its code from the body."""
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
        if problem is not None and self.keeps_answer:
            log.warning(
                "the action was done, but is not in the audit log yet",
                what=self.entry.what,
                code=problem.code,
            )
            problem = None
        if problem is not None and self.status is not None and self.status < REJECTED:
            self.replaced = True
            await reject(self.scope, self.receive, self.send, status=NO_ROOM, body=_not_audited(problem))
            return
        await self.send(start)

    async def write(self) -> NavigationError | None:
        """Write the entry; an error without changes counts for the rate limit of rejections."""
        line = replace(self.entry, status=self.status, code=self.code, changes=tuple(self.changes))
        rejected = self.status is not None and self.status >= REJECTED and not self.changes
        try:
            await asyncio.to_thread(self.audit.append_rejection if rejected else self.audit.append, line)
        except NavigationError as error:
            return error
        return None


def _code_in(body: bytes) -> str:
    try:
        reported = json.loads(body)
    except ValueError:
        return ""
    return str(reported.get("code", "")) if isinstance(reported, dict) else ""


def _not_audited(problem: NavigationError) -> dict[str, object]:
    return {
        "code": "AUDIT_NOT_WRITTEN",
        "message": f"the action was done, but is not in the audit log yet: {problem.message}",
        "remedy": "Do not repeat it. Free space on the server's disk; the entry is then written.",
        "context": problem.context,
        "language": "en",
    }

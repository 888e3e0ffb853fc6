"""Read and export the audit log."""

import json
from typing import Annotated

from fastapi import APIRouter, Query
from fastapi.responses import FileResponse, Response

from server.api.errors import rejections
from server.api.session_messages import AuditMessage
from server.security.audit import AuditLog

LINES = "application/x-ndjson"


def audit_router(audit: AuditLog | None) -> APIRouter:
    """Return the router of `/api/audit`."""
    router = APIRouter(prefix="/api/audit", tags=["people"])

    @router.get("", responses=rejections(422, 503))
    def read(
        last: Annotated[int, Query(ge=1, le=1000)] = 100,
        before: Annotated[int | None, Query(ge=1, le=10**9)] = None,
    ) -> AuditMessage:
        """Return the last lines of the audit log (before a line number), and whether it is intact."""
        if audit is None:
            return AuditMessage(lines=[], count=0, sum="", is_intact=True, fault="", fault_line=None)
        verdict = audit.verify()
        fault = verdict.fault
        return AuditMessage(
            lines=[_line_value(raw) for raw in audit.newest(last, before=before)],
            count=verdict.head.count,
            sum=verdict.head.sum,
            is_intact=fault is None,
            fault="" if fault is None else fault.reason,
            fault_line=None if fault is None else fault.line,
        )

    @router.get(
        "/export",
        response_class=FileResponse,
        responses={200: {"content": {LINES: {}}}, **rejections(503)},
    )
    def export() -> Response:
        """Return the log as JSON lines; check it with `coaxial audit verify FILE`."""
        content = b"" if audit is None else audit.complete_lines()
        headers = {"Content-Disposition": 'attachment; filename="coaxial-audit.jsonl"'}
        return Response(content, media_type=LINES, headers=headers)

    return router


def _line_value(raw: bytes) -> dict[str, object]:
    """Parse a line of the log; a line that is not valid JSON is returned as `damaged`."""
    try:
        line = json.loads(raw)
    except (ValueError, RecursionError):
        line = None
    return line if isinstance(line, dict) else {"damaged": raw[:200].decode(errors="replace")}

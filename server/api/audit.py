"""The audit log: read, and taken along."""

import json
from typing import Annotated

from fastapi import APIRouter, Query
from fastapi.responses import FileResponse, Response

from server.api.errors import rejections
from server.api.session_messages import AuditMessage
from server.security.audit import AuditLog

LINES = "application/x-ndjson"


def audit_router(audit: AuditLog | None) -> APIRouter:
    """Everything under `/api/audit`."""
    router = APIRouter(prefix="/api/audit", tags=["people"])

    @router.get("", responses=rejections(422, 503))
    def read(
        last: Annotated[int, Query(ge=1, le=1000)] = 100,
        before: Annotated[int | None, Query(ge=1, le=10**9)] = None,
    ) -> AuditMessage:
        """The last lines of the audit log, or the last ones before a number; and whether the log is whole."""
        if audit is None:
            return AuditMessage(lines=[], count=0, sum="", is_whole=True, fault="", fault_line=None)
        verdict = audit.verify()
        fault = verdict.fault
        return AuditMessage(
            lines=[_told(raw) for raw in audit.newest(last, before=before)],
            count=verdict.head.count,
            sum=verdict.head.sum,
            is_whole=fault is None,
            fault="" if fault is None else fault.said,
            fault_line=None if fault is None else fault.line,
        )

    @router.get(
        "/export",
        response_class=FileResponse,
        responses={200: {"content": {LINES: {}}}, **rejections(503)},
    )
    def export() -> Response:
        """The whole log, a line of JSON for each; `coaxial audit verify FILE` tells whether it is whole."""
        content = b"" if audit is None else audit.whole()
        headers = {"Content-Disposition": 'attachment; filename="coaxial-audit.jsonl"'}
        return Response(content, media_type=LINES, headers=headers)

    return router


def _told(raw: bytes) -> dict[str, object]:
    """A line as it lies there; one that is none any more is shown as what it is."""
    try:
        line = json.loads(raw)
    except ValueError:
        line = None
    return line if isinstance(line, dict) else {"damaged": raw[:200].decode(errors="replace")}

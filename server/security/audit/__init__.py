"""Append-only audit log with a hash chain: who did what and when, and what changed."""

from server.security.audit.chain import Fault, Verdict, verify
from server.security.audit.changes import collect_changes, note
from server.security.audit.entries import Entry
from server.security.audit.files import verify_files
from server.security.audit.log import AUDIT_FILE, HEAD_FILE, AuditLog
from server.security.audit.lost_changes import mark_lost_changes

__all__ = [
    "AUDIT_FILE",
    "HEAD_FILE",
    "AuditLog",
    "Entry",
    "Fault",
    "Verdict",
    "collect_changes",
    "mark_lost_changes",
    "note",
    "verify",
    "verify_files",
]

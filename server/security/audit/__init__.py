"""Who did what, when, from which version to which: lines that only grow, each sealed by the next."""

from server.security.audit.chain import Fault, Verdict, verify
from server.security.audit.entries import Entry
from server.security.audit.log import AUDIT_FILE, HEAD_FILE, AuditLog
from server.security.audit.noted import note, noting
from server.security.audit.whole import verify_files

__all__ = [
    "AUDIT_FILE",
    "HEAD_FILE",
    "AuditLog",
    "Entry",
    "Fault",
    "Verdict",
    "note",
    "noting",
    "verify",
    "verify_files",
]

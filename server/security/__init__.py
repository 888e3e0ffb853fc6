"""Who may talk to this server, and do what: hosts, people and their roles, what is written of what they did.

`table.py` is the one table of who may do what; `guard.py` holds everything that is asked against it.
"""

from server.security.audit import AuditLog
from server.security.guard import SessionGuard
from server.security.headers import SecurityHeaders, page_policy
from server.security.hosts import HostGuard, KnownHosts
from server.security.people import PeopleDesk
from server.security.person import ANYBODY, NOBODY, Person, Role, acting, person_of

__all__ = [
    "ANYBODY",
    "NOBODY",
    "AuditLog",
    "HostGuard",
    "KnownHosts",
    "PeopleDesk",
    "Person",
    "Role",
    "SecurityHeaders",
    "SessionGuard",
    "acting",
    "page_policy",
    "person_of",
]

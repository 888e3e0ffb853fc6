"""Access control: hosts, people and their roles, and the audit log.

`access_rules.py` is the one table of permissions; `guard.py` checks every request against it.
"""

from server.security.audit import AuditLog
from server.security.guard import SessionGuard
from server.security.headers import SecurityHeaders, page_policy
from server.security.hosts import HostGuard, KnownHosts
from server.security.people import PeopleService
from server.security.person import ANONYMOUS, LOCAL_USER, Person, Role, actor_name, person_of

__all__ = [
    "ANONYMOUS",
    "LOCAL_USER",
    "AuditLog",
    "HostGuard",
    "KnownHosts",
    "PeopleService",
    "Person",
    "Role",
    "SecurityHeaders",
    "SessionGuard",
    "actor_name",
    "page_policy",
    "person_of",
]

"""Who may talk to this server: hosts it answers to, pages that may open its sockets, headers it sends along.

People, roles and sessions will live here too.
"""

from server.security.headers import SecurityHeaders
from server.security.hosts import HostGuard, KnownHosts
from server.security.person import ANYBODY, Person, Role, person_of

__all__ = ["ANYBODY", "HostGuard", "KnownHosts", "Person", "Role", "SecurityHeaders", "person_of"]

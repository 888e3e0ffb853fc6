"""Invitations, sessions and sign-in."""

from server.security.people.failed_logins import FailedLogins
from server.security.people.records import Invitation, InvitationState, Session
from server.security.people.service import PeopleService
from server.security.people.tokens import Token

__all__ = ["FailedLogins", "Invitation", "InvitationState", "PeopleService", "Session", "Token"]

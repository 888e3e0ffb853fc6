"""Who is invited, and who is signed in."""

from server.security.people.desk import PeopleDesk
from server.security.people.guesses import Guesses
from server.security.people.records import Invitation, InvitationState, Session
from server.security.people.tokens import Token

__all__ = ["Guesses", "Invitation", "InvitationState", "PeopleDesk", "Session", "Token"]

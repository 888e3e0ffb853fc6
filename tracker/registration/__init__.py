"""Registration: where the vertebra of the plan is in the theatre, and how sure that is."""

from tracker.registration.record import AnchoredTo, Method, Registration

__all__ = ["AnchoredTo", "Method", "Registration"]

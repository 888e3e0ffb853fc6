"""How the plan's vertebra is found on the patient: `Registration`, and the ways to make one."""

from tracker.registration.record import AnchoredTo, Method, Registration

__all__ = ["AnchoredTo", "Method", "Registration"]

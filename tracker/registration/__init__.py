"""Registration of the planned vertebra to the patient: the `Registration` record, and the methods."""

from tracker.registration.record import AnchoredTo, Method, Registration

__all__ = ["AnchoredTo", "Method", "Registration"]

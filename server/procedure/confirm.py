"""The confirmation after a start: a person says that patient, marker and camera stand as they did."""

import time
from collections.abc import Callable

from server.errors import SetupOrderError
from server.live import LiveHub
from server.procedure.confirmed import ConfirmationNeeded, KeptConfirmation, confirmation_name
from server.procedure.opened import opened_case
from server.procedure.state import Procedure
from server.store import CaseStore, Document, DocumentKind, OutOfDateError

LOOK_AGAIN = "Look at what is asked now, and confirm that."


class ConfirmStep:
    """Takes a person's word, and keeps it in the case. Safe to use from any thread.

    Args:
        hub: the live images: nobody confirms what they do not see.
        store: where it is kept.
        procedure: knows what is to be confirmed.
        clock: the one that images are stamped with.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        store: CaseStore,
        procedure: Procedure,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._hub = hub
        self._store = store
        self._procedure = procedure
        self._clock = clock

    def confirm(self, registration_id: str, *, made_by: str) -> Document | None:
        """Keep that this registration still holds, and navigation goes on; None where nobody asks any more.

        Args:
            registration_id: the document that was shown to whoever confirms it.
            made_by: who confirms.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CONFIRMATION_UNSEEN.
            OutOfDateError: CONFIRMATION_OUT_OF_DATE, another registration is in use by now.
        """
        case = opened_case(self._store)
        needed = self._procedure.state().confirmation
        if needed is None:
            return None
        _reject_another(needed, registration_id)
        # From a clock that is read before the picture is looked for: a restart in between asks again.
        at_s = self._clock()
        newest = self._hub.newest
        if newest is None or newest.snapshot is None:
            raise SetupOrderError(
                "CONFIRMATION_UNSEEN",
                "no picture comes from the camera, and nobody can confirm what they do not see",
                "Wait until the picture is there again, look at it, then confirm.",
            )
        kept = KeptConfirmation(
            vertebra=needed.vertebra, because=needed.because, run=self._procedure.run, from_s=at_s
        )
        return self._store.put(
            case.id,
            DocumentKind.CONFIRMATION,
            confirmation_name(needed.vertebra),
            kept.model_dump(mode="json"),
            made_by=made_by,
            stands_on=[needed.registration.id],
        )


def _reject_another(needed: ConfirmationNeeded, registration_id: str) -> None:
    if registration_id != needed.registration.id:
        raise OutOfDateError(
            "CONFIRMATION_OUT_OF_DATE",
            f"what was shown is not in use any more, but {needed.registration.title} is",
            LOOK_AGAIN,
            {"registration_id": needed.registration.id},
        )

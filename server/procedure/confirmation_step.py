"""The confirmation after a restart that patient, marker and camera were not moved."""

import time
from collections.abc import Callable

from server.errors import SetupOrderError
from server.live import LiveHub
from server.procedure.confirmation import ConfirmationPrompt, ConfirmationRecord, confirmation_name
from server.procedure.open_case import require_open_case
from server.procedure.state import Procedure
from server.store import CaseStore, Document, DocumentKind, OutOfDateError

LOOK_AGAIN = "Read the new prompt, and confirm it."


class ConfirmStep:
    """Stores a person's confirmation in the open case. Thread-safe.

    Args:
        hub: the live images; a confirmation without a picture is rejected.
        store: where the confirmation is stored.
        procedure: state of the procedure, with the confirmation that is needed.
        clock: the clock of the images' time stamps.
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
        """Store that this registration is still valid. Return None if no confirmation is needed any more.

        Args:
            registration_id: the document that was shown to the person.
            made_by: name of the person.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CONFIRMATION_UNSEEN.
            OutOfDateError: CONFIRMATION_OUT_OF_DATE, another registration is in use.
        """
        case = require_open_case(self._store)
        needed = self._procedure.state().confirmation
        if needed is None:
            return None
        _reject_another(needed, registration_id)
        # Read before the newest image is fetched: a restart in between then asks for another confirmation.
        at_s = self._clock()
        newest = self._hub.newest
        if newest is None or newest.snapshot is None:
            raise SetupOrderError(
                "CONFIRMATION_UNSEEN",
                "there is no image of the camera, so nothing can be verified",
                "Wait until the video runs, verify it, then confirm.",
            )
        record = ConfirmationRecord(
            vertebra=needed.vertebra, because=needed.because, run=self._procedure.run, from_s=at_s
        )
        return self._store.put(
            case.id,
            DocumentKind.CONFIRMATION,
            confirmation_name(needed.vertebra),
            record.model_dump(mode="json"),
            made_by=made_by,
            depends_on=[needed.registration.id],
        )


def _reject_another(needed: ConfirmationPrompt, registration_id: str) -> None:
    if registration_id != needed.registration.id:
        raise OutOfDateError(
            "CONFIRMATION_OUT_OF_DATE",
            f"the displayed registration is no longer in use; {needed.registration.title} is in use now",
            LOOK_AGAIN,
            {"registration_id": needed.registration.id, "title": needed.registration.title_text},
        )

"""A registration, and its check on anatomy, as a case keeps them."""

from dataclasses import replace
from typing import Annotated

import numpy as np
from pydantic import Field, ValidationError

from server.config import Point, Section
from server.procedure.read import read_document
from server.store import Document, says_archive
from tracker.errors import InvalidInput, NavigationError, RegistrationError
from tracker.geometry import Rigid
from tracker.registration import AnchoredTo, Method, Registration
from tracker.registration.nudge import NudgeAxis, NudgeKind

Row4 = Annotated[list[float], Field(min_length=4, max_length=4)]
Row6 = Annotated[list[float], Field(min_length=6, max_length=6)]
Value = float | int | bool | str | None


class KeptNudge(Section):
    """One nudge by hand."""

    kind: NudgeKind
    axis: NudgeAxis
    amount: float
    """mm or degrees, with its sign."""
    made_by: str
    made_at: str
    """UTC, ISO 8601 with milliseconds."""


class KeptNudges(Section):
    """A registration before it was nudged, and what was nudged since."""

    anchor_from_vertebra: Annotated[list[Row4], Field(min_length=4, max_length=4)]
    covariance: Annotated[list[Row6], Field(min_length=6, max_length=6)]
    pivot_lps_mm: Annotated[list[float], Field(min_length=3, max_length=3)]
    """About which it is turned: between the entry points."""
    nudges: list[KeptNudge]
    """The oldest first."""

    def made(self, nudged: Registration) -> Registration:
        """The registration as it was before."""
        return replace(
            nudged,
            anchor_from_vertebra=Rigid.from_matrix(self.anchor_from_vertebra),
            covariance=np.array(self.covariance),
        )


class KeptRegistration(Section):
    """What a case keeps of a registration."""

    vertebra: str
    """Its name in the plan, and the name of the document."""
    method: Method
    anchored_to: AnchoredTo
    reference: str = ""
    """The marker that it is fixed to; empty where it is fixed to the camera."""
    anchor_from_vertebra: Annotated[list[Row4], Field(min_length=4, max_length=4)]
    covariance: Annotated[list[Row6], Field(min_length=6, max_length=6)]
    tip_slope: Annotated[list[Point], Field(min_length=6, max_length=6)] = [[0.0] * 3] * 6
    """How it follows an error of the tip that touched; 0 where no tip did."""
    tool: str = ""
    """Whose tip that was."""
    run: str
    """Which run of the server it was made in: past its end nobody knows whether a camera was moved."""
    from_s: float | None = None
    """When its first point was touched, by the clock of that run's images; null where no tip touched."""
    numbers: dict[str, Value]
    """Of its gates."""
    made_from: dict[str, object]
    """The points, needles or sweep behind it."""
    nudged: KeptNudges | None = None
    """What was nudged by hand since; null where nothing was."""

    @classmethod
    def of(
        cls,
        registration: Registration,
        *,
        vertebra: str,
        reference: str,
        run: str,
        numbers: dict[str, Value],
        made_from: dict[str, object],
        from_s: float | None,
    ) -> "KeptRegistration":
        """As it is kept."""
        return cls(
            vertebra=vertebra,
            method=registration.method,
            anchored_to=registration.anchored_to,
            reference=reference,
            anchor_from_vertebra=registration.anchor_from_vertebra.matrix.tolist(),
            covariance=registration.covariance.tolist(),
            tip_slope=registration.tip_slope.tolist(),
            tool=registration.tool,
            run=run,
            numbers=numbers,
            made_from=made_from,
            from_s=from_s,
        )

    @property
    def registration(self) -> Registration:
        """As navigation uses it.

        Raises:
            InvalidInput: ROTATION_INVALID.
            RegistrationError: REGISTRATION_COVARIANCE_INVALID.
        """
        return Registration(
            method=self.method,
            anchored_to=self.anchored_to,
            anchor_from_vertebra=Rigid.from_matrix(self.anchor_from_vertebra),
            covariance=np.array(self.covariance),
            tip_slope=np.array(self.tip_slope),
            tool=self.tool,
        )


class KeptCheck(Section):
    """What a case keeps of a check on anatomy: it stands on the registration that was checked."""

    vertebra: str
    landmark: str
    tool: str
    distance_mm: float
    max_mm: float
    """What was allowed."""
    passed: bool
    run: str
    """Which run of the server it was made in."""
    from_s: float
    """When the tip was first seen on the landmark, by the clock of that run's images."""
    off_lps_mm: list[float]
    """Where the registration has the tip, minus the landmark: to the left, the back, the head."""
    sd_mm: float
    """How unsure that distance is (3-D RMS), by what registration and tip state."""
    images: int


def check_name(vertebra: str) -> str:
    """What the document of a vertebra's check on anatomy is called."""
    return f"registration of {vertebra}"


def _doubted(kept: KeptRegistration, document: Document) -> KeptRegistration:
    """Of what came in with an archive, it is the archive that says who nudged; also of later versions."""
    if document.imported is None or kept.nudged is None:
        return kept
    nudges = [one.model_copy(update={"made_by": says_archive(one.made_by)}) for one in kept.nudged.nudges]
    return kept.model_copy(update={"nudged": kept.nudged.model_copy(update={"nudges": nudges})})


def kept_registration(document: Document, *, reference: str) -> KeptRegistration:
    """The registration in a document of a case, with numbers that can be used.

    Args:
        document: as it is stored.
        reference: the marker that is fixed to the patient now; empty where there is none.

    Raises:
        InvalidInput: REGISTRATION_DOCUMENT_INVALID.
        RegistrationError: REFERENCE_DIFFERS, it is fixed to another marker than this one.
    """
    try:
        kept = KeptRegistration.model_validate(dict(document.content), strict=False)
        # What cannot be a rotation or a covariance is told here, not in the middle of an image.
        _ = kept.registration
    except (ValidationError, NavigationError) as error:
        why = (
            error.message if isinstance(error, NavigationError) else f"{error.error_count()} values are wrong"
        )
        raise InvalidInput(
            "REGISTRATION_DOCUMENT_INVALID",
            f"{document.title} cannot be read: {why}",
            "Register again.",
            {"document_id": document.id},
        ) from None
    kept = _doubted(kept, document)
    if kept.anchored_to is AnchoredTo.REFERENCE and kept.reference != reference:
        now = f"names '{reference}'" if reference else "names none"
        raise RegistrationError(
            "REFERENCE_DIFFERS",
            f"{document.title} is fixed to the marker '{kept.reference}', and reference in the config {now}",
            "Name the marker that is on the patient as reference.marker, or register again.",
            {"registered": kept.reference, "reference": reference},
        )
    return kept


def kept_check(document: Document) -> KeptCheck:
    """The check in a document of a case.

    Raises:
        InvalidInput: CHECK_DOCUMENT_INVALID.
    """
    return read_document(
        KeptCheck, document, code="CHECK_DOCUMENT_INVALID", remedy="Check the registration again."
    )

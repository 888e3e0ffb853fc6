"""Records of a registration and of its check on anatomy, as stored in a case."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated

import numpy as np
from pydantic import Field, ValidationError

from server.config import Point, Section
from server.procedure.documents import parse_document
from server.store import Document, says_archive
from tracker.errors import InvalidInput, NavigationError, RegistrationError
from tracker.geometry import Rigid
from tracker.registration import AnchoredTo, Method, Registration
from tracker.registration.nudge import NudgeAxis, NudgeKind

Row4 = Annotated[list[float], Field(min_length=4, max_length=4)]
Row6 = Annotated[list[float], Field(min_length=6, max_length=6)]
Value = float | int | bool | str | None


class NudgeRecord(Section):
    """One manual correction (nudge)."""

    kind: NudgeKind
    axis: NudgeAxis
    amount: float
    """mm or degrees, with its sign."""
    made_by: str
    made_at: str
    """UTC, ISO 8601 with milliseconds."""


class NudgeHistory(Section):
    """The registration before its first nudge, and all nudges since."""

    anchor_from_vertebra: Annotated[list[Row4], Field(min_length=4, max_length=4)]
    covariance: Annotated[list[Row6], Field(min_length=6, max_length=6)]
    pivot_lps_mm: Annotated[list[float], Field(min_length=3, max_length=3)]
    """Centre of rotation: the mean of the entry points."""
    nudges: list[NudgeRecord]
    """Oldest first."""

    def made(self, nudged: Registration) -> Registration:
        """Return the registration without its nudges."""
        return replace(
            nudged,
            anchor_from_vertebra=Rigid.from_matrix(self.anchor_from_vertebra),
            covariance=np.array(self.covariance),
        )


class ExpectedCovariance(Section):
    """The covariance that is expected with more landmarks, see `PointRegistration.covariance_with_more`."""

    landmarks: int
    """Number of landmarks, including those of the registration."""
    covariance: Annotated[list[Row6], Field(min_length=6, max_length=6)]
    """Covariance of `anchor_from_vertebra`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationEvidence:
    """What a registration was computed from, and how well it fits.

    Attributes:
        numbers: results that are compared with the acceptance limits, by name.
        made_from: the points, needles or sweep.
        from_s: capture time of its first point, on the image clock of the run; None where no tip was used.
        with_more_landmarks: covariances that are expected with more landmarks.
    """

    numbers: Mapping[str, Value] = field(default_factory=dict)
    made_from: Mapping[str, object] = field(default_factory=dict)
    from_s: float | None
    with_more_landmarks: Sequence[ExpectedCovariance] = ()


class RegistrationRecord(Section):
    """A registration as stored in a case."""

    vertebra: str
    """Name of the vertebra in the plan; also the name of the document."""
    method: Method
    anchored_to: AnchoredTo
    reference: str = ""
    """The reference marker that it is anchored to; empty if it is anchored to the camera."""
    anchor_from_vertebra: Annotated[list[Row4], Field(min_length=4, max_length=4)]
    covariance: Annotated[list[Row6], Field(min_length=6, max_length=6)]
    tip_jacobian: Annotated[list[Point], Field(min_length=6, max_length=6)] = [[0.0] * 3] * 6
    """Sensitivity of the registration to an error of the tool tip; 0 where no tip was used."""
    tool: str = ""
    """The tool whose tip captured the points."""
    tracking_covariance_mm2: Annotated[list[Point], Field(min_length=3, max_length=3)] = [[0.0] * 3] * 3
    """Covariance of the tip in the anchor frame, from the marker poses at the best capture; 0 if unknown."""
    with_more_landmarks: list[ExpectedCovariance] = Field(default_factory=list)
    """By increasing number of landmarks; empty if it cannot be predicted."""
    run: str
    """Server run in which it was made. A move of the camera between two runs is not detected."""
    from_s: float | None = None
    """Capture time of its first point, on the image clock of that run; null where no tip was used."""
    numbers: dict[str, Value]
    """Results that are compared with the acceptance limits, by name."""
    made_from: dict[str, object]
    """The points, needles or sweep that it was computed from."""
    nudged: NudgeHistory | None = None
    """Manual corrections since; null if there are none."""

    @classmethod
    def of(
        cls,
        registration: Registration,
        evidence: RegistrationEvidence,
        *,
        vertebra: str,
        reference: str,
        run: str,
    ) -> "RegistrationRecord":
        """Create the record of a registration."""
        return cls(
            vertebra=vertebra,
            method=registration.method,
            anchored_to=registration.anchored_to,
            reference=reference,
            anchor_from_vertebra=registration.anchor_from_vertebra.matrix.tolist(),
            covariance=registration.covariance.tolist(),
            tip_jacobian=registration.tip_jacobian.tolist(),
            tool=registration.tool,
            tracking_covariance_mm2=registration.tracking_covariance_mm2.tolist(),
            with_more_landmarks=list(evidence.with_more_landmarks),
            run=run,
            numbers=dict(evidence.numbers),
            made_from=dict(evidence.made_from),
            from_s=evidence.from_s,
        )

    @property
    def registration(self) -> Registration:
        """Return the registration for navigation.

        Raises:
            InvalidInput: ROTATION_INVALID.
            RegistrationError: REGISTRATION_COVARIANCE_INVALID.
        """
        return Registration(
            method=self.method,
            anchored_to=self.anchored_to,
            anchor_from_vertebra=Rigid.from_matrix(self.anchor_from_vertebra),
            covariance=np.array(self.covariance),
            tip_jacobian=np.array(self.tip_jacobian),
            tool=self.tool,
            tracking_covariance_mm2=np.array(self.tracking_covariance_mm2),
        )


class CheckRecord(Section):
    """A check on anatomy as stored in a case. Its document depends on the registration that was checked."""

    vertebra: str
    landmark: str
    tool: str
    distance_mm: float
    max_mm: float
    """Maximum accepted distance."""
    passed: bool
    run: str
    """Server run in which it was made."""
    from_s: float
    """First image with the tip on the landmark, on the image clock of that run."""
    off_lps_mm: list[float]
    """Registered tip position minus landmark position, LPS (left, posterior, superior)."""
    sd_mm: float
    """Standard deviation (3-D RMS) of the distance, from the covariances of registration and tip."""
    images: int


def check_name(vertebra: str) -> str:
    """Return the document name of a vertebra's check on anatomy."""
    return f"registration of {vertebra}"


def _as_imported(record: RegistrationRecord, document: Document) -> RegistrationRecord:
    """Mark the authors of nudges in an imported registration as stated by the archive only."""
    if document.imported is None or record.nudged is None:
        return record
    nudges = [one.model_copy(update={"made_by": says_archive(one.made_by)}) for one in record.nudged.nudges]
    return record.model_copy(update={"nudged": record.nudged.model_copy(update={"nudges": nudges})})


def registration_from_document(document: Document, *, reference: str, has_images: bool) -> RegistrationRecord:
    """Parse the registration in a case document and validate its matrices.

    Args:
        document: the stored document.
        reference: the reference marker on the patient now; empty if there is none.
        has_images: whether a camera measures now; False for an external tracker.

    Raises:
        InvalidInput: REGISTRATION_DOCUMENT_INVALID.
        RegistrationError: REFERENCE_DIFFERS, it is anchored to another marker than this one;
            REGISTERED_TO_CAMERA, in whose place an external tracker measures.
    """
    try:
        record = RegistrationRecord.model_validate(dict(document.content), strict=False)
        # Reject an invalid rotation or covariance here, not while an image is processed.
        _ = record.registration
    except (ValidationError, NavigationError) as error:
        why = (
            error.message
            if isinstance(error, NavigationError)
            else f"{error.error_count()} values are invalid"
        )
        raise InvalidInput(
            "REGISTRATION_DOCUMENT_INVALID",
            f"{document.title} cannot be read: {why}",
            "Register again.",
            {"document_id": document.id, "title": document.title_text, "document_problem": why},
        ) from None
    record = _as_imported(record, document)
    if record.anchored_to is AnchoredTo.REFERENCE and record.reference != reference:
        now = f"names '{reference}'" if reference else "is not set"
        raise RegistrationError(
            "REFERENCE_DIFFERS",
            f"{document.title} is anchored to the marker '{record.reference}', "
            f"but reference.marker in the settings {now}",
            "Set reference.marker to the marker on the patient, or register again.",
            {
                "registered": record.reference,
                "reference": reference,
                "title": document.title,
                "reference_setting": now,
            },
        )
    if record.anchored_to is AnchoredTo.CAMERA and not has_images:
        raise RegistrationError(
            "REGISTERED_TO_CAMERA",
            f"{document.title} is anchored to a camera, but an external tracker measures now",
            "Register again.",
            {"title": document.title_text},
        )
    return record


def with_tip_in_common(
    record: RegistrationRecord, document: Document, tools: Iterable[Document]
) -> RegistrationRecord:
    """Return the record; its tool is removed if the case has another calibration of that tool since.

    The tip error cancels only with the calibration used for the registration. A registration with a tool of
    the settings depends on no calibration of the case, and stays valid when the case calibrates a tool of the
    same name.

    Args:
        record: The registration.
        document: Its document.
        tools: Valid tool calibrations of the case.
    """
    if all(one.name != record.tool or one.id in document.depends_on for one in tools):
        return record
    return record.model_copy(update={"tool": ""})


def check_from_document(document: Document) -> CheckRecord:
    """Parse the check on anatomy in a case document.

    Raises:
        InvalidInput: CHECK_DOCUMENT_INVALID.
    """
    return parse_document(
        CheckRecord, document, code="CHECK_DOCUMENT_INVALID", remedy="Check the registration again."
    )

"""Result records of one verified theatre: a row for each image and for each registration."""

from dataclasses import dataclass
from enum import StrEnum

from tracker.registration import AnchoredTo
from tracker.rehearsal import Phase
from tracker.verification.tool_errors import ToolErrors


class RegistrationMethod(StrEnum):
    """Registration method."""

    POINTS = "points"
    NEEDLES = "needles"  # and the ruler, as in the paper
    NEEDLES_TOUCHED = "needles+touch"  # and the tip on two landmarks


@dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """One verified configuration.

    Attributes:
        method: registration method.
        anchored_to: camera, or patient reference.
        camera_moves: whether the camera is moved during the operation.
    """

    method: RegistrationMethod
    anchored_to: AnchoredTo
    camera_moves: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class ImageRow:
    """Result of one image.

    Attributes:
        seed: seed of the theatre.
        variant: the verified configuration.
        at_s: time on the operation's clock.
        phase: true phase of the operation.
        counts: whether it enters the statistics.
        since_move_s: time since the camera was moved; negative before, and without a move.
        absent: reason why nothing is displayed; empty otherwise.
        tool_errors: errors of the displayed values; None without any.
        is_through: whether the true drill perforates the wall.
        through_ratio: stated probability of a perforation.
    """

    seed: int
    variant: Variant
    at_s: float
    phase: Phase
    counts: bool
    since_move_s: float
    absent: str
    tool_errors: ToolErrors | None
    is_through: bool
    through_ratio: float


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationRow:
    """Result of one registration.

    Attributes:
        seed: seed of the theatre.
        method: registration method.
        anchored_to: camera or reference.
        rejected: error code; empty if it was accepted.
        check_mm: distance of the anatomical check; NaN without a check.
        check_passed: whether the check would allow navigation.
    """

    seed: int
    method: RegistrationMethod
    anchored_to: AnchoredTo
    rejected: str
    check_mm: float
    check_passed: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class TheatreRows:
    """All results of one theatre."""

    seed: int
    registrations: tuple[RegistrationRow, ...]
    images: tuple[ImageRow, ...]

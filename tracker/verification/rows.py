"""What a verified theatre leaves: a row for each image that was looked at, and each refusal."""

from dataclasses import dataclass
from enum import StrEnum

from tracker.registration import AnchoredTo
from tracker.rehearsal import Phase
from tracker.verification.held import HeldTool


class Way(StrEnum):
    """How the vertebra was found."""

    POINTS = "points"
    NEEDLES = "needles"  # and the ruler, as in the paper
    NEEDLES_TOUCHED = "needles+touch"  # and the tip on two landmarks


@dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """What is verified.

    Attributes:
        way: how the vertebra was found.
        anchored_to: with or without the patient reference.
        camera_moves: whether the camera is moved in the middle.
    """

    way: Way
    anchored_to: AnchoredTo
    camera_moves: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class ImageRow:
    """One image.

    Attributes:
        seed: of the theatre.
        variant: what was verified.
        at_s: on the operation's clock.
        phase: what the hand did.
        counts: whether it is one of the images that are spread over the operation.
        since_move_s: after the camera was moved; below 0 before, and where it never was.
        absent: why nothing is shown; empty where numbers are.
        held: the numbers that are shown against the truth; None where none are.
        is_through: whether the true drill is through the wall.
        through_ratio: how probable that is said to be.
    """

    seed: int
    variant: Variant
    at_s: float
    phase: Phase
    counts: bool
    since_move_s: float
    absent: str
    held: HeldTool | None
    is_through: bool
    through_ratio: float


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationRow:
    """One registration.

    Attributes:
        seed: of the theatre.
        way: how.
        anchored_to: to what.
        refused: code of what refused it; empty where it stands.
        check_mm: what the check on anatomy measured; not a number where nothing was checked.
        check_passed: whether navigation would be let on.
    """

    seed: int
    way: Way
    anchored_to: AnchoredTo
    rejected: str
    check_mm: float
    check_passed: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class TheatreRows:
    """All of one theatre."""

    seed: int
    registrations: tuple[RegistrationRow, ...]
    images: tuple[ImageRow, ...]

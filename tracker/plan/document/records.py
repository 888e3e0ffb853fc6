"""Records of the plan document. The storage layer adds author and time."""

from dataclasses import dataclass

from tracker.errors import PlanError
from tracker.plan.channel import Channel
from tracker.plan.document.corrections import PedicleRecord
from tracker.plan.landmark import Landmark, reject_duplicate_names
from tracker.plan.pedicle import Side
from tracker.plan.reference_slice import ReferenceSlice
from tracker.plan.screw import ScrewPlan

# Version 2 added landmarks; version 1 is read without any. Up to version 2 a warning was a sentence.
FORMAT_VERSION, READABLE_VERSIONS = 3, (1, 2, 3)
MAX_LISTED_LENGTH = 400


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedChannel:
    """A channel, whether it was set manually, and its screws.

    Attributes:
        side: of the patient.
        channel: the cylinder.
        by_hand: whether a person set its ends, and not the measured pedicle.
        screws: none or one.
    """

    side: Side
    channel: Channel
    by_hand: bool = False
    screws: tuple[ScrewPlan, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class VertebraPlan:
    """One vertebra: reference slice, landmarks, and at most one pedicle and one channel on each side.

    Attributes:
        name: `L3`.
        references: none or one reference slice.
        pedicles: as measured and corrected.
        channels: one or two.
        landmarks: points to register by; names differ.

    Raises:
        PlanError: VERTEBRA_INVALID, its name is empty, or a side has two pedicles, channels or screws;
            LANDMARK_TWICE.
    """

    name: str
    references: tuple[ReferenceSlice, ...] = ()
    pedicles: tuple[PedicleRecord, ...] = ()
    channels: tuple[PlannedChannel, ...] = ()
    landmarks: tuple[Landmark, ...] = ()

    def __post_init__(self) -> None:
        sides = [record.measured.side for record in self.pedicles]
        ways = [planned.side for planned in self.channels]
        screws = max((len(planned.screws) for planned in self.channels), default=0)
        if (
            not self.name.strip()
            or len(set(sides)) < len(sides)
            or len(set(ways)) < len(ways)
            or len(self.references) > 1
            or screws > 1
        ):
            raise PlanError(
                "VERTEBRA_INVALID",
                f"vertebra '{self.name[:40]}' has pedicles {sides[:9]}, channels {ways[:9]}, "
                f"{len(self.references)} reference slices and up to {screws} screws to a channel; "
                "needed a name and at most one of each to a side",
                "Remove the duplicates.",
                {
                    "name": self.name[:40],
                    "pedicles": str(sides[:9]),
                    "channels": str(ways[:9]),
                    "references": len(self.references),
                    "screws": screws,
                },
            )
        reject_duplicate_names(self.landmarks)

    def pedicle(self, side: Side) -> PedicleRecord | None:
        """Return the pedicle of a side; None if it is not measured."""
        return next((one for one in self.pedicles if one.measured.side == side), None)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanDocument:
    """The whole plan: all instrumented vertebrae.

    Attributes:
        vertebrae: from the head down, or as they were planned; names differ.
        format_version: of the mapping that it is written as.

    Raises:
        PlanError: PLAN_INVALID, two vertebrae have the same name.
    """

    vertebrae: tuple[VertebraPlan, ...] = ()
    format_version: int = FORMAT_VERSION

    def __post_init__(self) -> None:
        names = [vertebra.name for vertebra in self.vertebrae]
        if len(set(names)) < len(names):
            # Every name of a usual plan, and a bound for a malicious one.
            listed = ", ".join(name[:40] for name in names[:30])[:MAX_LISTED_LENGTH]
            raise PlanError(
                "PLAN_INVALID",
                f"the plan names {len(names)} vertebrae, but only {len(set(names))} different ones: {listed}",
                "Give each vertebra its own name.",
                {
                    "vertebrae": len(names),
                    "different": len(set(names)),
                    "names": listed,
                },
            )

"""Messages about the plan."""

from collections.abc import Sequence
from typing import Annotated, Literal, TypeAlias

import numpy as np
from fastapi import Query
from pydantic import Field, StringConstraints

from server.api.case_messages import HeadingMessage, heading_message
from server.api.ct_messages import PointLps, mapping_of
from server.api.requester import MadeBy
from server.procedure.plan import Author, NoClearance, PlannedClearance, Proposal, StoredPlan
from server.stream.messages import Message
from server.texts import requested_language, worded
from tracker.navigation.clearance import WallSource
from tracker.plan import Landmark, PlanDocument, plan_to_mapping
from tracker.plan.document import plain
from tracker.plan.pedicle import Side

VertebraName: TypeAlias = Annotated[
    str,
    StringConstraints(strip_whitespace=True, min_length=1, max_length=40, pattern=r"^[^/\x00-\x1f\x7f]+$"),
]
Version: TypeAlias = Annotated[int, Field(ge=0, le=10**9)]
ExpectedVersion: TypeAlias = Annotated[Version | None, Query(alias="expected_version")]
Finite: TypeAlias = Annotated[float, Field(allow_inf_nan=False)]
PositiveMm: TypeAlias = Annotated[float, Field(gt=0.0, le=200.0, allow_inf_nan=False)]


class ChangeRequest(Message):
    """Author of a change, and the version it is based on."""

    made_by: MadeBy
    expected_version: Version | None = None
    """Version the change is based on, 0 for none; a newer version is a conflict. null: the newest."""

    @property
    def author(self) -> Author:
        """Return the author for the step."""
        return Author(made_by=self.made_by, expected_version=self.expected_version)


class PlanRequest(ChangeRequest):
    """A complete plan as returned by `GET /api/plan`."""

    plan: dict[str, object]


class VertebraRequest(ChangeRequest):
    """A vertebra to plan."""

    name: VertebraName


class SeedRequest(ChangeRequest):
    """A seed point in a pedicle."""

    seed_lps_mm: PointLps


class CorrectionsRequest(ChangeRequest):
    """Corrections of measured values."""

    corrected: Annotated[dict[str, Finite], Field(max_length=10)]
    """Keys: width_mm, height_mm, transverse_deg, sagittal_deg, length_mm; empty removes all corrections."""


class ChannelByHand(Message):
    """The ends of a channel."""

    entry_lps_mm: PointLps
    target_lps_mm: PointLps
    diameter_mm: Annotated[float, Field(gt=0.0, le=20.0, allow_inf_nan=False)]


class ChannelRequest(ChangeRequest):
    """A channel of the measured pedicle, or one by hand."""

    by_hand: ChannelByHand | None = None


class ScrewRequest(ChangeRequest):
    """A screw of the catalogue; default: the proposed one."""

    diameter_mm: PositiveMm | None = None
    length_mm: PositiveMm | None = None


class ReferenceRequest(ChangeRequest):
    """The reference slice of a vertebra."""

    slice_index: Annotated[int, Field(ge=0, le=100_000)] | None = None
    """From 0; default: the proposed one."""
    middle_lps_mm: PointLps | None = None
    """A point on the middle line; default: midpoint between the isthmuses."""
    apart_mm: Annotated[float, Field(gt=0.0, le=100.0, allow_inf_nan=False)]
    """Measured distance of the outer lines from the middle line."""


class LandmarkMessage(Message):
    """An anatomical landmark on the CT."""

    name: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=60)]
    point_lps_mm: PointLps


class LandmarksRequest(ChangeRequest):
    """All landmarks of a vertebra."""

    landmarks: Annotated[list[LandmarkMessage], Field(max_length=40)]

    @property
    def records(self) -> list[Landmark]:
        """Return the landmarks for the step."""
        return [Landmark(name=one.name, point_lps_mm=np.array(one.point_lps_mm)) for one in self.landmarks]


class ActiveChannelRequest(Message):
    """The active channel."""

    made_by: MadeBy
    vertebra: VertebraName
    side: Side


class ActiveChannelMessage(Message):
    """The active channel with its planned geometry."""

    vertebra: str
    side: Side
    channel: dict[str, object]


class PlanMessage(Message):
    """The plan of the open case."""

    heading: HeadingMessage
    """Includes its validity."""
    plan: dict[str, object]
    """Vertebrae with their reference slices, pedicles as measured and as corrected, channels and screws."""
    used: dict[str, dict[str, dict[str, object]]]
    """By vertebra and side: the pedicle with corrections applied."""
    active_channel: ActiveChannelMessage | None


class SliceProposalMessage(Message):
    """A proposed reference slice."""

    slice_index: int
    at_mm: float
    """Position of the axial slice, at its centre."""
    middle_lps_mm: list[float] | None
    """Midpoint between the isthmuses; null until both are measured."""


class ScrewProposalMessage(Message):
    """The proposed screw."""

    diameter_mm: float
    length_mm: float


class ScrewRangeMessage(Message):
    """A product line: every of its diameters in every of its lengths."""

    name: str
    diameters_mm: list[float]
    lengths_mm: list[float]


class CatalogueMessage(Message):
    """Screw catalogue of the settings: every diameter in every length."""

    diameters_mm: list[float]
    lengths_mm: list[float]
    ranges: list[ScrewRangeMessage]
    """Product lines by name, as in the settings; empty without any."""
    min_landmarks: int
    """Minimum number for a registration by landmarks."""


class ClearanceAlongMessage(Message):
    """Clearance by depth, where the wall is known."""

    kind: Literal["known"] = "known"
    against: WallSource
    depth_mm: list[float]
    """Along the screw from its entry, ascending."""
    clearance_mm: list[float]
    """From the screw's surface to the wall, the minimum around it; negative through the wall."""
    min_mm: float
    min_depth_mm: float
    """Depth of the minimum."""


class NoClearanceMessage(Message):
    """Why no clearance is known."""

    kind: Literal["absent"] = "absent"
    reason: NoClearance


class ChannelClearanceMessage(Message):
    """Clearance of the screw in one channel."""

    vertebra: str
    side: Side
    clearance: Annotated[ClearanceAlongMessage | NoClearanceMessage, Field(discriminator="kind")]


class ClearancesMessage(Message):
    """Clearance of each planned screw."""

    plan_id: str
    """Id of the plan's document."""
    margin_mm: float
    """Bone that a proposed screw leaves to each wall (plan.wall_margin_mm); less is to be marked."""
    channels: list[ChannelClearanceMessage]


def clearances_message(
    stored: StoredPlan, clearances: Sequence[PlannedClearance], *, margin_mm: float
) -> ClearancesMessage:
    """Return the message of the clearances of a plan."""
    return ClearancesMessage(
        plan_id=stored.document.id,
        margin_mm=margin_mm,
        channels=[
            ChannelClearanceMessage(vertebra=one.vertebra, side=one.side, clearance=_clearance(one))
            for one in clearances
        ],
    )


def _clearance(one: PlannedClearance) -> ClearanceAlongMessage | NoClearanceMessage:
    if isinstance(one.along, NoClearance):
        return NoClearanceMessage(reason=one.along)
    return ClearanceAlongMessage(
        against=one.against,
        depth_mm=one.along.depth_mm.round(3).tolist(),
        clearance_mm=one.along.clearance_mm.round(3).tolist(),
        min_mm=one.along.min_mm,
        min_depth_mm=one.along.min_depth_mm,
    )


def plan_message(stored: StoredPlan) -> PlanMessage:
    """Return the message of a plan."""
    active = stored.active
    return PlanMessage(
        heading=heading_message(stored.document, stored.validity),
        plan=mapping_of(worded(plan_to_mapping(stored.plan), requested_language())),
        used=_used(stored.plan),
        active_channel=None
        if active is None
        else ActiveChannelMessage(
            vertebra=active.vertebra, side=active.side, channel=mapping_of(plain(active.channel))
        ),
    )


def proposal_message(proposal: Proposal) -> SliceProposalMessage:
    """Return the message of a proposed slice."""
    middle = proposal.middle_lps_mm
    return SliceProposalMessage(
        slice_index=proposal.slice_index,
        at_mm=proposal.at_mm,
        middle_lps_mm=None if middle is None else list(middle),
    )


def _used(plan: PlanDocument) -> dict[str, dict[str, dict[str, object]]]:
    return {
        vertebra.name: {record.measured.side: mapping_of(plain(record.used)) for record in vertebra.pedicles}
        for vertebra in plan.vertebrae
    }

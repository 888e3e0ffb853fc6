"""What is asked and answered about the plan."""

from collections.abc import Mapping
from typing import Annotated, TypeAlias

import numpy as np
from pydantic import Field, StringConstraints

from server.api.case_messages import HeadingMessage, heading_message
from server.api.ct_messages import PointLps
from server.api.doing import MadeBy
from server.procedure.plan import Author, KeptPlan, Proposal
from server.stream.messages import Message
from tracker.plan import Landmark, PlanDocument, plan_to_mapping
from tracker.plan.document import plain
from tracker.plan.pedicle import Side

VertebraName: TypeAlias = Annotated[
    str,
    StringConstraints(strip_whitespace=True, min_length=1, max_length=40, pattern=r"^[^/\x00-\x1f\x7f]+$"),
]
Version: TypeAlias = Annotated[int, Field(ge=0, le=10**9)]
Finite: TypeAlias = Annotated[float, Field(allow_inf_nan=False)]
PositiveMm: TypeAlias = Annotated[float, Field(gt=0.0, le=200.0, allow_inf_nan=False)]


class ChangeRequest(Message):
    """Who changes the plan, and on which version."""

    made_by: MadeBy
    expected_version: Version | None = None
    """Of the plan that was looked at, 0 for none; another one in between is a conflict. Null: the newest."""

    @property
    def author(self) -> Author:
        """The same for the step."""
        return Author(made_by=self.made_by, expected_version=self.expected_version)


class PlanRequest(ChangeRequest):
    """A whole plan, as `GET /api/plan` answers it."""

    plan: dict[str, object]


class VertebraRequest(ChangeRequest):
    """A vertebra to be planned."""

    name: VertebraName


class SeedRequest(ChangeRequest):
    """A click into a pedicle."""

    seed_lps_mm: PointLps


class CorrectionsRequest(ChangeRequest):
    """Numbers in place of those that were measured."""

    corrected: Annotated[dict[str, Finite], Field(max_length=10)]
    """Of width_mm, height_mm, transverse_deg, sagittal_deg, length_mm; empty takes all corrections back."""


class ChannelByHand(Message):
    """The ends of a channel."""

    entry_lps_mm: PointLps
    target_lps_mm: PointLps
    diameter_mm: Annotated[float, Field(gt=0.0, le=20.0, allow_inf_nan=False)]


class ChannelRequest(ChangeRequest):
    """A channel of the measured pedicle, or one by hand."""

    by_hand: ChannelByHand | None = None


class ScrewRequest(ChangeRequest):
    """A screw of the catalogue; the proposed one if both are left out."""

    diameter_mm: PositiveMm | None = None
    length_mm: PositiveMm | None = None


class ReferenceRequest(ChangeRequest):
    """The slice that stands for a vertebra."""

    slice_index: Annotated[int, Field(ge=0, le=100_000)] | None = None
    """From 0; the proposed one if left out."""
    middle_lps_mm: PointLps | None = None
    """Where the middle line runs; half-way between the isthmuses if left out."""
    apart_mm: Annotated[float, Field(gt=0.0, le=100.0, allow_inf_nan=False)]
    """Distance of the outer lines from the middle one, as measured."""


class LandmarkMessage(Message):
    """A point on the bone that is set on the CT and found again on the patient."""

    name: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=60)]
    point_lps_mm: PointLps


class LandmarksRequest(ChangeRequest):
    """All landmarks of a vertebra."""

    landmarks: Annotated[list[LandmarkMessage], Field(max_length=40)]

    @property
    def records(self) -> list[Landmark]:
        """The same for the step."""
        return [Landmark(name=one.name, point_lps_mm=np.array(one.point_lps_mm)) for one in self.landmarks]


class ActiveChannelRequest(Message):
    """The channel that is to be drilled now."""

    made_by: MadeBy
    vertebra: VertebraName
    side: Side


class ActiveChannelMessage(Message):
    """The channel that is to be drilled now, as the plan has it."""

    vertebra: str
    side: Side
    channel: dict[str, object]


class PlanMessage(Message):
    """The plan of the open case."""

    heading: HeadingMessage
    """Whether it holds is told here."""
    plan: dict[str, object]
    """Vertebrae with their reference slices, pedicles as measured and as corrected, channels and screws."""
    used: dict[str, dict[str, dict[str, object]]]
    """By vertebra and side: the pedicle with its corrections worked in."""
    active_channel: ActiveChannelMessage | None


class SliceProposalMessage(Message):
    """The slice that may stand for a vertebra."""

    slice_index: int
    at_mm: float
    """Of the axial slice in the middle of it."""
    middle_lps_mm: list[float] | None
    """Half-way between the isthmuses; null while one of them is not measured."""


class ScrewProposalMessage(Message):
    """The screw that fits."""

    diameter_mm: float
    length_mm: float


class CatalogueMessage(Message):
    """What the settings give for planning: every diameter of screw in every length."""

    diameters_mm: list[float]
    lengths_mm: list[float]
    min_landmarks: int
    """That a registration by touched points needs."""


def plan_message(kept: KeptPlan) -> PlanMessage:
    """The plan, as it is told."""
    active = kept.active
    return PlanMessage(
        heading=heading_message(kept.document, kept.standing),
        plan=plan_to_mapping(kept.plan),
        used=_used(kept.plan),
        active_channel=None
        if active is None
        else ActiveChannelMessage(
            vertebra=active.vertebra, side=active.side, channel=_mapping(plain(active.channel))
        ),
    )


def proposal_message(proposal: Proposal) -> SliceProposalMessage:
    """A proposed slice, as it is told."""
    middle = proposal.middle_lps_mm
    return SliceProposalMessage(
        slice_index=proposal.slice_index,
        at_mm=proposal.at_mm,
        middle_lps_mm=None if middle is None else list(middle),
    )


def _used(plan: PlanDocument) -> dict[str, dict[str, dict[str, object]]]:
    return {
        vertebra.name: {record.measured.side: _mapping(plain(record.used)) for record in vertebra.pedicles}
        for vertebra in plan.vertebrae
    }


def _mapping(value: object) -> dict[str, object]:
    return dict(value) if isinstance(value, Mapping) else {}

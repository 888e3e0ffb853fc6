"""What is asked and answered about registration by needles."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, Self, TypeAlias

import numpy as np
from pydantic import Field, model_validator

from server.api.doing import MadeBy
from server.api.registration_messages import LandmarkName, VertebraName
from server.procedure.registered import Value
from server.procedure.registration.needle_picture import slice_in_image
from server.procedure.registration.needle_records import LaidSlice, NeedleOrder, ProposedSlice
from server.procedure.registration.needles import numbers_of
from server.stream.messages import Message
from tracker.plan import Volume
from tracker.registration.needles import MeasuredView, NeedleSeen, SliceOverlay, Standing, clicked_needle

Pixel: TypeAlias = Annotated[float, Field(ge=-20_000.0, le=20_000.0, allow_inf_nan=False)]
PixelPoint: TypeAlias = Annotated[list[Pixel], Field(min_length=2, max_length=2)]
Measured: TypeAlias = Annotated[float, Field(gt=0.0, le=5_000.0, allow_inf_nan=False)]
Spread: TypeAlias = Annotated[float, Field(gt=0.0, le=500.0, allow_inf_nan=False)]


class ViewMessage(Message):
    """What a ruler tells of a camera above and beside a patient who lies prone."""

    vertical_mm: Measured
    """V, how far the camera is above the vertebra."""
    horizontal_mm: Measured
    """H, how far it is beside it."""
    azimuth_deg: Annotated[float, Field(ge=-180.0, le=180.0)] = 0.0
    """Seen from above: 0 in line with the spine, positive to the left side."""
    standing: Standing = Standing.FEET
    """At which end of the patient the camera stands."""
    ruler_sd_mm: Spread = 10.0
    azimuth_sd_deg: Spread = 5.0
    level_sd_deg: Spread = 3.0
    lying_sd_deg: Spread = 5.0


class NeedlesRequest(Message):
    """Which needles, seen how."""

    view: ViewMessage
    vertebra: VertebraName | None = None
    """Its name in the plan; the one that is to be drilled if left out."""
    landmarks: Annotated[tuple[LandmarkName, ...], Field(max_length=6)] = ()
    """Where the needles go in; none takes the three lines of the reference slice."""
    radius_mm: Annotated[float, Field(gt=0.0, le=5.0)] = 0.8
    use_touched: bool = False
    """Whether the landmarks that were touched so far tell the depth, too."""

    @property
    def order(self) -> NeedleOrder:
        """The same for the step."""
        return NeedleOrder(
            vertebra=self.vertebra,
            landmarks=self.landmarks,
            measured=MeasuredView(**self.view.model_dump()),
            radius_mm=self.radius_mm,
        )


class OverlayMessage(Message):
    """Where the slice is laid."""

    shift_px: PixelPoint
    """Where in the image the middle of the needles lies."""
    turn_deg: Annotated[float, Field(ge=-360.0, le=360.0)] = 0.0
    """Clockwise in the image, from how the ruler has it."""
    scale_px_per_mm: Annotated[float, Field(ge=0.05, le=100.0)]
    fade_ratio: Annotated[float, Field(ge=0.0, le=1.0)] = 0.5

    @property
    def record(self) -> SliceOverlay:
        """The same for the step."""
        return SliceOverlay(
            shift_px=np.array(self.shift_px),
            turn_deg=self.turn_deg,
            scale_px_per_mm=self.scale_px_per_mm,
            fade_ratio=self.fade_ratio,
        )


class MarkedNeedleMessage(Message):
    """A needle that a person has marked in the image."""

    entry_px: PixelPoint
    """Where it comes out of the bone."""
    head_px: PixelPoint
    entry_is_seen: bool = True
    along_sd_px: Spread = 1.0
    """How well the end at the bone is known along the needle: less well where the software found it."""

    @property
    def record(self) -> NeedleSeen:
        """The same for the step; InvalidInput NEEDLE_SEEN_INVALID."""
        clicked = clicked_needle(self.entry_px, self.head_px, entry_is_seen=self.entry_is_seen)
        return replace(clicked, along_sd_px=self.along_sd_px)


class LaidRequest(NeedlesRequest):
    """The slice where a person has laid it."""

    overlay: OverlayMessage | None = None
    """Where the ruler has it, if left out."""
    marked: Annotated[tuple[MarkedNeedleMessage, ...], Field(max_length=6)] = ()
    """Needles, in the plan's order; how each lies beside its line is told."""


class NeedlesConclusion(LaidRequest):
    """How to register: by marked needles, or by the overlay."""

    made_by: MadeBy
    picked: bool = False
    """Whether the marked needles are a proposal that somebody picked in the picture: their order is sure."""

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if (self.overlay is None) == (not self.marked):
            raise ValueError(
                "give the overlay or the marked needles, and not both; a proposal is picked first"
            )
        if self.picked and not self.marked:
            raise ValueError("give the needles of the proposal that was picked as marked")
        return self


class NeedleMessage(Message):
    """One needle against the plan."""

    name: str
    line_px: list[list[float]]
    """Where its planned line runs in the image, from the bone outwards."""
    offset_px: float | None
    """From its place, after the fit; null where nothing was fitted."""
    offset_mm: float | None
    lean_deg: float | None
    beside_px: float | None
    """RMS distance of the needle from its line of the overlay; null where no needle was seen or marked."""
    beside_mm: float | None


class DirectionMessage(Message):
    """How well the needles' middle, or the vertebra about it, is known in one direction."""

    name: str
    sd: float
    unit: str
    not_from_image_ratio: float
    """Share of it that ruler and touched points gave."""
    is_weak: bool


class SlicePlaceMessage(Message):
    """Where the plan's picture of the reference slice lies in the image."""

    width_px: int
    """Of that picture before it is enlarged: the CT's own pixels."""
    height_px: int
    image_from_slice: list[list[float]]
    """3 rows of 3, a homography between pixels whose centres are whole numbers."""


class LaidMessage(Message):
    """The slice over the image, and what the needles say."""

    vertebra: str
    image_number: int
    overlay: OverlayMessage
    slice: SlicePlaceMessage | None
    """Null where needles stand on landmarks, and where nothing but the fit was asked for."""
    needles: list[NeedleMessage]
    directions: list[DirectionMessage]
    """Empty where nothing was fitted."""
    numbers: dict[str, Value]


def laid_message(laid: LaidSlice, volume: Volume | None = None) -> LaidMessage:
    """The slice over the image, as it is told; with the CT, where its picture lies, too."""
    lies = None if volume is None else slice_in_image(laid, volume)
    fit = laid.fit
    fitted = {} if fit is None else {one.name: one for one in fit.residuals}
    beside = {one.name: one for one in laid.residuals}
    needles = []
    for place, line in zip(laid.scene.places, laid.lines_px, strict=True):
        one, near = fitted.get(place.name), beside.get(place.name)
        needles.append(
            NeedleMessage(
                name=place.name,
                line_px=line.tolist(),
                offset_px=None if one is None else one.offset_px,
                offset_mm=None if one is None else one.offset_mm,
                lean_deg=None if one is None else one.lean_deg,
                beside_px=None if near is None else near.rms_px,
                beside_mm=None if near is None else near.rms_mm,
            )
        )
    directions = (
        [] if fit is None else [fit.sureness.depth, fit.sureness.across, fit.sureness.tilt, fit.sureness.turn]
    )
    return LaidMessage(
        vertebra=laid.scene.ground.vertebra.name,
        image_number=laid.scene.snapshot.image_number,
        overlay=OverlayMessage(
            shift_px=laid.overlay.shift_px.tolist(),
            turn_deg=laid.overlay.turn_deg,
            scale_px_per_mm=laid.overlay.scale_px_per_mm,
            fade_ratio=laid.overlay.fade_ratio,
        ),
        slice=None
        if lies is None
        else SlicePlaceMessage(width_px=lies[0][0], height_px=lies[0][1], image_from_slice=lies[1].tolist()),
        needles=needles,
        directions=[
            DirectionMessage(
                name=one.name,
                sd=one.sd,
                unit=one.unit,
                not_from_image_ratio=one.not_from_image_ratio,
                is_weak=one.is_weak,
            )
            for one in directions
        ],
        numbers={} if fit is None else numbers_of(laid, fit),
    )


class ProposalMessage(Message):
    """One likely way of naming the needles that were found; its spreads hold if it is the right one."""

    laid: LaidMessage
    marked: list[MarkedNeedleMessage]
    """The needles in the image, in the plan's order: for the conclusion, where this one is picked."""
    probability_ratio: float
    """0..1, how likely this one is among those that are proposed."""
    lead: float | None
    """By how much the likeliest other one is worse in chi squared; null where there is no other."""


class ProposalsMessage(Message):
    """The likely ways of naming the needles that were found, the likeliest first; a person picks."""

    proposals: list[ProposalMessage]


def proposals_message(proposed: Sequence[ProposedSlice]) -> ProposalsMessage:
    """The proposals, as they are told."""
    return ProposalsMessage(
        proposals=[
            ProposalMessage(
                laid=laid_message(one.laid),
                marked=[
                    MarkedNeedleMessage(
                        entry_px=seen.entry_px.tolist(),
                        head_px=seen.head_px.tolist(),
                        entry_is_seen=seen.entry_is_seen,
                        along_sd_px=seen.along_sd_px,
                    )
                    for seen in one.found
                ],
                probability_ratio=one.probability_ratio,
                lead=one.lead if math.isfinite(one.lead) else None,
            )
            for one in proposed
        ]
    )

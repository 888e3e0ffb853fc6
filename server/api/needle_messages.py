"""Messages of registration by needles."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, Self, TypeAlias

import numpy as np
from pydantic import Field, model_validator

from server.api.registration_messages import LandmarkName, VertebraName
from server.api.requester import MadeBy
from server.procedure.registration.needle_picture import slice_in_image
from server.procedure.registration.needle_records import NeedleRequest, PlacedSlice, ProposedSlice
from server.procedure.registration.needles import numbers_of
from server.procedure.registration_record import Value
from server.stream.messages import Message
from tracker.plan import Volume
from tracker.registration.needles import (
    NeedleObservation,
    PatientEnd,
    RulerMeasurement,
    SliceOverlay,
    needle_from_clicks,
)

Pixel: TypeAlias = Annotated[float, Field(ge=-20_000.0, le=20_000.0, allow_inf_nan=False)]
PixelPoint: TypeAlias = Annotated[list[Pixel], Field(min_length=2, max_length=2)]
Measured: TypeAlias = Annotated[float, Field(gt=0.0, le=5_000.0, allow_inf_nan=False)]
Spread: TypeAlias = Annotated[float, Field(gt=0.0, le=500.0, allow_inf_nan=False)]


class ViewMessage(Message):
    """Camera position relative to a prone patient, measured with a ruler."""

    vertical_mm: Measured
    """V: vertical distance from the vertebra to the camera."""
    horizontal_mm: Measured
    """H: horizontal distance from the vertebra to the camera."""
    azimuth_deg: Annotated[float, Field(ge=-180.0, le=180.0)] = 0.0
    """Azimuth seen from above: 0 along the spine, positive to the left side of the patient."""
    patient_end: PatientEnd = PatientEnd.FEET
    """End of the patient at which the camera stands."""
    ruler_sd_mm: Spread = 10.0
    azimuth_sd_deg: Spread = 5.0
    roll_sd_deg: Spread = 3.0
    prone_sd_deg: Spread = 5.0


class NeedlesRequest(Message):
    """Needles to register with, and the camera position."""

    view: ViewMessage
    vertebra: VertebraName | None = None
    """Name in the plan; default: the vertebra of the active channel."""
    landmarks: Annotated[tuple[LandmarkName, ...], Field(max_length=6)] = ()
    """Landmarks at which the needles enter; default: the three lines of the reference slice."""
    radius_mm: Annotated[float, Field(gt=0.0, le=5.0)] = 0.8
    use_touched: bool = False
    """Whether captured landmarks are used for the depth as well."""

    @property
    def order(self) -> NeedleRequest:
        """Return the request for the step."""
        return NeedleRequest(
            vertebra=self.vertebra,
            landmarks=self.landmarks,
            measured=RulerMeasurement(**self.view.model_dump()),
            radius_mm=self.radius_mm,
        )


class OverlayMessage(Message):
    """Placement of the slice overlay."""

    shift_px: PixelPoint
    """Image position of the centre of the needles."""
    rotation_deg: Annotated[float, Field(ge=-360.0, le=360.0)] = 0.0
    """Rotation relative to the ruler's estimate, clockwise in the image."""
    scale_px_per_mm: Annotated[float, Field(ge=0.05, le=100.0)]
    fade_ratio: Annotated[float, Field(ge=0.0, le=1.0)] = 0.5

    @property
    def record(self) -> SliceOverlay:
        """Return the overlay for the step."""
        return SliceOverlay(
            shift_px=np.array(self.shift_px),
            rotation_deg=self.rotation_deg,
            scale_px_per_mm=self.scale_px_per_mm,
            fade_ratio=self.fade_ratio,
        )


class OverlayQuery(ViewMessage):
    """A slice overlay as query parameters: the camera position, and what differs from its placement by it."""

    vertebra: VertebraName | None = None
    """Name in the plan; default: the vertebra of the active channel."""
    x_px: Pixel | None = None
    y_px: Pixel | None = None
    rotation_deg: Annotated[float, Field(ge=-360.0, le=360.0)] = 0.0
    scale_px_per_mm: Annotated[float | None, Field(ge=0.05, le=100.0)] = None
    fade_ratio: Annotated[float, Field(ge=0.0, le=1.0)] = 0.5

    @property
    def view(self) -> ViewMessage:
        """Return the camera position."""
        return ViewMessage(**self.model_dump(include=set(ViewMessage.model_fields)))

    def overlay_from(self, first: SliceOverlay) -> SliceOverlay:
        """Return the placement by the camera position, `first`, with what was requested instead."""
        x_px, y_px = first.shift_px
        return SliceOverlay(
            shift_px=np.array(
                [x_px if self.x_px is None else self.x_px, y_px if self.y_px is None else self.y_px]
            ),
            rotation_deg=self.rotation_deg,
            scale_px_per_mm=first.scale_px_per_mm if self.scale_px_per_mm is None else self.scale_px_per_mm,
            fade_ratio=self.fade_ratio,
        )


class MarkedNeedleMessage(Message):
    """A needle marked in the image."""

    entry_px: PixelPoint
    """Image point at which it enters the bone."""
    head_px: PixelPoint
    entry_is_seen: bool = True
    along_sd_px: Spread = 1.0
    """Standard deviation of the bone end along the needle; larger for a detected needle."""

    @property
    def record(self) -> NeedleObservation:
        """Return the observation for the step.

        Raises:
            InvalidInput: NEEDLE_SEEN_INVALID.
        """
        clicked = needle_from_clicks(self.entry_px, self.head_px, entry_is_seen=self.entry_is_seen)
        return replace(clicked, along_sd_px=self.along_sd_px)


class LaidRequest(NeedlesRequest):
    """Slice overlay placed by the user."""

    overlay: OverlayMessage | None = None
    """Default: the estimate from the ruler."""
    marked: Annotated[tuple[MarkedNeedleMessage, ...], Field(max_length=6)] = ()
    """Marked needles in the order of the plan; the response contains their residuals."""


class NeedlesConclusion(LaidRequest):
    """Registration by marked needles or by the overlay."""

    made_by: MadeBy
    picked: bool = False
    """Whether the marked needles are a confirmed proposal, so that their assignment is known."""

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if (self.overlay is None) == (not self.marked):
            raise ValueError("give either the overlay or the marked needles; confirm a proposal first")
        if self.picked and not self.marked:
            raise ValueError("give the needles of the confirmed proposal as marked")
        return self


class NeedleMessage(Message):
    """Residuals of one needle."""

    name: str
    line_px: list[list[float]]
    """Projection of its planned line, from the bone outwards."""
    offset_px: float | None
    """Residual at its entry after the fit; null without a fit."""
    offset_mm: float | None
    lean_deg: float | None
    beside_px: float | None
    """RMS distance of the needle from its line of the overlay; null without a needle."""
    beside_mm: float | None


class DirectionMessage(Message):
    """Uncertainty of the registration in one direction."""

    name: str
    sd: float
    unit: str
    not_from_image_ratio: float
    """Fraction of the information that comes from ruler and captured points."""
    is_weak: bool


class SlicePlaceMessage(Message):
    """Placement of the image of the reference slice."""

    width_px: int
    """Size of the slice in CT pixels."""
    height_px: int
    image_from_slice: list[list[float]]
    """3x3 homography; pixel centres are integers."""


class LaidMessage(Message):
    """Slice overlay and needle residuals."""

    vertebra: str
    image_number: int
    overlay: OverlayMessage
    slice: SlicePlaceMessage | None
    """null for needles at landmarks, and if only the fit was requested."""
    needles: list[NeedleMessage]
    directions: list[DirectionMessage]
    """Empty without a fit."""
    numbers: dict[str, Value]


def laid_message(laid: PlacedSlice, volume: Volume | None = None) -> LaidMessage:
    """Return the message of a slice overlay; with the CT it contains the placement of the slice."""
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
        []
        if fit is None
        else [
            fit.observability.depth,
            fit.observability.across,
            fit.observability.tilt,
            fit.observability.turn,
        ]
    )
    return LaidMessage(
        vertebra=laid.scene.context.vertebra.name,
        image_number=laid.scene.snapshot.image_number,
        overlay=OverlayMessage(
            shift_px=laid.overlay.shift_px.tolist(),
            rotation_deg=laid.overlay.rotation_deg,
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
    """A hypothesis for the assignment of detected needles; its uncertainties are conditional on it."""

    laid: LaidMessage
    marked: list[MarkedNeedleMessage]
    """Needles in the order of the plan, to be sent with the conclusion if this hypothesis is confirmed."""
    probability_ratio: float
    """Probability among the proposed hypotheses, 0 to 1."""
    delta_chi2: float | None
    """Delta chi-square to the best other hypothesis; null if there is no other."""


class ProposalsMessage(Message):
    """Assignment hypotheses, most probable first; the user selects one."""

    proposals: list[ProposalMessage]


def proposals_message(proposed: Sequence[ProposedSlice]) -> ProposalsMessage:
    """Return the message of the hypotheses."""
    return ProposalsMessage(
        proposals=[
            ProposalMessage(
                laid=laid_message(one.placed),
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
                delta_chi2=one.delta_chi2 if math.isfinite(one.delta_chi2) else None,
            )
            for one in proposed
        ]
    )

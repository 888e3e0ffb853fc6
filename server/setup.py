"""What stands before the first image: camera, markers, tools, plan and registration, from the settings."""

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from server.camera_file import read_camera_file
from server.capture.address import SourceKind, source_from_text
from server.capture.local_camera import CalibratedCamera
from server.config import Config
from server.marker_file import load_marker_image
from server.theatre import theatre_of
from server.tool_file import tool_from_config
from tracker.camera import CameraControl, CameraModel
from tracker.errors import CalibrationError
from tracker.marker import MarkerModel, ScoreSettings
from tracker.navigation import Absent, AbsentReason, DrillLimits, Guide, Setup
from tracker.navigation.clearance import choose_wall
from tracker.pipeline import Tracker
from tracker.plan import Channel
from tracker.pose import SteadySettings, ToolModel
from tracker.registration import AnchoredTo, Method, Registration

if TYPE_CHECKING:
    from tracker.plan import Surface
    from tracker.rehearsal import Theatre

# An ordinary lens: about 45 degrees across. It only helps to find the marker, no millimetre comes from it.
NOMINAL_FOCAL_BY_WIDTH = 1.2


class Unconfirmed(StrEnum):
    """Why nobody stands for a registration any more."""

    SERVER_STARTED = "server_started"  # it was made, checked and confirmed before this run of the server
    TRACKING_STARTED = "tracking_started"  # fixed to a camera that nobody watched for a while


def unconfirmed(
    registration: Registration, believed_from_s: float | None, *, tracked_from_s: float
) -> Unconfirmed | None:
    """Why a person has to confirm a registration before it is navigated by; None where nobody has to.

    Args:
        registration: of plan and patient.
        believed_from_s: when a person last touched, checked or confirmed it, by the images' clock; None
            where that was before this run of the server.
        tracked_from_s: since when the tracking process runs: what it watches for, it has watched since then.
    """
    if believed_from_s is None:
        return Unconfirmed.SERVER_STARTED
    is_loose = registration.anchored_to is AnchoredTo.CAMERA
    return Unconfirmed.TRACKING_STARTED if is_loose and believed_from_s < tracked_from_s else None


@dataclass(frozen=True, slots=True, kw_only=True)
class CaseSetup:
    """What the open case knows of camera, tools and plan; the rest stays as the settings have it.

    Attributes:
        camera: calibrated in this case.
        camera_controls, readout_ms: see `CameraFile`; of that calibration.
        latency_ms: from light to page, 99 % are within; None where it was not measured.
        models: markers whose picture was sent into this case.
        tools: calibrated in this case, by name.
        channel: the one that is to be drilled.
        registration: of that channel's vertebra.
        registered_from_s: when it was first touched or last checked; None where that was before this run.
        guide: what is known of that pedicle besides its channel.
        withheld: why no number may be given yet, although all is known.
        believed_from_s: see `unconfirmed`.
    """

    camera: CameraModel | None = None
    camera_controls: Mapping[CameraControl, int] = field(default_factory=dict)
    readout_ms: float | None = None
    latency_ms: float | None = None
    models: tuple[MarkerModel, ...] = ()
    tools: Mapping[str, ToolModel] = field(default_factory=dict)
    channel: Channel | None = None
    registration: Registration | None = None
    registered_from_s: float | None = None
    guide: Guide | None = None
    withheld: AbsentReason | None = None
    believed_from_s: float | None = None

    def tracked_from(self, tracked_from_s: float) -> "CaseSetup":
        """The same for a tracking process that runs since then: it may not know what happened before."""
        if self.registration is None or self.withheld is not None:
            return self
        why = unconfirmed(self.registration, self.believed_from_s, tracked_from_s=tracked_from_s)
        return self if why is None else replace(self, withheld=AbsentReason.NOT_CONFIRMED)


@dataclass(frozen=True, slots=True, kw_only=True)
class Preparation:
    """All that is known before the first image.

    Attributes:
        camera: the calibrated camera; None when there is no camera file.
        models: the markers to look for.
        tools: by name.
        channel: the planned channel, or why there is none.
        registration: of plan and patient, or why there is none.
        reference: name of the marker that is fixed to the patient; empty when there is none.
        score_settings: when a marker counts as found.
        max_tip_sd_mm, limits: see `tracker.navigation.Setup`.
        smoothing: how much poses are steadied.
        readout_s: from when the first row of an image is read to the last one; 0 of a global shutter.
        theatre: the rehearsal's, None for every other source.
        withheld, registered_from_s, latency_ms: see `CaseSetup`.
        guide: what is known of the pedicle besides its channel; None takes the channel alone.
        camera_controls: see `CaseSetup`; of the camera file, where the camera is that of the settings.
        same_sensor_area: images of all sizes show the same area of the sensor, as the settings say.
    """

    camera: CameraModel | None
    models: tuple[MarkerModel, ...]
    tools: Mapping[str, ToolModel]
    channel: Channel | Absent
    registration: Registration | Absent
    reference: str
    score_settings: ScoreSettings
    max_tip_sd_mm: float
    smoothing: SteadySettings = field(default_factory=SteadySettings)
    readout_s: float = 0.0
    theatre: "Theatre | None" = None
    withheld: AbsentReason | None = None
    registered_from_s: float | None = None
    latency_ms: float | None = None
    guide: Guide | None = None
    limits: DrillLimits = field(default_factory=DrillLimits)
    camera_controls: Mapping[CameraControl, int] = field(default_factory=dict)
    same_sensor_area: bool = False

    def guide_along(self, channel: Channel) -> Guide:
        """What a drill in this channel is held against: the case's bone, the rehearsal's, or the channel."""
        if self.guide is not None:
            return self.guide
        registration = self.registration
        is_known = isinstance(registration, Registration) and registration.method is Method.REHEARSAL
        if self.theatre is not None and is_known:
            return _rehearsed_guide(self.theatre)
        return Guide.of_channel(channel)

    @property
    def surface(self) -> "Surface | None":
        """The vertebra for the 3-D scene, if there is one."""
        return None if self.theatre is None else self.theatre.surface

    @property
    def calibrated_camera(self) -> CalibratedCamera | None:
        """What a camera is set to so that the calibration in use holds of it; None where there is none."""
        if self.camera is None:
            return None
        return CalibratedCamera(size_wh_px=self.camera.size_wh_px, controls=self.camera_controls)

    @property
    def setup(self) -> Setup | None:
        """The setup when the camera is calibrated; otherwise it waits for the size of the first image."""
        return None if self.camera is None else self._setup(self.camera, calibrated=True)

    def setup_for(self, size_wh_px: tuple[int, int], *, image: str | None = None) -> Setup:
        """The setup for images of this size, which `image` has, if that can be told.

        Raises:
            CalibrationError: CAMERA_SIZE_MISMATCH, the camera was calibrated at another size.
        """
        if self.camera is None:
            return self.uncalibrated_setup_for(size_wh_px)
        camera = camera_for_size(self.camera, size_wh_px, same_sensor_area=self.same_sensor_area, image=image)
        return self._setup(camera, calibrated=True)

    def uncalibrated_setup_for(self, size_wh_px: tuple[int, int]) -> Setup:
        """A setup that finds and labels markers, and claims no millimetre."""
        return self._setup(nominal_camera(size_wh_px), calibrated=False)

    def with_case(self, case: CaseSetup) -> "Preparation":
        """The same with what a case knows in the place of what the settings say.

        A channel of the case is not registered by what registered another. A marker of the settings stays
        what it is; a tool whose marker is not looked for is left out.
        """
        settled = {model.name for model in self.models}
        models = (*self.models, *(model for model in case.models if model.name not in settled))
        markers = {model.name for model in models}
        known = {name: tool for name, tool in case.tools.items() if tool.marker in markers}
        changed = replace(
            self,
            camera=case.camera or self.camera,
            camera_controls=self.camera_controls if case.camera is None else case.camera_controls,
            models=models,
            tools={**self.tools, **known},
            readout_s=self._readout_s(case.readout_ms),
            latency_ms=case.latency_ms,
        )
        if case.channel is None:
            return changed
        return replace(
            changed,
            channel=case.channel,
            registration=case.registration or Absent(reason=AbsentReason.NOT_REGISTERED),
            withheld=case.withheld,
            registered_from_s=case.registered_from_s,
            guide=case.guide,
        )

    def _readout_s(self, readout_ms: float | None) -> float:
        # The rehearsal's camera has a global shutter, whatever is said of a real one.
        return self.readout_s if readout_ms is None or self.theatre is not None else readout_ms / 1000.0

    def tracker_for(self, setup: Setup) -> Tracker:
        """A new tracker of these markers, which knows nothing of images before."""
        return Tracker(
            camera=setup.camera,
            models=self.models,
            settings=self.score_settings,
            clock=time.perf_counter,
            readout_s=self.readout_s,
        )

    def _setup(self, camera: CameraModel, *, calibrated: bool) -> Setup:
        return Setup(
            camera=camera,
            camera_calibrated=calibrated,
            tools=self.tools,
            channel=self.channel,
            registration=self.registration,
            reference=self.reference,
            screw=None if self.guide is None else self.guide.screw,
            side=None if self.guide is None else self.guide.side,
            withheld=self.withheld,
            max_tip_sd_mm=self.max_tip_sd_mm,
            limits=self.limits,
        )


def build_setup(config: Config) -> Preparation:
    """Everything that stands before the first image.

    Raises:
        NavigationError: a marker, tool or camera file cannot be used.
    """
    models = tuple(
        MarkerModel.from_image(load_marker_image(marker.image), side_mm=marker.side_mm, name=name)
        for name, marker in config.markers.items()
    )
    scores = ScoreSettings(**config.tracker.model_dump())
    smoothing = SteadySettings(**config.smoothing.model_dump())
    tools = {
        name: tool_from_config(name, tool, config.markers.get(tool.marker))
        for name, tool in config.tools.items()
    }
    calibration = config.camera.calibration
    camera = None if calibration is None else read_camera_file(calibration)
    bare = Preparation(
        camera=None if camera is None else camera.model,
        camera_controls={} if camera is None else camera.controls,
        same_sensor_area=config.camera.same_sensor_area,
        models=models,
        tools=tools,
        channel=Absent(reason=AbsentReason.NO_PLAN),
        registration=Absent(reason=AbsentReason.NOT_REGISTERED),
        reference=config.reference.marker or "",
        score_settings=scores,
        max_tip_sd_mm=config.limits.max_tip_sd_mm,
        limits=DrillLimits(
            warning_distance_mm=config.alarms.warning_distance_mm, breach_ratio=config.alarms.breach_ratio
        ),
        smoothing=smoothing,
        readout_s=(config.camera.readout_ms or (camera.readout_ms if camera else None) or 0.0) / 1000.0,
    )
    if source_from_text(config.camera.source).kind is SourceKind.REHEARSAL:
        theatre = theatre_of(config.rehearsal)
        brought = (theatre.marker,) if theatre.reference is None else (theatre.marker, theatre.reference)
        named = config.reference.marker or ("" if theatre.reference is None else theatre.reference.name)
        unknowing = replace(bare, models=(*brought, *models), theatre=theatre, reference=named, readout_s=0.0)
        return _with_what_it_brings(unknowing, theatre) if config.rehearsal.brings_setup else unknowing
    return bare


def _with_what_it_brings(unknowing: Preparation, theatre: "Theatre") -> Preparation:
    """All that the rehearsal's theatre knows of itself."""
    return replace(
        unknowing,
        camera=theatre.camera,
        tools={theatre.tool.name: theatre.tool, **unknowing.tools},
        channel=replace(theatre.channels[0], name=f"rehearsal's {theatre.channels[0].name}"),
        registration=Registration.known_to_reference(theatre.reference_from_vertebra)
        if theatre.reference is not None and unknowing.reference == theatre.reference.name
        else Registration.known_to_camera(theatre.camera_from_vertebra),
    )


@lru_cache(maxsize=1)
def _rehearsed_guide(theatre: "Theatre") -> Guide:
    """The bone of a theatre in software: known exactly."""
    radius_mm = theatre.tool.radius_mm
    return Guide(wall=choose_wall(theatre.channels[0], theatre.surface, None, radius_mm=radius_mm).wall)


def camera_for_size(
    camera: CameraModel, size_wh_px: tuple[int, int], *, same_sensor_area: bool, image: str | None = None
) -> CameraModel:
    """The calibrated camera for images of this size: as it is, or scaled where that is known to be exact.

    Args:
        camera: as it was calibrated.
        size_wh_px: of the images.
        same_sensor_area: images of all sizes show the same area of the sensor.
        image: which one has that size, if that can be told.

    Raises CalibrationError: CAMERA_SIZE_MISMATCH.
    """
    if camera.size_wh_px == tuple(size_wh_px):
        return camera
    has_aspect = camera.has_aspect_of(size_wh_px)
    if same_sensor_area and has_aspect:
        return camera.scaled_to(size_wh_px)
    (width, height), (width_file, height_file) = size_wh_px, camera.size_wh_px
    raise CalibrationError(
        "CAMERA_SIZE_MISMATCH",
        f"{'images are' if image is None else f'{image} is'} {width}x{height} px, but the camera was "
        f"calibrated at {width_file}x{height_file} px",
        ("" if image is None else "Leave the image out if another camera took it. ")
        + f"Set the camera to {width_file}x{height_file} px, or calibrate it at {width}x{height} px. "
        + (
            "If both sizes show the same scene to its very edges, say so with camera.same_sensor_area, and "
            "the calibration is scaled."
            if has_aspect
            else "To another ratio of width to height it is never scaled: another area is seen."
        ),
        {"image_size_wh_px": [width, height], "calibrated_size_wh_px": [width_file, height_file]},
    )


def nominal_camera(size_wh_px: tuple[int, int]) -> CameraModel:
    """A plausible camera for images of this size, when nothing is known of the real one."""
    width, height = size_wh_px
    focal = NOMINAL_FOCAL_BY_WIDTH * width
    return CameraModel(
        matrix=np.array([[focal, 0.0, (width - 1) / 2], [0.0, focal, (height - 1) / 2], [0.0, 0.0, 1.0]]),
        distortion=np.zeros(5),
        size_wh_px=(width, height),
    )

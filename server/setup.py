"""Setup of the tracker from the settings: camera, markers, tools, plan and registration."""

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
from server.theatre import theatre_from_config
from server.tool_file import tool_from_config
from tracker.camera import CameraControl, CameraModel
from tracker.errors import CalibrationError
from tracker.marker import MarkerModel, ScoreSettings
from tracker.navigation import (
    Absent,
    AbsentReason,
    DrillLimits,
    DrillReference,
    MeasuredLatency,
    PlacedScrew,
    Setup,
)
from tracker.navigation.clearance import select_wall
from tracker.pipeline import Tracker
from tracker.plan import Channel
from tracker.pose import ExternalTracker, SmoothingSettings, ToolModel
from tracker.registration import AnchoredTo, Method, Registration

if TYPE_CHECKING:
    from tracker.plan import Surface
    from tracker.rehearsal import Theatre

# An ordinary lens with a field of view of about 45 degrees. Used to detect markers, never for distances.
NOMINAL_FOCAL_BY_WIDTH = 1.2
# Id of the simulated CT of the rehearsal's vertebra, which is not a document of a case.
REHEARSAL_CT_ID = "rehearsal"


class ConfirmationReason(StrEnum):
    """Why a registration has to be confirmed."""

    SERVER_STARTED = "server_started"  # made, checked or confirmed before this run of the server
    TRACKING_STARTED = "tracking_started"  # relative to a camera that was not monitored meanwhile


def confirmation_reason(
    registration: Registration, confirmed_from_s: float | None, *, tracked_from_s: float
) -> ConfirmationReason | None:
    """Return why a registration has to be confirmed before navigation; None if it need not.

    Args:
        registration: Registration of plan and patient.
        confirmed_from_s: Time of its last capture, check or confirmation on the clock of the images; None if
            before this run of the server.
        tracked_from_s: Start of the tracking process, which monitors motion since then.
    """
    if confirmed_from_s is None:
        return ConfirmationReason.SERVER_STARTED
    is_loose = registration.anchored_to is AnchoredTo.CAMERA
    return ConfirmationReason.TRACKING_STARTED if is_loose and confirmed_from_s < tracked_from_s else None


@dataclass(frozen=True, slots=True, kw_only=True)
class CaseSetup:
    """Setup from the open case; it overrides the settings.

    Attributes:
        camera: Camera calibration of the case.
        camera_controls, camera_device, readout_ms: See `CameraFile`; of this calibration.
        latency: Latency from exposure to display; None if not measured.
        models: Markers of the case.
        tools: Tools calibrated in the case, by name.
        channel: The active channel.
        registration: Registration of its vertebra.
        registered_from_s: Time of its first capture or last check; None if before this run.
        drill_reference: Wall and screw of this pedicle, besides its channel.
        withheld: Why numbers are withheld although everything is known.
        confirmed_from_s: see `confirmation_reason`.
        ct_id: of the CT on which the channel was planned; empty if unknown.
        placed_screws: screws already placed in the vertebra of the active channel.
    """

    camera: CameraModel | None = None
    camera_controls: Mapping[CameraControl, int] = field(default_factory=dict)
    camera_device: str = ""
    readout_ms: float | None = None
    latency: MeasuredLatency | None = None
    models: tuple[MarkerModel, ...] = ()
    tools: Mapping[str, ToolModel] = field(default_factory=dict)
    channel: Channel | None = None
    registration: Registration | None = None
    registered_from_s: float | None = None
    drill_reference: DrillReference | None = None
    withheld: AbsentReason | None = None
    confirmed_from_s: float | None = None
    ct_id: str = ""
    placed_screws: tuple[PlacedScrew, ...] = ()

    def tracked_from(self, tracked_from_s: float) -> "CaseSetup":
        """Return the setup for a tracking process that monitors motion since this time only."""
        if self.registration is None or self.withheld is not None:
            return self
        why = confirmation_reason(self.registration, self.confirmed_from_s, tracked_from_s=tracked_from_s)
        return self if why is None else replace(self, withheld=AbsentReason.NOT_CONFIRMED)


@dataclass(frozen=True, slots=True, kw_only=True)
class Preparation:
    """Setup before the first image.

    Attributes:
        camera: The calibrated camera; None without a camera file.
        models: Markers to detect.
        tools: Tools by name.
        channel: The planned channel, or why there is none.
        registration: Registration of plan and patient, or why there is none.
        reference: Name of the patient marker; empty if there is none.
        score_settings: Acceptance thresholds of the marker detector.
        max_tip_sd_mm, limits: see `tracker.navigation.Setup`.
        smoothing: Smoothing of poses.
        readout_s: Readout time from the first to the last row; 0 for a global shutter.
        theatre: Theatre of the rehearsal; None for other sources.
        withheld, registered_from_s, latency: see `CaseSetup`.
        guide: Wall and screw of the pedicle besides its channel; None uses the channel only.
        camera_controls, camera_device: see `CaseSetup`; of the camera file, where the camera is that of the
            settings.
        same_sensor_area: Images of all sizes show the same area of the sensor (setting).
        ct_id: of the CT on which the channel was planned; empty if there is none.
        placed_screws: see `CaseSetup`.
        external: the external tracker; None for a camera.
    """

    camera: CameraModel | None
    models: tuple[MarkerModel, ...]
    tools: Mapping[str, ToolModel]
    channel: Channel | Absent
    registration: Registration | Absent
    reference: str
    score_settings: ScoreSettings
    max_tip_sd_mm: float
    smoothing: SmoothingSettings = field(default_factory=SmoothingSettings)
    readout_s: float = 0.0
    theatre: "Theatre | None" = None
    withheld: AbsentReason | None = None
    registered_from_s: float | None = None
    latency: MeasuredLatency | None = None
    drill_reference: DrillReference | None = None
    limits: DrillLimits = field(default_factory=DrillLimits)
    camera_controls: Mapping[CameraControl, int] = field(default_factory=dict)
    camera_device: str = ""
    same_sensor_area: bool = False
    ct_id: str = ""
    placed_screws: tuple[PlacedScrew, ...] = ()
    external: ExternalTracker | None = None

    def drill_reference_for(self, channel: Channel) -> DrillReference:
        """Return the drill reference of a channel: bone of the case, of the rehearsal, or the channel."""
        if self.drill_reference is not None:
            return self.drill_reference
        registration = self.registration
        is_known = isinstance(registration, Registration) and registration.method is Method.REHEARSAL
        if self.theatre is not None and is_known:
            return _rehearsal_drill_reference()
        return DrillReference.of_channel(channel)

    @property
    def surface(self) -> "Surface | None":
        """The vertebra of the 3-D scene; None if there is none."""
        return None if self.theatre is None else self.theatre.surface

    @property
    def calibrated_camera(self) -> CalibratedCamera | None:
        """Camera settings for which the calibration is valid; None without a calibration."""
        if self.camera is None:
            return None
        return CalibratedCamera(size_wh_px=self.camera.size_wh_px, controls=self.camera_controls)

    @property
    def setup(self) -> Setup | None:
        """The setup with a calibrated camera; None without one, because the image size is not known yet."""
        return None if self.camera is None else self._setup(self.camera, calibrated=True)

    def setup_for(self, size_wh_px: tuple[int, int], *, image: str | None = None, device: str = "") -> Setup:
        """Return the setup for images of this size.

        Args:
            size_wh_px: Size of the images.
            image: Name of the image for messages.
            device: `CameraStatus.device` of the camera; empty if unknown.

        Raises:
            CalibrationError: CAMERA_SIZE_MISMATCH, the camera was calibrated at another size; CAMERA_DIFFERS,
                another one was calibrated.
        """
        if self.external is not None:
            # A camera of this size only states the size of the blank picture.
            return replace(self._setup(nominal_camera(size_wh_px), calibrated=True), has_images=False)
        if self.camera is None:
            return self.uncalibrated_setup_for(size_wh_px)
        if device and self.camera_device and device != self.camera_device:
            raise CalibrationError(
                "CAMERA_DIFFERS",
                f"the camera '{self.camera_device}' was calibrated, but images come from '{device}'",
                "Connect the calibrated camera, or calibrate this one.",
                {"calibrated": self.camera_device, "camera": device},
            )
        camera = camera_for_size(self.camera, size_wh_px, same_sensor_area=self.same_sensor_area, image=image)
        return self._setup(camera, calibrated=True)

    def uncalibrated_setup_for(self, size_wh_px: tuple[int, int]) -> Setup:
        """Return a setup that detects and labels markers without distances."""
        return self._setup(nominal_camera(size_wh_px), calibrated=False)

    def with_case(self, case: CaseSetup) -> "Preparation":
        """Return this setup with the values of a case.

        A channel of the case only uses the registration of the case. Markers of the settings are not
        replaced; tools without a known marker are omitted, and with an external tracker all printed markers.
        """
        settled = {model.name for model in self.models}
        models = (*self.models, *(model for model in case.models if model.name not in settled))
        markers = {model.name for model in models}
        if self.external is not None:
            models, markers = (), set(self.external.bodies)
        known = {name: tool for name, tool in case.tools.items() if tool.marker in markers}
        changed = replace(
            self,
            camera=case.camera or self.camera,
            camera_controls=self.camera_controls if case.camera is None else case.camera_controls,
            camera_device=self.camera_device if case.camera is None else case.camera_device,
            models=models,
            tools={**self.tools, **known},
            readout_s=self._readout_s(case.readout_ms),
            latency=case.latency,
        )
        if case.channel is None:
            return changed
        return replace(
            changed,
            channel=case.channel,
            registration=case.registration or Absent(reason=AbsentReason.NOT_REGISTERED),
            withheld=case.withheld,
            registered_from_s=case.registered_from_s,
            drill_reference=case.drill_reference,
            ct_id=case.ct_id,
            placed_screws=case.placed_screws,
        )

    def _readout_s(self, readout_ms: float | None) -> float:
        # The camera of the rehearsal has a global shutter, independent of the settings.
        return self.readout_s if readout_ms is None or self.theatre is not None else readout_ms / 1000.0

    def tracker_for(self, setup: Setup) -> Tracker:
        """Create a tracker of these markers without history."""
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
            screw=None if self.drill_reference is None else self.drill_reference.screw,
            side=None if self.drill_reference is None else self.drill_reference.side,
            withheld=self.withheld,
            max_tip_sd_mm=self.max_tip_sd_mm,
            limits=self.limits,
            ct_id=self.ct_id,
            placed_screws=self.placed_screws,
        )


def drill_limits(config: Config) -> DrillLimits:
    """Return the limits of a drill that the settings have."""
    alarms = config.alarms
    return DrillLimits(warning_distance_mm=alarms.warning_distance_mm, breach_ratio=alarms.breach_ratio)


def build_setup(config: Config) -> Preparation:
    """Build the setup from the settings.

    Raises:
        NavigationError: a marker, tool or camera file cannot be used.
    """
    models = tuple(
        MarkerModel.from_image(load_marker_image(marker.image), side_mm=marker.side_mm, name=name)
        for name, marker in config.markers.items()
    )
    scores = ScoreSettings(**config.tracker.model_dump())
    smoothing = SmoothingSettings(**config.smoothing.model_dump())
    tools = {
        name: tool_from_config(name, tool, config.markers.get(tool.marker))
        for name, tool in config.tools.items()
    }
    calibration = config.camera.calibration
    camera = None if calibration is None else read_camera_file(calibration)
    bare = Preparation(
        camera=None if camera is None else camera.model,
        camera_controls={} if camera is None else camera.controls,
        camera_device="" if camera is None else camera.device,
        same_sensor_area=config.camera.same_sensor_area,
        models=models,
        tools=tools,
        channel=Absent(reason=AbsentReason.NO_PLAN),
        registration=Absent(reason=AbsentReason.NOT_REGISTERED),
        reference=config.reference.marker or "",
        score_settings=scores,
        max_tip_sd_mm=config.limits.max_tip_sd_mm,
        limits=drill_limits(config),
        smoothing=smoothing,
        readout_s=(config.camera.readout_ms or (camera.readout_ms if camera else None) or 0.0) / 1000.0,
    )
    kind, tracker = source_from_text(config.camera.source).kind, config.external_tracker
    if kind is SourceKind.OPENIGTLINK and tracker is not None:
        external = ExternalTracker(
            bodies=tuple(tracker.transforms), sd_mm=tracker.sd_mm, sd_deg=tracker.sd_deg
        )
        return replace(bare, camera=None, models=(), external=external)
    if kind is SourceKind.REHEARSAL:
        theatre = theatre_from_config(config.rehearsal)
        theatre_models = (
            (theatre.marker,) if theatre.reference is None else (theatre.marker, theatre.reference)
        )
        named = config.reference.marker or ("" if theatre.reference is None else theatre.reference.name)
        base = replace(
            bare, models=(*theatre_models, *models), theatre=theatre, reference=named, readout_s=0.0
        )
        return _with_theatre_setup(base, theatre) if config.rehearsal.provides_setup else base
    return bare


def _with_theatre_setup(base: Preparation, theatre: "Theatre") -> Preparation:
    """Return the setup with the ground truth of the theatre."""
    return replace(
        base,
        camera=theatre.camera,
        tools={theatre.tool.name: theatre.tool, **base.tools},
        ct_id=REHEARSAL_CT_ID,
        channel=replace(theatre.channels[0], name=f"rehearsal's {theatre.channels[0].name}"),
        registration=Registration.known_to_reference(theatre.reference_from_vertebra)
        if theatre.reference is not None and base.reference == theatre.reference.name
        else Registration.known_to_camera(theatre.camera_from_vertebra),
    )


@lru_cache(maxsize=1)
def _rehearsal_drill_reference() -> DrillReference:
    """Return the exact drill reference of the simulated vertebra, which is the same in each theatre."""
    from tracker.rehearsal.anatomy import pedicle_channels, vertebra_surface  # noqa: PLC0415  rehearsals only
    from tracker.rehearsal.theatre import DRILL_RADIUS_MM  # noqa: PLC0415

    channel = pedicle_channels()[0]
    return DrillReference(wall=select_wall(channel, vertebra_surface(), None, radius_mm=DRILL_RADIUS_MM).wall)


def camera_for_size(
    camera: CameraModel, size_wh_px: tuple[int, int], *, same_sensor_area: bool, image: str | None = None
) -> CameraModel:
    """Return the camera model for images of this size: unchanged, or scaled if scaling is exact.

    Args:
        camera: The calibrated camera.
        size_wh_px: Size of the images.
        same_sensor_area: Images of all sizes show the same area of the sensor.
        image: Name of the image for messages; None if unknown.

    Raises CalibrationError: CAMERA_SIZE_MISMATCH.
    """
    if camera.size_wh_px == tuple(size_wh_px):
        return camera
    has_aspect = camera.has_aspect_of(size_wh_px)
    if same_sensor_area and has_aspect:
        return camera.scaled_to(size_wh_px)
    (width, height), (width_file, height_file) = size_wh_px, camera.size_wh_px
    subject = "images are" if image is None else f"{image} is"
    omit = "" if image is None else "Omit the image if it is from another camera. "
    scaling = (
        "If both sizes show the same field of view, set camera.same_sensor_area, and the calibration is "
        "scaled."
        if has_aspect
        else "It is never scaled to another aspect ratio, because the field of view differs."
    )
    raise CalibrationError(
        "CAMERA_SIZE_MISMATCH",
        f"{subject} {width}x{height} px, but the camera was calibrated at {width_file}x{height_file} px",
        f"{omit}Set the camera to {width_file}x{height_file} px, or calibrate it at {width}x{height} px. "
        f"{scaling}",
        {
            "image_size_wh_px": [width, height],
            "calibrated_size_wh_px": [width_file, height_file],
            "image_subject": subject,
            "omit_hint": omit,
            "scaling_hint": scaling,
        },
    )


def nominal_camera(size_wh_px: tuple[int, int]) -> CameraModel:
    """Return a nominal camera for images of this size, for uncalibrated cameras."""
    width, height = size_wh_px
    focal = NOMINAL_FOCAL_BY_WIDTH * width
    return CameraModel(
        matrix=np.array([[focal, 0.0, (width - 1) / 2], [0.0, focal, (height - 1) / 2], [0.0, 0.0, 1.0]]),
        distortion=np.zeros(5),
        size_wh_px=(width, height),
    )

"""The settings of config.yaml with their allowed ranges.

Each limit is defined only here; screen, overlay and alarm read the same field. `server.config_file` loads a
file into these records and reports its errors.
"""

from pathlib import Path
from typing import Annotated, Literal, TypeAlias

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StringConstraints

from server.field_descriptions import FieldDescriptions

Ratio: TypeAlias = Annotated[float, Field(ge=0.0, le=1.0)]
Strength: TypeAlias = Annotated[float, Field(ge=0.0, le=10.0)]
Millimetres: TypeAlias = Annotated[float, Field(ge=-10_000.0, le=10_000.0)]
Point: TypeAlias = Annotated[list[Millimetres], Field(min_length=3, max_length=3)]
Name: TypeAlias = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]{0,39}$")]
FilePath: TypeAlias = Annotated[Path, Field(strict=False)]


class Section(FieldDescriptions, BaseModel):
    """Base of all settings: unknown keys are rejected, values are not converted, instances are frozen."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


class TlsConfig(Section):
    """TLS certificate; without one, the server creates a self-signed certificate if it needs one."""

    certificate: FilePath | None = None
    """PEM, including intermediate certificates."""
    key: FilePath | None = None
    """PEM, not encrypted."""


class ServerConfig(Section):
    """Address and TLS of the server."""

    host: Annotated[str, StringConstraints(min_length=1)] = "127.0.0.1"
    """Address to listen on; 127.0.0.1 accepts connections from this computer only."""
    port: Annotated[int, Field(ge=0, le=65535)] = 8000
    """0 selects a free port."""
    tls: TlsConfig = TlsConfig()
    behind_proxy: Literal["a proxy speaks TLS for this server"] | None = None
    """Exactly this text switches TLS off on all addresses."""


def _written_off(value: object) -> object:
    """YAML reads an unquoted off as false."""
    return "off" if value is False else value


class SecurityConfig(Section):
    """Sign-in and length of sessions."""

    sign_in: Annotated[Literal["required", "off"], BeforeValidator(_written_off)] = "required"
    """off: full access for everybody; allowed on loopback only."""
    session_h: Annotated[float, Field(gt=0.0, le=168.0)] = 12
    """Length of a session in hours, unless the invitation sets another one."""


class CameraConfig(Section):
    """Source of images."""

    name: Name = "main"
    source: Annotated[int, Field(ge=0, le=99)] | Annotated[str, StringConstraints(min_length=1)] = "rehearsal"
    """rehearsal, openigtlink (an external tracker), phone, number or path of a local camera, basler:SERIAL,
    genicam:SERIAL, a video file, a stream URL, a folder of images, or plugin:NAME:ADDRESS."""
    calibration: FilePath | None = None
    """Camera file (YAML or JSON) with matrix, distortion and size_wh_px."""
    loop: bool = True
    """Restart a video file or folder at its end."""
    rate: Literal["own", "fast"] = "own"
    """own: play a file at its own rate; fast: as fast as the tracker, without skipping images."""
    playback_speed: Annotated[float, Field(ge=0.1, le=1.0)] = 1.0
    """Fraction of its own rate at which a file is played. More slowly, figures would become stale."""
    width: Annotated[int, Field(ge=16, le=7680)] | None = None
    """Requested from a local camera, together with height; default: selected from its modes."""
    height: Annotated[int, Field(ge=16, le=4320)] | None = None
    rate_hz: Annotated[float, Field(gt=0.0, le=1000.0)] | None = None
    """Requested from a local camera; also the rate of a folder, or of a file without one (default 30)."""
    same_sensor_area: bool = False
    """All image sizes of one aspect ratio show the same area of the sensor, so that a calibration may be
    scaled."""
    lock_controls: bool = True
    """Local camera: restore focus, zoom, pan and tilt of the calibration and switch autofocus off; without a
    calibration, after it has settled."""
    lock_light: bool = False
    """Switch automatic exposure and white balance off after they have settled."""
    trigger: Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9]{0,39}$")] | None = None
    """Trigger input of an industrial camera, as line1; default: free run."""
    readout_ms: Annotated[float, Field(ge=0.0, le=200.0)] = 0.0
    """Readout time of a rolling shutter, from the first to the last row; 0 for a global shutter."""


BodyName: TypeAlias = Annotated[
    str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*To[A-Z][A-Za-z0-9_-]*$", max_length=20)
]


class ExternalTrackerConfig(Section):
    """An external tracker behind Plus, whose poses come by OpenIGTLink in place of images of a camera."""

    host: Annotated[str, StringConstraints(min_length=1)] = "127.0.0.1"
    """Address of the server of Plus."""
    port: Annotated[int, Field(ge=1, le=65535)] = 18944
    unencrypted: Literal["anybody on this network can change the poses"] | None = None
    """Exactly this text allows a host that is not loopback."""
    transforms: Annotated[list[BodyName], Field(min_length=2, max_length=8)]
    """Names of the transforms, each from a rigid body to the tracker, as DrillToTracker. The tools and the
    reference name them as their markers."""
    sd_mm: Annotated[float, Field(gt=0.0, le=10.0)]
    """Standard deviation of the position of a body along each axis."""
    sd_deg: Annotated[float, Field(gt=0.0, le=10.0)]
    """Standard deviation of the rotation of a body about each axis."""
    latency_ms: Annotated[float, Field(gt=0.0, le=500.0)]
    """Time from a measurement to the arrival of the fastest message."""


class RehearsalEventConfig(Section):
    """A simulated fault at a known time."""

    kind: Literal[
        "camera_moves",
        "patient_moves",
        "drill_jumps",
        "drill_occluded",
        "reference_occluded",
        "camera_stops",
        "camera_stalls",
    ]
    at_s: Annotated[float, Field(ge=0.0, le=100_000.0)]
    """Time since the start of the scene."""
    lasts_s: Annotated[float, Field(gt=0.0, le=100_000.0)] | None = None
    """Duration; default: permanent."""
    every_s: Annotated[float, Field(gt=0.0, le=100_000.0)] | None = None
    """Period of repetition; default: once."""
    size_mm: Annotated[float, Field(ge=0.0, le=60.0)] = 12.0
    size_deg: Annotated[float, Field(ge=0.0, le=20.0)] = 2.0


RehearsalScene: TypeAlias = Literal["operation", "pivot", "spin", "board", "landmarks", "sweep", "check"]
RehearsalSkill: TypeAlias = Literal["wandering", "good", "breaching"]
RehearsalBoard: TypeAlias = Literal["dots", "checkerboard", "charuco", "aprilgrid"]


class RehearsalConfig(Section):
    """The simulated operating theatre."""

    seed: Annotated[int, Field(ge=0, le=2**31 - 1)] = 1
    width: Annotated[int, Field(ge=160, le=3840)] = 1280
    height: Annotated[int, Field(ge=120, le=2160)] = 720
    rate_hz: Annotated[float, Field(gt=0.0, le=120.0)] = 30.0
    noise: Strength = 1.0
    blur: Strength = 1.0
    clutter: Strength = 1.0
    light: Annotated[float, Field(gt=0.0, le=10.0)] = 1.0
    scene: RehearsalScene = "operation"
    """operation: drilling; pivot: tilting about the tip; spin: rotation about the axis; board: camera
    calibration; landmarks, sweep, check: the tip on landmarks, on the bone surface, on the check landmark."""
    skill: RehearsalSkill = "wandering"
    """Drilling in the operation: drifts off by millimetres, follows the channel, or breaches the wall."""
    rest_s: Annotated[float, Field(ge=0.5, le=60.0)] = 3.0
    """Dwell time of the tip on a landmark."""
    reference: bool = False
    """Add a marker on the patient."""
    events: Annotated[list[RehearsalEventConfig], Field(max_length=20)] = []
    """Simulated faults."""
    board: RehearsalBoard = "dots"
    """The calibration board in the scene."""
    provides_setup: bool = True
    """false: camera, tool, plan and registration have to be set up first."""


class MarkerConfig(Section):
    """A printed marker: its image, filled edge to edge by the black square, and its side."""

    image: FilePath
    side_mm: Annotated[float, Field(gt=0.0, le=1000.0)]


class ToolConfig(Section):
    """A drill or awl with a marker, defined by its drawing or by a tool file."""

    marker: Name
    calibration: FilePath | None = None
    """Tool file of `coaxial pivot` and `coaxial spin`; replaces tip_in_marker_mm."""
    tip_in_marker_mm: Point | None = None
    axis_in_marker: Point | None = None
    """Direction from the marker to the tip."""
    radius_mm: Annotated[float, Field(gt=0.0, le=50.0)]
    length_mm: Annotated[float, Field(gt=0.0, le=1000.0)]


class ReferenceConfig(Section):
    """The marker on the patient."""

    marker: Name | None = None
    """Its name under markers; without one, motion of patient or camera may go undetected."""


class ToolCalibrationConfig(Section):
    """Limits for tool calibration and tip check."""

    max_rms_3d_mm: Annotated[float, Field(gt=0.0, le=100.0)] = 0.8
    """3-D RMS of the tip about the pivot, for pivot calibration and tip check."""
    max_tip_sd_mm: Annotated[float, Field(gt=0.0, le=100.0)] = 0.8
    """Largest standard deviation of the tip over all directions."""
    min_tilt_deg: Annotated[float, Field(ge=5.0, le=120.0)] = 15.0
    """Tilt range about each of two perpendicular axes."""
    min_poses: Annotated[int, Field(ge=6, le=10_000)] = 10
    min_used_ratio: Annotated[float, Field(ge=0.5, le=1.0)] = 0.6
    """Fraction of inliers among the poses."""
    min_spin_deg: Annotated[float, Field(ge=20.0, le=360.0)] = 60.0
    max_wobble_deg: Annotated[float, Field(gt=0.0, le=45.0)] = 5.0
    """RMS angle of the axis during the rotation."""
    max_axis_sd_deg: Annotated[float, Field(gt=0.0, le=45.0)] = 0.5


class RegistrationConfig(Section):
    """Limits that a registration and its check must meet before navigation starts."""

    min_points: Annotated[int, Field(ge=3, le=40)] = 3
    """Number of landmarks; three cannot show a wrong one, and their stated error then exceeds max_tre_mm."""
    max_fre_mm: Annotated[float, Field(gt=0.0, le=20.0)] = 1.5
    """Fiducial registration error (FRE, RMS)."""
    max_tre_mm: Annotated[float, Field(gt=0.0, le=20.0)] = 2.0
    """Stated target registration error (TRE, 3-D RMS) at the entry point of every channel of the vertebra."""
    max_left_out_mm: Annotated[float, Field(gt=0.0, le=50.0)] = 5.0
    """Leave-one-out error of any landmark; if others cannot exclude one of this size, it is stated."""
    capture_images: Annotated[int, Field(ge=3, le=300)] = 12
    """Consecutive images with the tip visible and at rest on a landmark."""
    capture_s: Annotated[float, Field(ge=0.05, le=10.0)] = 0.4
    """Minimum duration of these images, so that they sample the tremor of the hand."""
    max_capture_gap_s: Annotated[float, Field(ge=0.05, le=10.0)] = 1.0
    """Upper bound of the gap between two of them, which is six image periods and at least 0.25 s."""
    max_capture_sd_mm: Annotated[float, Field(gt=0.0, le=20.0)] = 0.4
    """Standard deviation of the tip in these images, along its worst axis."""
    max_surface_rms_mm: Annotated[float, Field(gt=0.0, le=20.0)] = 1.0
    """RMS distance of a sweep from the bone surface."""
    max_nudge_mm: Annotated[float, Field(ge=0.0, le=20.0)] = 5.0
    """Total manual correction, measured between the entry points."""
    max_nudge_deg: Annotated[float, Field(ge=0.0, le=20.0)] = 5.0
    check_required: bool = True
    """false: allow navigation without a check on a landmark."""
    max_check_mm: Annotated[float, Field(gt=0.0, le=20.0)] = 2.0
    """Distance of the tip from the planned landmark in the check."""
    check_again_after_min: Annotated[float, Field(ge=1.0, le=1440.0)] = 30
    """The check is due again after this time; navigation continues."""
    moved_after_s: Annotated[float, Field(ge=0.1, le=60.0)] = 1.0
    """The registration is withdrawn when camera or reference has moved for this long."""


class TrackerConfig(Section):
    """Acceptance thresholds of the marker detector."""

    accept_score_ratio: Ratio = 0.7
    accept_target_score_ratio: Ratio = 0.55
    accept_inner_coverage_ratio: Ratio = 0.6
    verified_threshold_ratio: Ratio = 0.6
    fit_error_weight: Ratio = 0.25


class SmoothingConfig(Section):
    """Smoothing of poses: mean over the last images while they agree; the lag is shown."""

    lag_ms: Annotated[float, Field(ge=0.0, le=500.0)] = 0
    """Maximum lag of a smoothed pose; 0 switches smoothing off."""
    near_wall: bool = False
    """Also smooth near the wall of the channel."""
    near_wall_mm: Annotated[float, Field(ge=0.0, le=100.0)] = 3.0
    """Distance between the drill at its tip and the surface of the channel that counts as near."""


class CalibrationConfig(Section):
    """Limits for a camera calibration."""

    max_rms_px: Annotated[float, Field(gt=0.0, le=100.0)] = 1.0
    """RMS reprojection error."""
    max_error_mm: Annotated[float, Field(gt=0.0, le=100.0)] = 0.5
    """Error of a known displacement in an accuracy check."""


class LimitsConfig(Section):
    """Age and uncertainty limits; beyond them no numbers are shown."""

    pose_stale_after_ms: Annotated[float, Field(ge=20.0, le=10_000.0)] = 150
    video_stale_after_ms: Annotated[float, Field(ge=20.0, le=10_000.0)] = 500
    scene_stale_after_ms: Annotated[float, Field(ge=20.0, le=10_000.0)] = 500
    max_tip_sd_mm: Annotated[float, Field(ge=0.1, le=100.0)] = 3.0


class AlarmsConfig(Section):
    """Alarm limits; a missing image raises an alarm after `limits.video_stale_after_ms`."""

    warning_distance_mm: Annotated[float, Field(ge=0.0, le=20.0)] = 1.0
    """Bone between the drill and the pedicle wall."""
    hysteresis_mm: Annotated[float, Field(ge=0.05, le=1.0)] = 0.3
    """An alarm clears when the distance exceeds its limit by this."""
    breach_ratio: Annotated[float, Field(ge=0.01, lt=1.0)] = 0.05
    """Probability of a breach."""
    breach_hysteresis_ratio: Annotated[float, Field(ge=0.0, lt=1.0)] = 0.02
    realarm_after_mm: Annotated[float, Field(ge=0.1, le=20.0)] = 1.0
    """An acknowledged breach sounds again when it deepens by this."""
    drill_unseen_after_ms: Annotated[float, Field(ge=100.0, le=60_000.0)] = 1000
    reference_unseen_after_ms: Annotated[float, Field(ge=100.0, le=60_000.0)] = 1000
    put_away_after_s: Annotated[float, Field(ge=5.0, le=3600.0)] = 120
    """A drill unseen for longer counts as put away."""
    screen_lost_after_s: Annotated[float, Field(ge=3.0, le=600.0)] = 6
    """A screen with armed sound that does not report for this long is lost."""
    min_free_disk_mb: Annotated[float, Field(ge=0.0, le=1e7)] = 2000


class VideoConfig(Section):
    """The encoded video."""

    jpeg_quality: Annotated[int, Field(ge=1, le=100)] = 80
    language: Literal["en", "de"] = "en"
    """Language of the video overlay; the page uses the language of the browser."""
    max_viewers: Annotated[int, Field(ge=1, le=10_000)] = 64
    """Simultaneous viewers of the video; the 3-D scene has the same number in addition."""


DeviceName: TypeAlias = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_-]{0,9}$")]
FrameName: TypeAlias = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_-]{0,7}$")]


class OpenIgtLinkConfig(Section):
    """Poses for other programs by OpenIGTLink, which knows neither encryption nor sign-in."""

    port: Annotated[int, Field(ge=0, le=65535)] | None = None
    """18944 is the standard port, 0 selects a free port; default: off."""
    host: Annotated[str, StringConstraints(min_length=1)] = "127.0.0.1"
    unencrypted: Literal["anybody who reaches this port reads the poses"] | None = None
    """Exactly this text allows a host that is not loopback."""
    coordinates: Literal["RAS", "LPS"] = "RAS"
    """Axes of the vertebra's frame; 3D Slicer takes poses for RAS."""
    header_version: Literal[1, 2] = 1
    """1 is read by every client; 2 adds metadata."""
    max_rate_hz: Annotated[float, Field(ge=1.0, le=240.0)] = 60
    """Maximum rate per client; above it only the newest images are sent."""
    max_clients: Annotated[int, Field(ge=1, le=32)] = 4
    camera_frame: FrameName = "Camera"
    vertebra_frame: FrameName = "Vertebra"
    tool_names: dict[Name, DeviceName] = {}
    """Names of tools in message names, at most 10 characters; default: the name of the tool."""


AeTitle: TypeAlias = Annotated[str, StringConstraints(pattern=r"^[!-\[\]-~]([ -\[\]-~]{0,14}[!-\[\]-~])?$")]


class DicomArchiveConfig(Section):
    """The archive that `coaxial plan send` sends to."""

    host: Annotated[str, StringConstraints(min_length=1)] | None = None
    port: Annotated[int, Field(ge=1, le=65535)] = 104
    ae_title: AeTitle = "ARCHIVE"
    tls: bool = False
    ca: FilePath | None = None
    """PEM with the authority of the archive's certificate; default: those of this system."""


class DicomReceiveConfig(Section):
    """Reception of CTs from scanners and archives (C-STORE)."""

    port: Annotated[int, Field(ge=0, le=65535)] | None = None
    """11112 is usual, 0 selects a free port; default: off."""
    host: Annotated[str, StringConstraints(min_length=1)] = "127.0.0.1"
    allowed_ae_titles: list[AeTitle] = []
    """AE titles of those who may send; at least one."""
    tls: bool = False
    """With the certificate of `server.tls`, or a self-signed one."""
    client_ca: FilePath | None = None
    """PEM with the authority of the certificates that senders must have; default: they need none."""
    unencrypted: Literal["anybody on this network reads the patients' data"] | None = None
    """Exactly this text allows a host that is not loopback without TLS."""
    max_gb: Annotated[float, Field(gt=0.0, le=1000.0)] = 10
    """All series that wait."""
    max_series: Annotated[int, Field(ge=1, le=1000)] = 20
    max_age_h: Annotated[float, Field(gt=0.0, le=720.0)] = 24
    """Since the last slice of a series, after which it is deleted."""


class DicomConfig(Section):
    """DICOM network."""

    ae_title: AeTitle = "COAXIAL"
    """Own AE title."""
    receive: DicomReceiveConfig = DicomReceiveConfig()
    archive: DicomArchiveConfig = DicomArchiveConfig()


class CosignConfig(Section):
    """Documents that a second person signs. required: navigation waits for it; offered: it is optional.

    An operator could invite themselves as a second person. A signature states who invited the signer, but
    cannot exclude this.
    """

    plan: Literal["required", "offered"] = "offered"
    registration: Literal["required", "offered"] = "offered"


class SupervisionConfig(Section):
    """Remote supervision."""

    cosign: CosignConfig = CosignConfig()
    drawings_fade_after_s: Annotated[float, Field(ge=2.0, le=600.0)] = 20
    """Measured from the capture time of the annotated image, because patient and camera move."""


ScrewDiameters: TypeAlias = Annotated[
    list[Annotated[float, Field(gt=0.0, le=20.0)]], Field(min_length=1, max_length=100)
]
ScrewLengths: TypeAlias = Annotated[
    list[Annotated[float, Field(gt=0.0, le=150.0)]], Field(min_length=1, max_length=100)
]


class ScrewRangeConfig(Section):
    """A product line of screws, whose name the page shows beside a size that it offers."""

    name: Annotated[str, Field(min_length=1, max_length=60)]
    diameters_mm: ScrewDiameters
    lengths_mm: ScrewLengths


class PlanConfig(Section):
    """Available screws and their margins."""

    screw_diameters_mm: ScrewDiameters = [4.0, 4.5, 5.0, 5.5, 6.0, 6.5, 7.0, 7.5, 8.5]
    screw_lengths_mm: ScrewLengths = [25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0]
    screw_ranges: Annotated[list[ScrewRangeConfig], Field(max_length=50)] = []
    """Product lines by name; their sizes must be among those above."""
    wall_margin_mm: Annotated[float, Field(ge=0.0, le=10.0)] = 0.5
    front_margin_mm: Annotated[float, Field(ge=0.0, le=50.0)] = 5.0


class RecordingConfig(Section):
    """Recordings of images, results and alarms in the folder of the case."""

    when: Literal["navigating", "manual", "never"] = "manual"
    """navigating: from the first figures until navigation ends or the case is closed; manual: on request."""
    max_total_gb: Annotated[float, Field(gt=0.0, le=100_000.0)] = 200
    """Limit for all recordings of all cases; a recording that would exceed it is stopped."""
    rotate: bool = False
    """Before a recording, delete the oldest unprotected ones until a fifth of max_total_gb is free."""
    min_free_gb: Annotated[float, Field(ge=0.0, le=100_000.0)] = 2
    """Free space on the disk at which a recording is stopped."""
    consent: Literal["required", "not_required"] = "required"
    """required: nothing is recorded until the patient's consent is stated in the case."""


class PluginsConfig(Section):
    """Installed plug-ins that are loaded, besides the one of `camera.source`."""

    sinks: Annotated[list[Name], Field(max_length=8)] = []
    """Names of entry points of the group coaxial.sinks."""


class HubTlsConfig(Section):
    """TLS of the connection to the NATS server."""

    ca: FilePath | None = None
    """PEM with the authority of its certificate; default: those of this system."""
    certificate: FilePath | None = None
    """PEM of the own certificate, where the NATS server requires one."""
    key: FilePath | None = None
    """PEM, not encrypted."""


class HubConfig(Section):
    """NATS server of the hospital, through which this theatre publishes, and `coaxial theatres` reads."""

    url: Annotated[str, StringConstraints(pattern=r"^(nats|tls)://[^/@\s]+$")] | None = None
    """tls://host:4222; default: off."""
    hospital: Name = "hospital"
    """First part of all subjects, so that several hospitals can share a NATS server."""
    theatre: Name | None = None
    """Name of this theatre, which no other may have at the same time; `coaxial theatres` needs none."""
    credentials: FilePath | None = None
    """File with one line, `user:password`; default: none, as with a client certificate."""
    tls: HubTlsConfig = HubTlsConfig()
    unencrypted: Literal["anybody on this network reads the theatres"] | None = None
    """Exactly this text allows nats:// to a host that is not loopback."""
    max_rate_hz: Annotated[float, Field(ge=1.0, le=60.0)] = 30
    """Maximum rate of live messages; above it only the newest are sent."""
    picture_rate_hz: Annotated[float, Field(ge=0.0, le=10.0)] = 2
    """Rate of small pictures; 0: none."""
    requests: bool = False
    """Whether supervisors who are signed in to this theatre hold, mark and sign in it through the hub."""
    sees: dict[str, list[str]] = {}
    """For `coaxial hub`: by a person's name, the theatres that they see; `OR-*` stands for many."""


class Config(Section):
    """All settings. Paths are absolute, or relative to the working directory."""

    server: ServerConfig = ServerConfig()
    security: SecurityConfig = SecurityConfig()
    camera: CameraConfig = CameraConfig()
    external_tracker: ExternalTrackerConfig | None = None
    rehearsal: RehearsalConfig = RehearsalConfig()
    markers: dict[Name, MarkerConfig] = {}
    tools: dict[Name, ToolConfig] = {}
    reference: ReferenceConfig = ReferenceConfig()
    tool_calibration: ToolCalibrationConfig = ToolCalibrationConfig()
    registration: RegistrationConfig = RegistrationConfig()
    tracker: TrackerConfig = TrackerConfig()
    smoothing: SmoothingConfig = SmoothingConfig()
    calibration: CalibrationConfig = CalibrationConfig()
    limits: LimitsConfig = LimitsConfig()
    alarms: AlarmsConfig = AlarmsConfig()
    supervision: SupervisionConfig = SupervisionConfig()
    plan: PlanConfig = PlanConfig()
    video: VideoConfig = VideoConfig()
    openigtlink: OpenIgtLinkConfig = OpenIgtLinkConfig()
    dicom: DicomConfig = DicomConfig()
    recording: RecordingConfig = RecordingConfig()
    plugins: PluginsConfig = PluginsConfig()
    hub: HubConfig = HubConfig()

"""The settings: what config.yaml may say, with the ranges that are allowed.

Every limit has its one home here; screen, overlay and alarm read the same field. How a file becomes these
records, and how a mistake in it is told, is in `server.config_file`.
"""

from pathlib import Path
from typing import Annotated, Literal, TypeAlias

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StringConstraints

Ratio: TypeAlias = Annotated[float, Field(ge=0.0, le=1.0)]
Strength: TypeAlias = Annotated[float, Field(ge=0.0, le=10.0)]
Millimetres: TypeAlias = Annotated[float, Field(ge=-10_000.0, le=10_000.0)]
Point: TypeAlias = Annotated[list[Millimetres], Field(min_length=3, max_length=3)]
Name: TypeAlias = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]{0,39}$")]
FilePath: TypeAlias = Annotated[Path, Field(strict=False)]


class Section(BaseModel):
    """Common to all parts of the settings: no unknown key, no silent conversion, never changed."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", strict=True, allow_inf_nan=False, use_attribute_docstrings=True
    )


class TlsConfig(Section):
    """A certificate of one's own; without one, the server makes itself one where it needs one."""

    certificate: FilePath | None = None
    """PEM, with the certificates between it and its root."""
    key: FilePath | None = None
    """PEM, without a password."""


class ServerConfig(Section):
    """Where the server listens."""

    host: Annotated[str, StringConstraints(min_length=1)] = "127.0.0.1"
    """Address to listen on; 127.0.0.1 is reached from this machine only."""
    port: Annotated[int, Field(ge=0, le=65535)] = 8000
    """0 takes any free one."""
    tls: TlsConfig = TlsConfig()
    behind_proxy: Literal["a proxy speaks TLS for this server"] | None = None
    """Said in these words, the server speaks no TLS itself on any address."""


def _written_off(value: object) -> object:
    """In YAML a bare off is false."""
    return "off" if value is False else value


class SecurityConfig(Section):
    """Who has to sign in, and for how long."""

    sign_in: Annotated[Literal["required", "off"], BeforeValidator(_written_off)] = "required"
    """off: everybody who reaches the server may do everything; on loopback alone."""
    session_h: Annotated[float, Field(gt=0.0, le=168.0)] = 12
    """How long somebody stays signed in, where their invitation says nothing else."""


class CameraConfig(Section):
    """Where images come from."""

    name: Name = "main"
    source: Annotated[int, Field(ge=0, le=99)] | Annotated[str, StringConstraints(min_length=1)] = "rehearsal"
    """rehearsal, phone, a number or path of a local camera, basler: or genicam: with a serial number, a video
    file, a stream's address, a folder of images."""
    calibration: FilePath | None = None
    """A camera file (YAML or JSON) with matrix, distortion, size_wh_px."""
    loop: bool = True
    """A video file or folder starts again at its end."""
    rate: Literal["own", "fast"] = "own"
    """own: a file at its own rate; fast: as fast as the tracker takes its images, none skipped."""
    width: Annotated[int, Field(ge=16, le=7680)] | None = None
    """With height, asked of a local camera; left out, it is chosen by what the camera offers."""
    height: Annotated[int, Field(ge=16, le=4320)] | None = None
    rate_hz: Annotated[float, Field(gt=0.0, le=1000.0)] | None = None
    """Asked of a local camera; the rate of a folder, and of a file that has none (30 if left out)."""
    same_sensor_area: bool = False
    """Images of all sizes with one ratio of width to height show the same area of the sensor, so that a
    calibration may be scaled."""
    lock_controls: bool = True
    """Of a local camera: focus, zoom, pan and tilt are set to what they were at the calibration, and
    automatic focus is switched off; without a calibration, once it has settled."""
    lock_light: bool = False
    """Automatic exposure and white balance are switched off once they have settled."""
    trigger: Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9]{0,39}$")] | None = None
    """The input of an industrial camera that starts each image, as line1; left out, it runs freely."""
    readout_ms: Annotated[float, Field(ge=0.0, le=200.0)] = 0.0
    """From when the first row of an image is read to the last one; 0 of a global shutter."""


class RehearsalEventConfig(Section):
    """Something that goes wrong in the rehearsal, at a known time."""

    kind: Literal[
        "camera_moves",
        "patient_moves",
        "drill_jumps",
        "drill_hidden",
        "reference_hidden",
        "camera_stops",
        "camera_stalls",
    ]
    at_s: Annotated[float, Field(ge=0.0, le=100_000.0)]
    """Since the scene began."""
    lasts_s: Annotated[float, Field(gt=0.0, le=100_000.0)] | None = None
    """Left out: for good."""
    every_s: Annotated[float, Field(gt=0.0, le=100_000.0)] | None = None
    """Left out: once."""
    size_mm: Annotated[float, Field(ge=0.0, le=60.0)] = 12.0
    size_deg: Annotated[float, Field(ge=0.0, le=20.0)] = 2.0


class RehearsalConfig(Section):
    """The theatre that exists only in software."""

    seed: Annotated[int, Field(ge=0, le=2**31 - 1)] = 1
    width: Annotated[int, Field(ge=160, le=3840)] = 1280
    height: Annotated[int, Field(ge=120, le=2160)] = 720
    rate_hz: Annotated[float, Field(gt=0.0, le=120.0)] = 30.0
    noise: Strength = 1.0
    blur: Strength = 1.0
    clutter: Strength = 1.0
    light: Annotated[float, Field(gt=0.0, le=10.0)] = 1.0
    scene: Literal["operation", "pivot", "spin", "board", "landmarks", "sweep", "check"] = "operation"
    """A drill at work; its tip at rest while it tilts, or turns; a board to calibrate with; its tip on one
    landmark after the other, sweeping over the bone, on a landmark that is left for the check."""
    skill: Literal["wandering", "good", "breaching"] = "wandering"
    """How the drill is held in the operation: off by millimetres at last, true, or through the wall."""
    rest_s: Annotated[float, Field(ge=0.5, le=60.0)] = 3.0
    """How long the hand holds the tip on a landmark."""
    reference: bool = False
    """A second marker is fixed to the patient."""
    events: Annotated[list[RehearsalEventConfig], Field(max_length=20)] = []
    """What goes wrong, and when."""
    board: Literal["dots", "checkerboard", "charuco"] = "dots"
    """Which calibration board is shown."""
    brings_setup: bool = True
    """false: camera, tool, plan and registration are unknown until they are made."""


class MarkerConfig(Section):
    """A printed marker: its picture, which the black square fills edge to edge, and its side."""

    image: FilePath
    side_mm: Annotated[float, Field(gt=0.0, le=1000.0)]


class ToolConfig(Section):
    """A drill or awl behind its marker: from its drawing, or from the file that its calibration wrote."""

    marker: Name
    calibration: FilePath | None = None
    """A tool file of `coaxial pivot` and `coaxial spin`; what it says is not said here again."""
    tip_in_marker_mm: Point | None = None
    axis_in_marker: Point | None = None
    """From the marker towards the tip."""
    radius_mm: Annotated[float, Field(gt=0.0, le=50.0)]
    length_mm: Annotated[float, Field(gt=0.0, le=1000.0)]


class ReferenceConfig(Section):
    """The marker that is fixed to the patient."""

    marker: Name | None = None
    """Its name under markers; without one, a move of patient or camera is not seen."""


class ToolCalibrationConfig(Section):
    """What the calibration of a tool, and the check of its tip, must reach."""

    max_rms_3d_mm: Annotated[float, Field(gt=0.0, le=100.0)] = 0.8
    """3-D RMS of the tip about the pivot, of pivot and tip check alike."""
    max_tip_sd_mm: Annotated[float, Field(gt=0.0, le=100.0)] = 0.8
    """Standard deviation of the tip in the direction in which it is known least."""
    min_tilt_deg: Annotated[float, Field(ge=5.0, le=120.0)] = 15.0
    """How far the tool must be turned about each of two directions, from end to end."""
    min_poses: Annotated[int, Field(ge=6, le=10_000)] = 10
    min_used_ratio: Annotated[float, Field(ge=0.5, le=1.0)] = 0.6
    """Share of the poses that must agree."""
    min_spin_deg: Annotated[float, Field(ge=20.0, le=360.0)] = 60.0
    max_wobble_deg: Annotated[float, Field(gt=0.0, le=45.0)] = 5.0
    """RMS of what the axis moves while the tool is spun about it."""
    max_axis_sd_deg: Annotated[float, Field(gt=0.0, le=45.0)] = 0.5


class RegistrationConfig(Section):
    """What a registration, and its check on anatomy, must reach before anybody navigates by it."""

    min_points: Annotated[int, Field(ge=3, le=40)] = 3
    """Landmarks that are touched; four show a mistake that three hide."""
    max_fre_mm: Annotated[float, Field(gt=0.0, le=20.0)] = 1.5
    """RMS distance of the landmarks from where the fit lays them."""
    max_tre_mm: Annotated[float, Field(gt=0.0, le=20.0)] = 2.0
    """The stated error (3-D RMS) at the entry point of every channel of the vertebra."""
    max_left_out_mm: Annotated[float, Field(gt=0.0, le=50.0)] = 5.0
    """Distance of any landmark from where all the others have it; known of four and more."""
    capture_images: Annotated[int, Field(ge=3, le=300)] = 12
    """Images in a row in which the tip rests on a landmark, and is seen in all of them."""
    capture_s: Annotated[float, Field(ge=0.05, le=10.0)] = 0.4
    """How long they last at least, so that a hand's tremor is in them."""
    max_capture_gap_s: Annotated[float, Field(ge=0.05, le=10.0)] = 1.0
    """Between two of them at any image rate; else six image periods of the capture, or 0.25 s if longer."""
    max_capture_sd_mm: Annotated[float, Field(gt=0.0, le=20.0)] = 0.4
    """Standard deviation of the tip in them, along its worst axis."""
    max_surface_rms_mm: Annotated[float, Field(gt=0.0, le=20.0)] = 1.0
    """RMS distance of a sweep from the bone's surface."""
    max_nudge_mm: Annotated[float, Field(ge=0.0, le=20.0)] = 5.0
    """How far all nudges by hand together may lead, between the entry points."""
    max_nudge_deg: Annotated[float, Field(ge=0.0, le=20.0)] = 5.0
    check_required: bool = True
    """false: navigate by a registration that was not checked on a landmark."""
    max_check_mm: Annotated[float, Field(gt=0.0, le=20.0)] = 2.0
    """Distance of the tip on a landmark from where the plan has it."""
    check_again_after_min: Annotated[float, Field(ge=1.0, le=1440.0)] = 30
    """From then on the check is asked for again; navigation goes on."""
    moved_after_s: Annotated[float, Field(ge=0.1, le=60.0)] = 1.0
    """How long camera or reference must stand elsewhere before a registration is withdrawn for it."""


class TrackerConfig(Section):
    """When a marker counts as found."""

    accept_score_ratio: Ratio = 0.7
    accept_target_score_ratio: Ratio = 0.55
    accept_inner_coverage_ratio: Ratio = 0.6
    explained_share: Ratio = 0.6
    fit_error_weight: Ratio = 0.25


class SmoothingConfig(Section):
    """Steadied poses: the mean of the last images as long as they agree, with the lag shown."""

    lag_ms: Annotated[float, Field(ge=0.0, le=500.0)] = 0
    """How far behind a steadied pose may be, at most; 0 is off."""
    near_wall: bool = False
    """Steady near the channel's wall, too."""
    near_wall_mm: Annotated[float, Field(ge=0.0, le=100.0)] = 3.0
    """What near is: the gap between the drill at its tip and the channel's surface."""


class CalibrationConfig(Section):
    """When a calibration is good enough."""

    max_rms_px: Annotated[float, Field(gt=0.0, le=100.0)] = 1.0
    """Root mean square distance between seen and expected points of the board."""
    max_error_mm: Annotated[float, Field(gt=0.0, le=100.0)] = 0.5
    """Of a known displacement, in an accuracy check."""


class LimitsConfig(Section):
    """From which age on something is old, and how unsure a tip may be; past them there are no numbers."""

    pose_stale_after_ms: Annotated[float, Field(ge=20.0, le=10_000.0)] = 150
    video_stale_after_ms: Annotated[float, Field(ge=20.0, le=10_000.0)] = 500
    scene_stale_after_ms: Annotated[float, Field(ge=20.0, le=10_000.0)] = 500
    max_tip_sd_mm: Annotated[float, Field(ge=0.1, le=100.0)] = 3.0


class AlarmsConfig(Section):
    """From where on something is an alarm; an image is missed after `limits.video_stale_after_ms`."""

    warning_distance_mm: Annotated[float, Field(ge=0.0, le=20.0)] = 1.0
    """Bone between the drill's cylinder and the pedicle's wall."""
    hysteresis_mm: Annotated[float, Field(ge=0.05, le=1.0)] = 0.3
    """How much better a distance must be than its limit for the alarm to clear."""
    breach_ratio: Annotated[float, Field(ge=0.01, lt=1.0)] = 0.05
    """Probability of being through the wall."""
    breach_hysteresis_ratio: Annotated[float, Field(ge=0.0, lt=1.0)] = 0.02
    again_after_mm: Annotated[float, Field(ge=0.1, le=20.0)] = 1.0
    """An acknowledged breach that gets deeper by this sounds again."""
    drill_unseen_after_ms: Annotated[float, Field(ge=100.0, le=60_000.0)] = 1000
    reference_unseen_after_ms: Annotated[float, Field(ge=100.0, le=60_000.0)] = 1000
    put_away_after_s: Annotated[float, Field(ge=5.0, le=3600.0)] = 120
    """A drill unseen for longer lies somewhere on purpose, and is no longer missed."""
    screen_lost_after_s: Annotated[float, Field(ge=3.0, le=600.0)] = 6
    """A screen with armed sound that says nothing for this long is lost."""
    min_free_disk_mb: Annotated[float, Field(ge=0.0, le=1e7)] = 2000


class VideoConfig(Section):
    """The picture that goes out."""

    jpeg_quality: Annotated[int, Field(ge=1, le=100)] = 80
    language: Literal["en", "de"] = "en"
    """Of the words that are burned into the picture; a page has the language of its browser."""
    max_viewers: Annotated[int, Field(ge=1, le=10_000)] = 64
    """Who may watch at once, of pictures and numbers; as many again may watch the 3-D scene."""


class CosignConfig(Section):
    """What a second person signs. required: nobody navigates before; offered: it may be done.

    An operator can invite a second self: a signature tells who invited the signer, and cannot rule that out.
    """

    plan: Literal["required", "offered"] = "offered"
    registration: Literal["required", "offered"] = "offered"


class SupervisionConfig(Section):
    """Those who look on from afar."""

    cosign: CosignConfig = CosignConfig()
    drawings_fade_after_s: Annotated[float, Field(ge=2.0, le=600.0)] = 20
    """Counted from the image that was drawn on: patient and camera move."""


class PlanConfig(Section):
    """Planning: which screws can be had, and what stays free around them."""

    screw_diameters_mm: Annotated[
        list[Annotated[float, Field(gt=0.0, le=20.0)]], Field(min_length=1, max_length=100)
    ] = [4.0, 4.5, 5.0, 5.5, 6.0, 6.5, 7.0, 7.5, 8.5]
    screw_lengths_mm: Annotated[
        list[Annotated[float, Field(gt=0.0, le=150.0)]], Field(min_length=1, max_length=100)
    ] = [25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0]
    wall_margin_mm: Annotated[float, Field(ge=0.0, le=10.0)] = 0.5
    front_margin_mm: Annotated[float, Field(ge=0.0, le=50.0)] = 5.0


class Config(Section):
    """All settings. Paths in it are absolute, or relative to the working directory."""

    server: ServerConfig = ServerConfig()
    security: SecurityConfig = SecurityConfig()
    camera: CameraConfig = CameraConfig()
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

"""The tip followed in the live images while it rests on a landmark."""

import threading
from dataclasses import dataclass, replace
from enum import StrEnum

from server.live import Instant, LiveHub, Problem
from server.procedure.following import Follower
from tracker.errors import CalibrationError, InvalidInput, RegistrationError
from tracker.navigation import Absent, AbsentReason, NavigationSnapshot
from tracker.navigation.concluding import tool_in_view
from tracker.pose import Seen
from tracker.registration.capture import (
    CapturedLandmark,
    CaptureSettings,
    LandmarkCollector,
    TipSample,
    UnseenSample,
)
from tracker.registration.tip import tip_in_anchor

UNSEEN = {
    AbsentReason.MARKER_UNSEEN: "the tool's marker is not seen",
    AbsentReason.POSE_UNCERTAIN: "the tip could be millimetres away from where it seems",
    AbsentReason.CAMERA_NOT_CALIBRATED: "the camera is not calibrated",
    AbsentReason.CAMERA_CHANGED: "the camera's focus or zoom is not as it was calibrated",
}


class TouchState(StrEnum):
    """How far a capture has come."""

    LOOKING = "looking"
    TAKEN = "taken"
    REJECTED = "rejected"


@dataclass(frozen=True, slots=True, kw_only=True)
class TouchStatus:
    """How far it has come.

    Attributes:
        landmark: that the tip is held on.
        state: whether more images are looked at.
        images: in which it was seen so far.
        wanted: how many there must be.
        rate_hz: images/s that came so far; None before the second one.
        left_s: how long the tip is still to be held at this rate [s]; None before the second image.
        from_s: when the tip was first looked for, by the clock of the images; None before the first image.
        touched: the point; None until it is taken.
        trouble: why it was refused.
    """

    landmark: str
    state: TouchState
    images: int
    wanted: int
    rate_hz: float | None
    left_s: float | None
    from_s: float | None
    touched: CapturedLandmark | None
    problem: Problem | None


class Touch:
    """Follows the tip on one landmark until it was seen often enough, or is refused.

    Args:
        hub: the live images.
        landmark: that the tip is held on.
        tool: that touches.
        reference: the marker on the patient; empty where points are in the camera's frame.
        gate: when the tip counts as at rest.
    """

    def __init__(
        self, hub: LiveHub, *, landmark: str, tool: str, reference: str, gate: CaptureSettings
    ) -> None:
        self.landmark = landmark
        self._tool = tool
        self._reference = reference
        self._gate = gate
        self._lock = threading.Lock()
        self._collector = LandmarkCollector(gate)
        self._images = 0
        self._from_s: float | None = None
        self._image_number = -1
        self._touched: CapturedLandmark | None = None
        self._follower = Follower(hub, self._look, name=f"capturing {landmark}")

    @property
    def status(self) -> TouchStatus:
        """How far it has come."""
        with self._lock:
            problem = self._follower.problem
            state = TouchState.LOOKING if self._touched is None else TouchState.TAKEN
            return TouchStatus(
                landmark=self.landmark,
                state=TouchState.REJECTED if problem is not None else state,
                images=self._images,
                wanted=self._gate.min_images,
                rate_hz=self._collector.rate_hz,
                left_s=self._collector.left_s,
                from_s=self._from_s,
                touched=self._touched,
                problem=problem,
            )

    def stop(self) -> None:
        """Look no more."""
        self._follower.stop()

    def _look(self, instant: Instant) -> None:
        snapshot = instant.snapshot
        if self._touched is not None:
            return
        if instant.is_stopped:
            raise RegistrationError(
                "NO_PICTURE", "there is no picture any more", "Wait until the video runs, and capture again."
            )
        if snapshot is None or snapshot.image_number == self._image_number:
            return
        tip = replace(tip_of(snapshot, self._tool, self._reference), image_number=snapshot.image_number)
        with self._lock:
            self._image_number = snapshot.image_number
            self._from_s = tip.at_s if self._from_s is None else self._from_s
            self._collector.take(tip)
            self._images += isinstance(tip, TipSample)
            if self._collector.is_over:
                self._touched = self._collector.result()


def tip_of(snapshot: NavigationSnapshot, name: str, reference: str) -> TipSample | UnseenSample:
    """The tip in one image, in the frame of the reference, or of the camera where there is none.

    Raises:
        InvalidInput: TOOL_UNKNOWN.
        CalibrationError: CAMERA_NOT_CALIBRATED.
    """
    setup = snapshot.setup
    if not setup.camera_calibrated:
        raise CalibrationError(
            "CAMERA_NOT_CALIBRATED",
            "the camera is not calibrated, so points have no millimetres",
            "Calibrate the camera first, or name its file as camera.calibration.",
        )
    tool = setup.tools.get(name)
    if tool is None:
        raise InvalidInput(
            "TOOL_UNKNOWN",
            f"there is no tool '{name}' in use",
            f"Known are: {', '.join(sorted(setup.tools)) or 'none'}; calibrate its tip and axis first.",
            {"tool": name},
        )
    # As the image has it, not steadied: at rest the mean does the same, and a move must show.
    sighting = snapshot.sightings[tool.marker]
    view = tool_in_view(setup, tool, sighting)
    at_s = snapshot.captured_at_s
    if isinstance(view, Absent) or not isinstance(sighting, Seen):
        reason = view.reason if isinstance(view, Absent) else AbsentReason.MARKER_UNSEEN
        return UnseenSample(at_s=at_s, reason=UNSEEN.get(reason, reason.value))
    if not reference:
        return tip_in_anchor(tool, sighting, None, at_s=at_s)
    beside = snapshot.sightings.get(reference)
    if not isinstance(beside, Seen):
        return UnseenSample(at_s=at_s, reason=f"the marker '{reference}' on the patient is not seen")
    return tip_in_anchor(tool, sighting, beside, at_s=at_s)

"""Capture of the tool tip at rest on a landmark, from the live images."""

import threading
from dataclasses import dataclass, replace
from enum import StrEnum

from server.live import Instant, LiveHub, Problem
from server.procedure.live_listener import LiveListener
from tracker.errors import CalibrationError, InvalidInput, RegistrationError
from tracker.navigation import Absent, AbsentReason, NavigationSnapshot
from tracker.navigation.snapshot_builder import locate_tool
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
    AbsentReason.MARKER_TWICE: "the tool's marker is in view twice",
    AbsentReason.POSE_UNCERTAIN: "the position of the tip is uncertain by millimetres",
    AbsentReason.CAMERA_NOT_CALIBRATED: "the camera is not calibrated",
    AbsentReason.CAMERA_CHANGED: "focus or zoom of the camera has changed since the calibration",
}


class CaptureState(StrEnum):
    """State of a capture."""

    LOOKING = "looking"
    TAKEN = "taken"
    REJECTED = "rejected"


@dataclass(frozen=True, slots=True, kw_only=True)
class CaptureStatus:
    """Progress of a capture.

    Attributes:
        landmark: name of the landmark.
        state: whether more images are processed.
        images: number of images with the tip so far.
        wanted: number of images that are needed.
        rate_hz: measured image rate; None before the second image.
        left_s: remaining time at this rate; None before the second image.
        from_s: time of the first image, on the image clock; None before it.
        touched: the captured point; None until it is complete.
        problem: why the capture was rejected.
    """

    landmark: str
    state: CaptureState
    images: int
    wanted: int
    rate_hz: float | None
    left_s: float | None
    from_s: float | None
    touched: CapturedLandmark | None
    problem: Problem | None


class LandmarkCapture:
    """Collects tip positions on one landmark until there are enough, or the capture is rejected.

    Args:
        hub: the live images.
        landmark: name of the landmark.
        tool: tool whose tip is on the landmark.
        reference: the reference marker on the patient; empty if points are in the camera frame.
        gate: criteria for a tip at rest.
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
        self._listener = LiveListener(hub, self._process, name=f"capturing {landmark}")

    @property
    def status(self) -> CaptureStatus:
        """Progress of the capture."""
        with self._lock:
            problem = self._listener.problem
            state = CaptureState.LOOKING if self._touched is None else CaptureState.TAKEN
            return CaptureStatus(
                landmark=self.landmark,
                state=CaptureState.REJECTED if problem is not None else state,
                images=self._images,
                wanted=self._gate.min_images,
                rate_hz=self._collector.rate_hz,
                left_s=self._collector.left_s,
                from_s=self._from_s,
                touched=self._touched,
                problem=problem,
            )

    def stop(self) -> None:
        """Stop the capture."""
        self._listener.stop()

    def _process(self, instant: Instant) -> None:
        snapshot = instant.snapshot
        if self._touched is not None:
            return
        if instant.is_stopped:
            raise RegistrationError(
                "NO_PICTURE", "there are no more images", "Wait until the video runs, and capture again."
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
    """Return the tip in one image, in the reference frame, or in the camera frame without a reference.

    Raises:
        InvalidInput: TOOL_UNKNOWN.
        CalibrationError: CAMERA_NOT_CALIBRATED.
    """
    setup = snapshot.setup
    if not setup.camera_calibrated:
        raise CalibrationError(
            "CAMERA_NOT_CALIBRATED",
            "the camera is not calibrated, so that no position in mm can be measured",
            "Calibrate the camera first, or set camera.calibration to its file.",
        )
    tool = setup.tools.get(name)
    if tool is None:
        tools = ", ".join(sorted(setup.tools)) or "none"
        raise InvalidInput(
            "TOOL_UNKNOWN",
            f"there is no tool '{name}' in use",
            f"Available tools: {tools}. Calibrate tip and axis first.",
            {"tool": name, "tools": tools},
        )
    # The unfiltered pose, because the samples are averaged anyway, and a motion must remain visible.
    sighting = snapshot.sightings[tool.marker]
    view = locate_tool(setup, tool, sighting)
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

"""Capture of the tool tip at rest in a divot of an accuracy plate, from the live images."""

import threading
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from server.errors import CaptureError
from server.live import Instant, LiveHub, Problem, SourceStatus
from server.procedure.live_listener import LiveListener
from tracker.accuracy import DivotCapture, RestLimits, capture_at_rest
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.navigation import Absent, NavigationSnapshot
from tracker.navigation.snapshot_builder import locate_tool
from tracker.pose import Seen, ToolModel
from tracker.pose.tool import Poses

# A hand holds a tip at rest for a second; a slow camera, or one that loses the marker, gets more.
CAPTURE_S, MAX_CAPTURE_S = 1.0, 4.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedCapture:
    """A capture of the plan: which divot, how the tool is held, and where the plate lies."""

    placement: str
    divot: str
    posture: str

    @property
    def title(self) -> str:
        """Return a short name for messages, as `DivotCapture.title`."""
        return f"divot {self.divot[:20]}, placement {self.placement[:20]}, {self.posture[:20]}"


class DivotCaptureState(StrEnum):
    """State of a capture."""

    LOOKING = "looking"
    TAKEN = "taken"
    REJECTED = "rejected"


@dataclass(frozen=True, slots=True, kw_only=True)
class DivotCaptureStatus:
    """Progress of a capture.

    Attributes:
        planned: what is captured.
        state: whether more images are processed.
        seen: number of images in which the tip was measured.
        images: number of images.
        taken: the capture; None until it is complete.
        problem: why the capture was rejected.
    """

    planned: PlannedCapture
    state: DivotCaptureState
    seen: int
    images: int
    taken: DivotCapture | None
    problem: Problem | None


class LiveDivotCapture:
    """Collects the poses of a tool for a second, and passes their mean on. Thread-safe.

    Args:
        hub: the live images.
        planned: what is captured.
        tool_of: returns the examined tool of an image; raises an error if the system has changed.
        validate: called with the capture; raises an error to reject it.
    """

    def __init__(
        self,
        hub: LiveHub,
        planned: PlannedCapture,
        *,
        tool_of: Callable[[NavigationSnapshot, SourceStatus], ToolModel],
        validate: Callable[[DivotCapture], None],
    ) -> None:
        self.planned = planned
        self._tool_of = tool_of
        self._validate = validate
        self._lock = threading.Lock()
        self._poses: list[Rigid[Camera, Marker]] = []
        self._covariances: list[Array] = []
        self._images = 0
        self._image_number = -1
        self._from_s: float | None = None
        self._taken: DivotCapture | None = None
        self._listener = LiveListener(hub, self._process, name=f"capturing {planned.title}")

    @property
    def status(self) -> DivotCaptureStatus:
        """Progress of the capture."""
        with self._lock:
            problem = self._listener.problem
            state = DivotCaptureState.LOOKING if self._taken is None else DivotCaptureState.TAKEN
            return DivotCaptureStatus(
                planned=self.planned,
                state=DivotCaptureState.REJECTED if problem is not None else state,
                seen=len(self._poses),
                images=self._images,
                taken=self._taken,
                problem=problem,
            )

    def stop(self) -> None:
        """Stop the capture."""
        self._listener.stop()

    def _process(self, instant: Instant) -> None:
        snapshot = instant.snapshot
        if self._taken is not None:
            return
        if instant.is_stopped:
            raise CaptureError(
                "NO_PICTURE", "there are no more images", "Wait until the video runs, and capture again."
            )
        if snapshot is None or snapshot.image_number == self._image_number:
            return
        tool = self._tool_of(snapshot, instant.source)
        sighting = snapshot.sightings[tool.marker]
        pose = locate_tool(snapshot.setup, tool, sighting, motion=snapshot.motion)
        # What navigation does not show, such as a pose that is uncertain by millimetres, is not certified.
        with self._lock:
            self._image_number = snapshot.image_number
            self._images += 1
            self._from_s = snapshot.captured_at_s if self._from_s is None else self._from_s
            if isinstance(sighting, Seen) and not isinstance(pose, Absent):
                self._poses.append(sighting.camera_from_marker)
                self._covariances.append(sighting.pose_covariance)
            is_over = self._is_over(snapshot.captured_at_s - self._from_s)
        if is_over:
            capture = self._capture(tool)
            self._validate(capture)
            with self._lock:
                self._taken = capture

    def _is_over(self, elapsed_s: float) -> bool:
        enough = len(self._poses) >= RestLimits().min_images
        return elapsed_s >= (CAPTURE_S if enough else MAX_CAPTURE_S)

    def _capture(self, tool: ToolModel) -> DivotCapture:
        """Return the capture.

        Raises:
            CalibrationError: ACCURACY_TIP_UNSEEN, or as `capture_at_rest`.
        """
        seen, needed = len(self._poses), RestLimits().min_images
        if seen < min(needed, self._images):
            raise CalibrationError(
                "ACCURACY_TIP_UNSEEN",
                f"the tip was measured in {seen} of {self._images} images of the capture "
                f"{self.planned.title}, needed {needed}",
                "Hold the tool so that its marker faces the camera and is not covered, and record this "
                "capture again.",
                {
                    "seen": seen,
                    "images": self._images,
                    "capture": self.planned.title,
                    "needed": needed,
                },
            )
        return capture_at_rest(
            Poses.from_rigids(self._poses, self._covariances),
            tool.marker_from_tool.translation_mm,
            divot=self.planned.divot,
            placement=self.planned.placement,
            posture=self.planned.posture,
        )


def tool_in_use(snapshot: NavigationSnapshot, name: str) -> ToolModel:
    """Return a tool of an image.

    Raises:
        InvalidInput: CERTIFICATE_NOT_APPLICABLE or TOOL_UNKNOWN.
    """
    reject_uncalibrated(snapshot)
    tool = snapshot.setup.tools.get(name)
    if tool is None:
        tools = ", ".join(sorted(snapshot.setup.tools))[:200] or "none"
        raise InvalidInput(
            "TOOL_UNKNOWN",
            f"there is no tool '{name[:40]}' in use",
            f"Available tools: {tools}. Calibrate tip and axis first.",
            {"tool": name[:40], "tools": tools},
        )
    return tool


def reject_uncalibrated(snapshot: NavigationSnapshot) -> None:
    """Reject an image of a camera whose calibration does not apply.

    Raises:
        InvalidInput: CERTIFICATE_NOT_APPLICABLE.
    """
    if not snapshot.setup.has_images:
        raise InvalidInput(
            "CERTIFICATE_NOT_APPLICABLE",
            "the poses come from an external tracker: no certificate of a camera applies",
            "Rely on the accuracy that the maker of the tracker states.",
        )
    if not snapshot.setup.camera_calibrated or snapshot.motion.camera_changes:
        raise InvalidInput(
            "CERTIFICATE_NOT_APPLICABLE",
            "the camera is not calibrated, or its focus or zoom has changed: no certificate applies",
            "Calibrate the camera, or restore focus and zoom.",
        )

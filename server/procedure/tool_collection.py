"""Collection of marker poses from the live images for the calibration of a tool."""

import threading
from dataclasses import dataclass

from server.live import Instant, LiveHub, Problem
from server.procedure.live_listener import LiveListener
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array
from tracker.pose.tool import ToolGate
from tracker.pose.tool.collector import PoseCollector, Progress, Purpose, Taking


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolCollectionStatus:
    """Progress of the collection.

    Attributes:
        tool: name of the tool.
        marker: marker on the tool.
        purpose: what is calibrated or checked.
        running: whether poses are still collected.
        progress: collected poses, current result, and what is missing.
        newest: result for the newest image.
        problem: why the collection ended.
    """

    tool: str
    marker: str
    purpose: Purpose
    running: bool
    progress: Progress
    newest: Taking
    problem: Problem | None


class ToolCollection:
    """Collects the poses of one tool's marker until it is stopped. Thread-safe.

    Args:
        hub: the live images.
        tool: name of the tool.
        marker: marker on the tool.
        marker_document_id: document of that marker in the case; empty for a configured marker.
        purpose: what is calibrated or checked.
        tip_in_marker_mm: (3,) tip of the tool, if it is known.
        gate: acceptance limits.
    """

    def __init__(
        self,
        hub: LiveHub,
        *,
        tool: str,
        marker: str,
        marker_document_id: str = "",
        purpose: Purpose,
        tip_in_marker_mm: Array | None,
        gate: ToolGate,
    ) -> None:
        self.tool, self.marker, self.purpose = tool, marker, purpose
        self.marker_document_id = marker_document_id
        self._lock = threading.Lock()
        self._collector = PoseCollector(purpose, tip_in_marker_mm=tip_in_marker_mm, gate=gate)
        self._newest = Taking.NO_PICTURE
        self._image_number = -1
        self._listener = LiveListener(hub, self._process, name=f"collecting poses of {tool}")

    @property
    def status(self) -> ToolCollectionStatus:
        """Progress of the collection. Fits all poses: do not call it for every image."""
        with self._lock:
            return ToolCollectionStatus(
                tool=self.tool,
                marker=self.marker,
                purpose=self.purpose,
                running=self._listener.running,
                progress=self._collector.progress(),
                newest=self._newest,
                problem=self._listener.problem,
            )

    def stop(self) -> None:
        """Stop collecting."""
        self._listener.stop()

    def _process(self, instant: Instant) -> None:
        snapshot = instant.snapshot
        if instant.is_stopped:
            with self._lock:
                # The result of the last image is outdated.
                self._newest = Taking.NO_PICTURE
        if snapshot is None or snapshot.image_number == self._image_number:
            return
        self._image_number = snapshot.image_number
        if not snapshot.setup.camera_calibrated:
            raise CalibrationError(
                "CAMERA_NOT_CALIBRATED",
                "the camera is not calibrated, so that no poses in mm can be measured",
                "Calibrate the camera first, or set camera.calibration to its file.",
            )
        if self.marker not in snapshot.sightings:
            markers = ", ".join(sorted(snapshot.sightings)) or "none"
            raise InvalidInput(
                "MARKER_UNKNOWN",
                f"the marker '{self.marker}' is not tracked",
                f"Tracked markers: {markers}. Add it under markers.",
                {"marker": self.marker, "markers": markers},
            )
        with self._lock:
            self._newest = self._collector.take(snapshot.sightings[self.marker], at_s=snapshot.captured_at_s)

"""Poses for calibrating a tool, gathered from the live images while somebody tilts or turns it."""

import threading
from dataclasses import dataclass

from server.live import Instant, LiveHub, Problem
from server.procedure.following import Follower
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array
from tracker.pose.tool import ToolGate
from tracker.pose.tool.collector import PoseCollector, Progress, Purpose, Taking


@dataclass(frozen=True, slots=True, kw_only=True)
class GatheringStatus:
    """How far it has come.

    Attributes:
        tool: name of the tool.
        marker: that it carries.
        purpose: what is calibrated or checked.
        running: whether more poses are taken.
        progress: what is taken, what it gives now, and what is missing.
        newest: what became of the newest image.
        trouble: why nothing is taken any more.
    """

    tool: str
    marker: str
    purpose: Purpose
    running: bool
    progress: Progress
    newest: Taking
    problem: Problem | None


class ToolCollection:
    """Gathers the poses of one tool's marker until it is stopped; may be asked from any thread.

    Args:
        hub: the live images.
        tool: name of the tool.
        marker: that it carries.
        marker_document_id: what keeps that marker in the case; empty for one of the settings.
        purpose: what is calibrated or checked.
        tip_in_marker_mm: (3,) of the tool, if it is known.
        gate: what must be reached.
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
        self._follower = Follower(hub, self._look, name=f"gathering poses of {tool}")

    @property
    def status(self) -> GatheringStatus:
        """How far it has come; a fit to all poses, so not to be asked for every image."""
        with self._lock:
            return GatheringStatus(
                tool=self.tool,
                marker=self.marker,
                purpose=self.purpose,
                running=self._follower.running,
                progress=self._collector.progress(),
                newest=self._newest,
                problem=self._follower.problem,
            )

    def stop(self) -> None:
        """Take no more."""
        self._follower.stop()

    def _look(self, instant: Instant) -> None:
        snapshot = instant.snapshot
        if instant.is_stopped:
            with self._lock:
                # What became of the last image is no news any more.
                self._newest = Taking.NO_PICTURE
        if snapshot is None or snapshot.image_number == self._image_number:
            return
        self._image_number = snapshot.image_number
        if not snapshot.setup.camera_calibrated:
            raise CalibrationError(
                "CAMERA_NOT_CALIBRATED",
                "the camera is not calibrated, so poses have no millimetres",
                "Calibrate the camera first, or name its file as camera.calibration.",
            )
        if self.marker not in snapshot.sightings:
            raise InvalidInput(
                "MARKER_UNKNOWN",
                f"the marker '{self.marker}' is not looked for",
                f"Known are: {', '.join(sorted(snapshot.sightings)) or 'none'}; name it under markers.",
                {"marker": self.marker},
            )
        with self._lock:
            self._newest = self._collector.take(snapshot.sightings[self.marker], at_s=snapshot.captured_at_s)

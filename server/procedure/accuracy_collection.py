"""Guided captures of an accuracy test, in the order of a plan that is fixed before the first capture."""

import threading
from dataclasses import dataclass

import numpy as np

from server.certificate import (
    CameraInUse,
    ExaminedSystem,
    ToolInUse,
    assess,
    certified_camera,
    certified_tool,
)
from server.errors import SetupOrderError
from server.live import LiveHub, SourceStatus
from server.procedure.divot_capture import (
    DivotCaptureState,
    DivotCaptureStatus,
    LiveDivotCapture,
    PlannedCapture,
    tool_in_use,
)
from tracker.accuracy import AccuracyAssessment, DivotCapture, DivotPlate, reject_wrong_divot
from tracker.errors import CalibrationError, InvalidInput, NavigationError
from tracker.geometry.rotations import vector_from_rotation
from tracker.navigation import NavigationSnapshot
from tracker.pose import ToolModel

POSTURES = ("upright", "tilted", "turned")
# A plate with fewer than five divots lacks degrees of freedom in two placements.
PLACEMENTS, PLACEMENTS_OF_FOUR = ("near", "far"), ("near", "middle", "far")
# 54 captures in two placements take ten minutes; more divots add little.
MAX_DIVOTS = 9
# A tool that was not moved turns by less between two captures of a divot; asked for are about 30 degrees.
MIN_ROTATION_DEG = 5.0


def planned_captures(plate: DivotPlate) -> tuple[PlannedCapture, ...]:
    """Return the captures of a test in their order: each placement, each divot, each posture.

    The number of captures is fixed in advance: a test that ends when its figures look good is biased.
    """
    divots = plate.spread(MAX_DIVOTS)
    return tuple(
        PlannedCapture(placement=placement, divot=divot, posture=posture)
        for placement in (PLACEMENTS if len(divots) > 4 else PLACEMENTS_OF_FOUR)
        for divot in divots
        for posture in POSTURES
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class AccuracyStatus:
    """Progress of an accuracy test.

    Attributes:
        tool: name of the tool.
        system: camera, tool and plate of the test.
        planned: all captures in their order.
        captures: those that are taken, in the same order.
        capture: the active or last capture; None before the first, and after a discarded one.
        assessment: of the complete test; None before, and where the captures cannot be assessed.
        problems: reasons against a certificate, of a complete test.
    """

    tool: str
    system: ExaminedSystem
    planned: tuple[PlannedCapture, ...]
    captures: tuple[DivotCapture, ...]
    capture: DivotCaptureStatus | None
    assessment: AccuracyAssessment | None
    problems: tuple[NavigationError, ...]

    @property
    def due(self) -> PlannedCapture | None:
        """The next capture; None if all are taken."""
        return self.planned[len(self.captures)] if len(self.captures) < len(self.planned) else None


class AccuracyCollection:
    """Captures of one accuracy test, until a certificate is issued or they are discarded. Thread-safe.

    Args:
        hub: the live images.
        tool: name of the tool.
        system: camera, tool and plate of the test; an image of another camera or tool is rejected.
    """

    def __init__(self, hub: LiveHub, *, tool: str, system: ExaminedSystem) -> None:
        self.tool, self.system = tool, system
        self._hub = hub
        self._plate = system.plate.plate()
        self._planned = planned_captures(self._plate)
        self._lock = threading.Lock()
        self._captures: tuple[DivotCapture, ...] = ()
        self._capture: LiveDivotCapture | None = None
        self._assessed: tuple[tuple[DivotCapture, ...], AccuracyAssessment | InvalidInput] | None = None

    def capture(self, planned: PlannedCapture) -> None:
        """Start the next capture of the plan. It is named so that no image is attributed to another divot.

        Raises:
            SetupOrderError: ACCURACY_CAPTURE_ORDER or ACCURACY_TEST_COMPLETE.
        """
        with self._lock:
            self._take_over()
            if len(self._captures) == len(self._planned):
                raise SetupOrderError(
                    "ACCURACY_TEST_COMPLETE",
                    f"all {len(self._planned)} captures of the accuracy test are taken",
                    "Issue the certificate, or discard the last capture.",
                    {"captures": len(self._planned)},
                )
            due = self._planned[len(self._captures)]
            if planned != due:
                raise SetupOrderError(
                    "ACCURACY_CAPTURE_ORDER",
                    f"the next capture is {due.title}, not {planned.title}",
                    "Do the captures in their order.",
                    {"due": due.title, "requested": planned.title},
                )
            if self._capture is not None:
                self._capture.stop()
            before = self._captures
            self._capture = LiveDivotCapture(
                self._hub, planned, tool_of=self.tool_of, validate=lambda one: self._validate(before, one)
            )

    def discard_last(self) -> None:
        """Stop the active capture, or discard the last one if none is active.

        Raises:
            SetupOrderError: ACCURACY_NOTHING_CAPTURED.
        """
        with self._lock:
            self._take_over()
            active, self._capture = self._capture, None
            if active is not None:
                active.stop()
                if active.status.state is DivotCaptureState.LOOKING:
                    return
            if not self._captures:
                raise SetupOrderError(
                    "ACCURACY_NOTHING_CAPTURED",
                    "there is no capture to discard",
                    "Capture the first divot.",
                )
            self._captures = self._captures[:-1]

    @property
    def status(self) -> AccuracyStatus:
        """Progress of the test. Assesses a complete test once."""
        with self._lock:
            self._take_over()
            found = self._assessment() if len(self._captures) == len(self._planned) else None
            assessment = None if isinstance(found, InvalidInput) else found
            return AccuracyStatus(
                tool=self.tool,
                system=self.system,
                planned=self._planned,
                captures=self._captures,
                capture=None if self._capture is None else self._capture.status,
                assessment=assessment,
                problems=(found,)
                if isinstance(found, InvalidInput)
                else ()
                if assessment is None
                else assessment.problems,
            )

    def stop(self) -> None:
        """Stop the active capture."""
        with self._lock:
            if self._capture is not None:
                self._capture.stop()

    def tool_of(self, snapshot: NavigationSnapshot, source: SourceStatus) -> ToolModel:
        """Return the tool in an image of the examined system.

        Raises:
            CalibrationError: ACCURACY_SYSTEM_CHANGED.
            InvalidInput: as `tool_in_use`.
        """
        tool, system = tool_in_use(snapshot, self.tool), self.system
        camera = CameraInUse(model=snapshot.setup.camera, device=source.device or None)
        here = ToolInUse(
            marker=tool.marker,
            # A side that changes puts the calibration of the tool out of date, so that it is not in use.
            side_mm=system.tool.side_mm,
            tip_in_marker_mm=tool.marker_from_tool.translation_mm,
        )
        if camera.differs_from(certified_camera(system.camera)) or here.differs_from(
            certified_tool(system.marker, system.tool)
        ):
            raise CalibrationError(
                "ACCURACY_SYSTEM_CHANGED",
                "the camera, the tool or a calibration has changed during the accuracy test",
                "Begin the accuracy test again.",
            )
        return tool

    def _validate(self, before: tuple[DivotCapture, ...], one: DivotCapture) -> None:
        """Reject a capture in a wrong divot, or in a posture that the same divot has already.

        Raises:
            InvalidInput: ACCURACY_WRONG_DIVOT.
            CalibrationError: ACCURACY_POSTURE_REPEATED.
        """
        for other in (other for other in before if other.group == one.group):
            between = one.camera_from_marker.rotation @ other.camera_from_marker.rotation.T
            rotation_deg = float(np.degrees(np.linalg.norm(vector_from_rotation(between))))
            if rotation_deg < MIN_ROTATION_DEG:
                raise CalibrationError(
                    "ACCURACY_POSTURE_REPEATED",
                    f"the tool is rotated by {rotation_deg:.1f} degrees between the captures {other.title} "
                    f"and {one.title}, needed {MIN_ROTATION_DEG:g} degrees",
                    "Hold the tool upright, then tilted by about 30 degrees, then turned about its axis.",
                    {
                        "rotation_deg": rotation_deg,
                        "other": other.title,
                        "capture": one.title,
                        "needed_deg": MIN_ROTATION_DEG,
                    },
                )
        placement = [other for other in before if other.placement == one.placement]
        reject_wrong_divot(self._plate, [*placement, one])

    def _take_over(self) -> None:
        """Store a completed capture. Holds the lock."""
        if self._capture is None:
            return
        taken = self._capture.status.taken
        if taken is not None and not any(taken is one for one in self._captures):
            self._captures = (*self._captures, taken)

    def _assessment(self) -> AccuracyAssessment | InvalidInput:
        if self._assessed is None or self._assessed[0] is not self._captures:
            try:
                found: AccuracyAssessment | InvalidInput = assess(self._captures, self.system)
            except InvalidInput as error:
                found = error
            self._assessed = self._captures, found
        return self._assessed[1]

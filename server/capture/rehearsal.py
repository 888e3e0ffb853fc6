"""The rehearsal theatre as a source: each image is rendered just before it is due, in real time."""

import math
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from server.capture.shot import Shot
from server.errors import CaptureError
from server.live import CameraStatus

STOPS, STALLS = "camera_stops", "camera_stalls"
POLL_INTERVAL_S = 0.05
# Factor of the slowest recent rendering time; an earlier start competes with the tracking of the previous
# image.
RENDER_LEAD_RATIO = 1.5
SLOWEST_DECAY_RATIO = 0.95


class Renderer(Protocol):
    """Renders the theatre at a time of its own clock."""

    def image_at(self, at_s: float) -> npt.NDArray[np.uint8]:
        """Return the image (h, w, 3), BGR."""


class CameraOutage(Protocol):
    """A period in which the camera of the theatre sends no images."""

    @property
    def kind(self) -> str:
        """Kind of the event."""

    def is_on(self, at_s: float) -> bool:
        """Return whether the event is active."""

    def over_at_s(self, at_s: float) -> float:
        """Return the end of an active event."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlayedScene:
    """A scene that is being played.

    Attributes:
        scene_number: number of the order in this run of the server; 0 for the settings' scene.
        first_number: number of its first image.
    """

    scene_number: int = 0
    first_number: int = 0


class RehearsalSource:
    """Images of a simulated theatre.

    Image `number` always shows the theatre at `(number - first_number) / rate_hz` seconds of its own clock,
    where the first number is that of the start of the scene, so that the ground truth of an image follows
    from its number. On a machine too slow for the rate, images are skipped and counted; the motion keeps its
    speed.
    """

    def __init__(
        self,
        renderer: Renderer,
        *,
        rate_hz: float,
        stop: threading.Event,
        fast: bool = False,
        first_number: int = 0,
        last_number: int | None = None,
        played_scene: PlayedScene | None = None,
        outages: Sequence[CameraOutage] = (),
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.name = "rehearsal"
        self.waits_for_consumer = fast
        self.defect: CaptureError | None = None
        self.camera: CameraStatus | None = None
        self._lock = threading.Lock()
        self._renderer = renderer
        self._outages = tuple(outages)
        self._played_scene = played_scene or PlayedScene()
        self._rate_hz = rate_hz
        self._stop = stop
        self._clock = clock
        self._fast = fast
        self._number = first_number
        self._last_number = last_number
        self._epoch_s: float | None = None
        self._slowest_s = 0.0

    @property
    def stalls(self) -> bool:
        """Whether missing images mean an error."""
        return any(outage.kind == STALLS for outage in self._outages)

    @property
    def played_scene(self) -> PlayedScene:
        """The played scene."""
        return self._played_scene

    def play(self, renderer: Renderer, *, scene_number: int, outages: Sequence[CameraOutage]) -> None:
        """Play another scene from its beginning, with the next image. From any thread."""
        with self._lock:
            self._renderer = renderer
            self._outages = tuple(outages)
            # The next image may already be in rendering.
            self._played_scene = PlayedScene(scene_number=scene_number, first_number=self._due() + 1)

    def open(self) -> None:
        """Start the clock; the theatre's clock continues while its camera is silent."""
        if self._epoch_s is None:
            self._epoch_s = self._clock() - self._number / self._rate_hz

    def read(self) -> Shot | None:
        """Return the next image when it is due.

        Raises:
            CaptureError: REHEARSAL_CAMERA_STOPPED, during an event of the scene.
        """
        while not self._stop.is_set():
            if self._last_number is not None and self._number > self._last_number:
                return None
            with self._lock:
                renderer, first = self._renderer, self._played_scene.first_number
                self._number = max(self._due(), first)
                at_s = (self._number - first) / self._rate_hz
                outage = next((one for one in self._outages if _is_outage(one, at_s)), None)
            if outage is None:
                return self._shot(renderer, at_s)
            if not self._wait_out(outage, first, at_s):
                return None
        return None

    def close(self) -> None:
        """Do nothing, because nothing is open."""

    def _due(self) -> int:
        """Return the number of the next image."""
        if self._fast or self._epoch_s is None:
            return self._number
        return max(self._number, math.ceil((self._clock() - self._epoch_s) * self._rate_hz))

    def _shot(self, renderer: Renderer, at_s: float) -> Shot:
        if self._fast or self._epoch_s is None:
            captured_at_s = self._clock()
            image = renderer.image_at(at_s)
        else:
            # Like a camera's image it is available at once: rendered before it is due, and returned then. A
            # slower one has its age from its due time, not from the end of the rendering.
            captured_at_s = self._epoch_s + self._number / self._rate_hz
            self._wait_until(captured_at_s - RENDER_LEAD_RATIO * self._slowest_s)
            started_s = self._clock()
            image = renderer.image_at(at_s)
            self._slowest_s = max(self._clock() - started_s, SLOWEST_DECAY_RATIO * self._slowest_s)
            self._wait_until(captured_at_s)
        shot = Shot(image=image, number=self._number, captured_at_s=captured_at_s, source_time_s=at_s)
        self._number += 1
        return shot

    def _wait_until(self, at_s: float) -> None:
        self._stop.wait(max(0.0, at_s - self._clock()))

    def _wait_out(self, outage: CameraOutage, first: int, at_s: float) -> bool:
        """Wait during an outage; return False without real-time pacing if it never ends."""
        if self._fast:
            over_at_s = outage.over_at_s(at_s)
            if math.isinf(over_at_s):
                return False
            self._number = max(self._number + 1, first + math.ceil(over_at_s * self._rate_hz - 1e-6))
            return True
        if outage.kind == STOPS:
            raise CaptureError(
                "REHEARSAL_CAMERA_STOPPED",
                f"an event of the rehearsal stopped its camera at {at_s:.1f} s",
                "Wait until the event has ended, or play a scene without it.",
                {"at_s": at_s},
            )
        self._stop.wait(POLL_INTERVAL_S)
        return True


def _is_outage(outage: CameraOutage, at_s: float) -> bool:
    return outage.kind in (STOPS, STALLS) and outage.is_on(at_s)

"""The rehearsal theatre as a source: rendered just before it is due, so that its hand moves in real time."""

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
LOOK_AGAIN_S = 0.05
# Of the slowest recent rendering; one that begins earlier competes with the image that is tracked meanwhile.
RENDER_LEAD_RATIO = 1.5
SLOWEST_FADES_RATIO = 0.95


class Renderer(Protocol):
    """Draws the theatre at a time of its own clock."""

    def image_at(self, at_s: float) -> npt.NDArray[np.uint8]:
        """The image (h, w, 3), BGR."""


class Silence(Protocol):
    """A time in which the theatre's camera may give no image, as its kind says."""

    @property
    def kind(self) -> str:
        """What happens."""

    def is_on(self, at_s: float) -> bool:
        """Whether it is there at this time."""

    def over_at_s(self, at_s: float) -> float:
        """When it is over, once it is there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Begun:
    """A scene that is played.

    Attributes:
        scene_number: counts what was ordered while the server runs; 0 is what the settings say.
        first_number: of the image that showed its beginning.
    """

    scene_number: int = 0
    first_number: int = 0


class RehearsalSource:
    """Images of a theatre in software.

    Image `number` always shows the theatre at `(number - first_number) / rate_hz` seconds of its own clock,
    where the first number is that of the scene's beginning, so that the truth of an image follows from its
    number. A machine too slow for the rate leaves numbers out (they count as skipped); the hand keeps its
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
        begun: Begun | None = None,
        silences: Sequence[Silence] = (),
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.name = "rehearsal"
        self.waits_for_taker = fast
        self.defect: CaptureError | None = None
        self.camera: CameraStatus | None = None
        self._lock = threading.Lock()
        self._renderer = renderer
        self._silences = tuple(silences)
        self._begun = begun or Begun()
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
        """Whether silence means that something is wrong."""
        return any(silence.kind == STALLS for silence in self._silences)

    @property
    def begun(self) -> Begun:
        """What is played."""
        return self._begun

    def play(self, renderer: Renderer, *, scene_number: int, silences: Sequence[Silence]) -> None:
        """Play another scene from its beginning, with the next image. From any thread."""
        with self._lock:
            self._renderer = renderer
            self._silences = tuple(silences)
            # The one that is due may be on its way already.
            self._begun = Begun(scene_number=scene_number, first_number=self._due() + 1)

    def open(self) -> None:
        """The next image is due now; the theatre's clock goes on while its camera is silent."""
        if self._epoch_s is None:
            self._epoch_s = self._clock() - self._number / self._rate_hz

    def read(self) -> Shot | None:
        """The next image when it is due.

        Raises:
            CaptureError: REHEARSAL_CAMERA_STOPPED, as the events say.
        """
        while not self._stop.is_set():
            if self._last_number is not None and self._number > self._last_number:
                return None
            with self._lock:
                renderer, first = self._renderer, self._begun.first_number
                self._number = max(self._due(), first)
                at_s = (self._number - first) / self._rate_hz
                silence = next((one for one in self._silences if _is_silent(one, at_s)), None)
            if silence is None:
                return self._shot(renderer, at_s)
            if not self._pass_over(silence, first, at_s):
                return None
        return None

    def close(self) -> None:
        """Nothing is held open."""

    def _due(self) -> int:
        """The number of the image that is due next."""
        if self._fast or self._epoch_s is None:
            return self._number
        return max(self._number, math.ceil((self._clock() - self._epoch_s) * self._rate_hz))

    def _shot(self, renderer: Renderer, at_s: float) -> Shot:
        if self._fast or self._epoch_s is None:
            captured_at_s = self._clock()
            image = renderer.image_at(at_s)
        else:
            # A camera's image is there at once: this one is rendered before it is due, and given when it is.
            # One that takes longer has its age from when it was due, not from the end of its rendering.
            captured_at_s = self._epoch_s + self._number / self._rate_hz
            self._wait_until(captured_at_s - RENDER_LEAD_RATIO * self._slowest_s)
            started_s = self._clock()
            image = renderer.image_at(at_s)
            self._slowest_s = max(self._clock() - started_s, SLOWEST_FADES_RATIO * self._slowest_s)
            self._wait_until(captured_at_s)
        shot = Shot(image=image, number=self._number, captured_at_s=captured_at_s, source_time_s=at_s)
        self._number += 1
        return shot

    def _wait_until(self, at_s: float) -> None:
        self._stop.wait(max(0.0, at_s - self._clock()))

    def _pass_over(self, silence: Silence, first: int, at_s: float) -> bool:
        """Be silent; False where images are taken as fast as they come, and none comes any more."""
        if self._fast:
            over_at_s = silence.over_at_s(at_s)
            if math.isinf(over_at_s):
                return False
            self._number = max(self._number + 1, first + math.ceil(over_at_s * self._rate_hz - 1e-6))
            return True
        if silence.kind == STOPS:
            raise CaptureError(
                "REHEARSAL_CAMERA_STOPPED",
                f"the rehearsal's camera gives no images since {at_s:.1f} s, as its events say",
                "Wait until the event is over, or play a scene without it.",
                {"at_s": at_s},
            )
        self._stop.wait(LOOK_AGAIN_S)
        return True


def _is_silent(silence: Silence, at_s: float) -> bool:
    return silence.kind in (STOPS, STALLS) and silence.is_on(at_s)

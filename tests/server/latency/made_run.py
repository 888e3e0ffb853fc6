"""A measurement in simulated time: codes, a camera, a server and a page with known delays."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from server.latency import ClockComparison, LatencyReport, PaintedCode, ReadImage, ShownImage, latency_report

CODES = 250


@dataclass(slots=True, kw_only=True)
class Run:
    """What a page and a server would have noted.

    Attributes:
        codes: how many are painted.
        cycle: so many different ones, again and again.
        code_ms: a code stands for so long, and for up to half as long again.
        period_ms: of the camera.
        camera_ms: from the light to the stamp of the capture.
        tracking_ms, server_ms, line_ms, page_ms: of the other stages.
        ahead_ms: server's clock before the page's, at the beginning.
        drift_ratio: by how much the server's clock is faster.
        blind: numbers of images in which no code is read, though they show one.
        unseen: numbers of images that the page does not show.
        unlooked: numbers of images that the server does not look at.
    """

    codes: int = 160
    cycle: int = CODES
    code_ms: float = 100.0
    period_ms: float = 33.0
    camera_ms: float = 40.0
    tracking_ms: float = 12.0
    server_ms: float = 6.0
    line_ms: float = 4.0
    page_ms: float = 10.0
    ahead_ms: float = 500_000.0
    drift_ratio: float = 0.0
    blind: frozenset[int] = frozenset()
    unseen: frozenset[int] = frozenset()
    unlooked: frozenset[int] = frozenset()
    seed: int = 1
    painted: list[PaintedCode] = field(init=False)
    shown: list[ShownImage] = field(init=False)
    read: list[ReadImage] = field(init=False)
    comparisons: list[ClockComparison] = field(init=False)

    def __post_init__(self) -> None:
        random = np.random.default_rng(self.seed)
        stands_ms = random.uniform(self.code_ms, 1.5 * self.code_ms, self.codes)
        at_ms = 1000.0 + np.concatenate([[0.0], np.cumsum(stands_ms)[:-1]])
        self.painted = [
            PaintedCode(code=index % self.cycle, painted_at_ms=float(one)) for index, one in enumerate(at_ms)
        ]
        self.shown, self.read = [], []
        end_ms = float(at_ms[-1] + stands_ms[-1])
        for number, exposed_ms in enumerate(np.arange(990.0, end_ms, self.period_ms)):
            place = int(np.searchsorted(at_ms, exposed_ms, side="right")) - 1
            code = None if place < 0 or number in self.blind else self.painted[place].code
            self._take(number, float(exposed_ms) + self.camera_ms, code)
        self.comparisons = [self._compared(float(at)) for at in np.arange(900.0, end_ms, 500.0)]

    def _take(self, number: int, captured_ms: float, code: int | None) -> None:
        concluded_ms = captured_ms + self.tracking_ms
        sent_ms = concluded_ms + self.server_ms
        received_ms = sent_ms + self.line_ms
        if number not in self.unlooked:
            self.read.append(
                ReadImage(
                    image_number=number,
                    captured_at_s=self.server_s(captured_ms),
                    concluded_at_s=self.server_s(concluded_ms),
                    code=code,
                )
            )
        if number not in self.unseen:
            self.shown.append(
                ShownImage(
                    image_number=number,
                    sent_at_s=self.server_s(sent_ms),
                    received_at_ms=received_ms,
                    shown_at_ms=received_ms + self.page_ms,
                )
            )

    def _compared(self, requested_ms: float) -> ClockComparison:
        return ClockComparison(
            requested_at_ms=requested_ms,
            responded_at_ms=requested_ms + 3.0,
            server_s=self.server_s(requested_ms + 1.5),
        )

    def server_s(self, page_ms: float) -> float:
        """The server's clock at a page time."""
        return (page_ms * (1.0 + self.drift_ratio) + self.ahead_ms) / 1000.0

    @property
    def after_capture_ms(self) -> float:
        """Everything except the screen and the camera."""
        return self.tracking_ms + self.server_ms + self.line_ms + self.page_ms

    def first_shown_ms(self, places: Sequence[int]) -> list[float]:
        """Latency of each of these codes, computed from the light alone."""
        exposed_ms = [one.shown_at_ms - self.after_capture_ms - self.camera_ms for one in self.shown]
        return [
            next(at for at in exposed_ms if at >= self.painted[place].painted_at_ms)
            - self.painted[place].painted_at_ms
            + self.camera_ms
            + self.after_capture_ms
            for place in places
        ]

    def report(self, min_timed: int = 100) -> LatencyReport:
        return latency_report(
            painted=self.painted,
            read=self.read,
            shown=self.shown,
            comparisons=self.comparisons,
            min_timed=min_timed,
        )

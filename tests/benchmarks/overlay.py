"""Time of everything after tracking, which the server does once per image for all viewers."""

import dataclasses
import time
from collections.abc import Iterator
from contextlib import contextmanager

import cv2
import numpy as np

from server.alarms import AlarmService
from server.capture.shot import Shot
from server.config import Config, VideoConfig
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from server.loop.tracking import Tracking
from server.overlay import draw_overlay, encode_jpeg
from server.setup import Preparation, build_setup
from tests.benchmarks.offline import Image
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.tables import Table, pair
from tracker.navigation import Absent, NavigationSnapshot
from tracker.registration import Registration

SIZES_WH_PX = ((1280, 720), (1920, 1080))
DRILLING_AT_S = 16.0
RATE_HZ = 30.0
REPEATS, WARMING = 150, 10
# The theatre knows its registration exactly, and then there is little to work out; a good one by points has
# this much.
REGISTERED_SD_MM, REGISTERED_SD_DEG = 0.4, 0.4
SOURCE = SourceStatus(name="benchmark", state=SourceState.RUNNING)
PROCESS = ProcessStatus(state=ProcessState.RUNNING)


@dataclasses.dataclass(slots=True)
class StageTimes:
    """Milliseconds of each image."""

    watch: list[float] = dataclasses.field(default_factory=list)
    navigation: list[float] = dataclasses.field(default_factory=list)
    alarms: list[float] = dataclasses.field(default_factory=list)
    overlay: list[float] = dataclasses.field(default_factory=list)

    @property
    def together(self) -> list[float]:
        """Return the sum for each image."""
        parts = (self.watch, self.navigation, self.alarms, self.overlay)
        return [sum(one) for one in zip(*parts, strict=True)]


def measure_overlay(options: BenchmarkOptions) -> list[Table]:
    """Navigation, alarms and overlay together on one core, and overlay and encoding as they run."""
    rows, drawing = [], []
    for size in SIZES_WH_PX:
        preparation, shots = _drilling(options, size)
        spent, newest = _measured(preparation, shots)
        said = f"{size[0]}x{size[1]}"
        parts = (spent.watch, spent.navigation, spent.alarms, spent.overlay, spent.together)
        rows.append([said, *(pair(part[WARMING:], 99.0) for part in parts)])
        drawing.append(_drawing(said, shots[-1].image, newest))
    return [
        Table(
            title="Processor time on one core, median / 99th percentile, ms",
            columns=["size", "watch", "navigation", "alarms", "overlay", "together"],
            rows=rows,
            note=f"Registered with {REGISTERED_SD_MM} mm and {REGISTERED_SD_DEG} deg of uncertainty.",
        ),
        Table(
            title="Time of drawing and encoding as they run",
            columns=["size", "overlay ms", "encode ms", "JPEG kB"],
            rows=drawing,
        ),
    ]


def _drilling(options: BenchmarkOptions, size_wh_px: tuple[int, int]) -> tuple[Preparation, list[Shot]]:
    """Return the setup and a few images, which are repeated."""
    settings = options.settings_of(options.seeds[0], size_wh_px)
    reported = dataclasses.asdict(settings)
    width, height = reported.pop("size_wh_px")
    known = {"seed", "noise", "blur", "clutter", "light"}
    rehearsal = {name: value for name, value in reported.items() if name in known}
    config = Config.model_validate({"rehearsal": {**rehearsal, "width": width, "height": height}})
    preparation = build_setup(config)
    registration, theatre = preparation.registration, preparation.theatre
    if isinstance(registration, Absent) or theatre is None:
        raise RuntimeError("the rehearsal theatre is registered")
    sds = np.array([REGISTERED_SD_MM] * 3 + [np.radians(REGISTERED_SD_DEG)] * 3)
    unsure = Registration(
        method=registration.method,
        anchored_to=registration.anchored_to,
        anchor_from_vertebra=registration.anchor_from_vertebra,
        covariance=np.diag(sds**2),
    )
    renderer = theatre.renderer()
    images = [renderer.image_at(DRILLING_AT_S + number / RATE_HZ) for number in range(10)]
    shots = [
        Shot(
            image=images[number % len(images)],
            number=number,
            captured_at_s=DRILLING_AT_S + number / RATE_HZ,
            source_time_s=DRILLING_AT_S + number / RATE_HZ,
        )
        for number in range(WARMING + REPEATS)
    ]
    return dataclasses.replace(preparation, registration=unsure), shots


def _measured(preparation: Preparation, shots: list[Shot]) -> tuple[StageTimes, NavigationSnapshot]:
    tracking, spent, now_s = Tracking(preparation), StageTimes(), [0.0]
    service = AlarmService(Config(), clock=lambda: now_s[0])
    snapshot: NavigationSnapshot | None = None
    with one_thread():
        for shot in shots:
            snapshot = tracking.process(shot, skipped_images=0, clock=time.thread_time)
            now_s[0] = shot.captured_at_s + 0.02
            started_s = time.thread_time()
            alarms = service.observe(snapshot, SOURCE, PROCESS)
            looked_s = time.thread_time()
            draw_overlay(shot.image, snapshot, alarms)
            spent.overlay.append((time.thread_time() - looked_s) * 1e3)
            spent.alarms.append((looked_s - started_s) * 1e3)
            spent.watch.append(snapshot.stage_ms["watch"])
            spent.navigation.append(snapshot.stage_ms["navigation"])
    if snapshot is None or not snapshot.analyses:
        raise RuntimeError("nothing was judged")
    return spent, snapshot


def _drawing(said: str, image: Image, snapshot: NavigationSnapshot) -> list[str]:
    overlay_ms, encode_ms, jpeg = [], [], b""
    for _ in range(WARMING + REPEATS):
        started = time.perf_counter()
        drawn = draw_overlay(image, snapshot)
        drawn_s = time.perf_counter()
        jpeg = encode_jpeg(drawn, VideoConfig().jpeg_quality)
        overlay_ms.append((drawn_s - started) * 1e3)
        encode_ms.append((time.perf_counter() - drawn_s) * 1e3)
    return [
        f"{said}, {cv2.getNumThreads()} thread(s)",
        pair(overlay_ms[WARMING:], 99.0),
        pair(encode_ms[WARMING:], 99.0),
        f"{len(jpeg) / 1000:.0f}",
    ]


@contextmanager
def one_thread() -> Iterator[None]:
    """Run OpenCV on one thread within the block."""
    before = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        yield
    finally:
        cv2.setNumThreads(before)

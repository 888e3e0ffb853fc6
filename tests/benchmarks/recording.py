"""What recording costs: an image of the recording process, and the little that the live path adds."""

import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import zstandard

from server.capture.shot import Shot
from server.config import Config
from server.image_file import decoded
from server.live import SourceState, SourceStatus
from server.logs import LogSettings
from server.loop.report import Report, ReportPacker
from server.loop.ring import RECORDED_SLOTS, SLOTS, ImageRing
from server.loop.tracking import Tracking
from server.loop.tracking_state import tracking_state_bytes
from server.recording.messages import session_message
from server.recording.process import Recording, RecordingOrder, RingChanged
from server.recording_file import ImagePacker, WriterLimits
from server.setup import build_setup
from tests.benchmarks.offline import Image
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.section_result import SectionResult
from tests.benchmarks.tables import Table, median, number, pair

SIZE_WH_PX = (1280, 720)
DRILLING_AT_S, RATE_HZ = 14.0, 30.0
IMAGES, WARMING = 60, 10
JPEG_QUALITY = 90
SOURCE = SourceStatus(name="benchmark", state=SourceState.RUNNING)
BUDGET_PERCENT = 10


def measure_recording(options: BenchmarkOptions) -> SectionResult:
    """Measure packing, the whole recording process, and the live path at 1280x720."""
    width, height = SIZE_WH_PX
    rehearsal = {"width": width, "height": height, "seed": options.seeds[0], "reference": True}
    config = Config.model_validate({"rehearsal": rehearsal})
    preparation = build_setup(config)
    if preparation.theatre is None:
        raise RuntimeError("the rehearsal has no theatre")
    renderer = preparation.theatre.renderer()
    times_s = [DRILLING_AT_S + n / RATE_HZ for n in range(IMAGES)]
    images = [np.asarray(renderer.image_at(at_s), np.uint8) for at_s in times_s]
    jpegs = [_jpeg(image) for image in images]
    from_jpegs = [image for jpeg in jpegs if (image := decoded(jpeg)) is not None]
    tracking = Tracking(preparation)
    rows = [
        _recorded("lossless", config, tracking, images, [b""] * IMAGES),
        _recorded("the source's JPEG", config, tracking, from_jpegs, jpegs),
        _recorded("lossless, grey", config, tracking, [_grey(image) for image in images], [b""] * IMAGES),
    ]
    return SectionResult(
        tables=[
            _packing_table(images),
            Table(
                title="The recording process, processor time of an image of 1280x720 at 30 Hz",
                columns=["images", "ms, median / 95th", "of a core", "MB an image", "GB an hour"],
                rows=rows,
                note=f"With messages and checksums; the budget is {BUDGET_PERCENT} % of a core. "
                "Without a state, which takes a tenth of a second once in a recording.",
            ),
            _live_table(tracking, images, jpegs),
        ]
    )


def _jpeg(image: Image) -> bytes:
    return cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])[1].tobytes()


def _png(image: Image) -> bytes:
    return cv2.imencode(".png", image, [cv2.IMWRITE_PNG_COMPRESSION, 1])[1].tobytes()


def _grey(image: Image) -> Image:
    return np.repeat(image[:, :, 1:2], 3, axis=2)


def _packing_table(images: list[Image]) -> Table:
    packer, level_1 = ImagePacker(), zstandard.ZstdCompressor(level=1)
    ways: dict[str, Callable[[Image], bytes]] = {
        "PNG, level 1": _png,
        "Zstandard, level 1": lambda image: level_1.compress(image.data),
        "row differences, Zstandard without search (as recorded)": lambda image: packer.pack(image).content,
    }
    rows = []
    for name, pack in ways.items():
        took_ms, sizes = [], []
        for image in images[:20]:
            began_s = time.process_time()
            sizes.append(len(pack(image)))
            took_ms.append((time.process_time() - began_s) * 1e3)
        rows.append([name, pair(took_ms[2:], 95.0), number(float(np.mean(sizes)) / 1e6)])
    return Table(
        title="Packing an image of 1280x720 without loss",
        columns=["way", "ms, median / 95th", "MB"],
        rows=rows,
    )


def _recorded(
    name: str, config: Config, tracking: Tracking, images: list[Image], jpegs: list[bytes]
) -> list[str]:
    """Return a row: track, and record each image; only the recording is timed."""
    packer, ring = ReportPacker(), ImageRing(slots=SLOTS)
    took_ms: list[float] = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.mcap"
        session = session_message(
            config, case_id="0" * 16, started_at="", unix_offset_s=0.0, product_version="benchmark"
        )
        limits = WriterLimits(max_bytes=1e12, min_free_bytes=0.0)
        order = RecordingOrder(path=path, limits=limits, session=session, log=LogSettings(as_json=True))
        recording = Recording(order, send=lambda _: None)
        recording.take(RingChanged(ring=ring))
        began_bytes = 0
        for number_of, (image, jpeg) in enumerate(zip(images, jpegs, strict=True)):
            at_s = DRILLING_AT_S + number_of / RATE_HZ
            state = ring.write_state(tracking_state_bytes(tracking)) if number_of == 0 else 0
            shot = Shot(image=image, number=number_of, captured_at_s=at_s, source_time_s=at_s)
            snapshot = tracking.process(shot, skipped_images=0)
            report = Report(source=SOURCE, snapshot=snapshot, tracked_images=number_of + 1, state=state)
            ring.write(packer.pack(report), image, encoded=jpeg)
            if number_of == WARMING:
                recording.read_all()
                began_bytes = recording.status().written_bytes
            began_s = time.process_time()
            recording.read_newer()
            recording.tick()
            took_ms.append((time.process_time() - began_s) * 1e3)
        recording.read_all()
        recording.close()
        size_mb = (path.stat().st_size - began_bytes) / (len(images) - WARMING) / 1e6
    core = median(took_ms[WARMING:]) * RATE_HZ / 10.0
    gb_an_hour = size_mb * RATE_HZ * 3.6
    return [name, pair(took_ms[WARMING:], 95.0), f"{core:.0f} %", number(size_mb), number(gb_an_hour, 0)]


def _live_table(tracking: Tracking, images: list[Image], jpegs: list[bytes]) -> Table:
    rows = []
    for name, slots, with_jpeg in (
        (f"ring of {SLOTS} slots", SLOTS, False),
        (f"ring of {RECORDED_SLOTS} slots", RECORDED_SLOTS, False),
        (f"ring of {RECORDED_SLOTS} slots, with a JPEG", RECORDED_SLOTS, True),
    ):
        ring, took_ms = ImageRing(slots=slots), []
        # Twice around, so that all memory was touched.
        for image, jpeg in [*zip(images, jpegs, strict=True)] * 2:
            began_s = time.perf_counter()
            ring.write(b"r" * 8000, image, encoded=jpeg if with_jpeg else b"")
            took_ms.append((time.perf_counter() - began_s) * 1e3)
        rows.append([f"an image into a {name}", pair(took_ms[len(images) :], 95.0)])
    ring, took_ms = ImageRing(), []
    for _ in range(20):
        began_s = time.perf_counter()
        ring.write_state(tracking_state_bytes(tracking))
        took_ms.append((time.perf_counter() - began_s) * 1e3)
    rows.append(["the state of tracking, once in a recording", pair(took_ms[2:], 95.0)])
    return Table(title="The live path", columns=["step", "ms, median / 95th"], rows=rows)

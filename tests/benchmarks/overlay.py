"""Time of drawing the overlay and of encoding it, which the server does once per image for all viewers."""

import time

import cv2

from server.config import VideoConfig
from server.overlay import draw_overlay, encode_jpeg
from tests.benchmarks.asked import Asked
from tests.benchmarks.offline import setup_of
from tests.benchmarks.tables import Table, pair
from tracker.navigation import navigate
from tracker.pipeline import Tracker
from tracker.rehearsal import Theatre

SIZES_WH_PX = ((1280, 720), (1920, 1080))
DRILLING_AT_S = 16.0
REPEATS, WARMING = 150, 10


def measure_overlay(asked: Asked) -> list[Table]:
    """Overlay and encoding of one image of the drilling, at both sizes."""
    rows = [_row(asked, size) for size in SIZES_WH_PX]
    return [Table(title="", columns=["size", "overlay ms", "encode ms", "JPEG kB"], rows=rows)]


def _row(asked: Asked, size_wh_px: tuple[int, int]) -> list[str]:
    theatre = Theatre(asked.settings_of(asked.seeds[0], size_wh_px))
    image = theatre.renderer().image_at(DRILLING_AT_S)
    sightings = Tracker(camera=theatre.camera, models=[theatre.marker]).search(image)
    snapshot = navigate(
        setup=setup_of(theatre),
        sightings=sightings,
        image_number=480,
        captured_at_s=DRILLING_AT_S,
        size_wh_px=size_wh_px,
        stage_ms={},
        skipped_images=0,
    )
    overlay_ms, encode_ms, jpeg = [], [], b""
    for _ in range(WARMING + REPEATS):
        started = time.perf_counter()
        drawn = draw_overlay(image, snapshot)
        drawn_s = time.perf_counter()
        jpeg = encode_jpeg(drawn, VideoConfig().jpeg_quality)
        overlay_ms.append((drawn_s - started) * 1e3)
        encode_ms.append((time.perf_counter() - drawn_s) * 1e3)
    return [
        f"{size_wh_px[0]}x{size_wh_px[1]}, {cv2.getNumThreads()} thread(s)",
        pair(overlay_ms[WARMING:], 99.0),
        pair(encode_ms[WARMING:], 99.0),
        f"{len(jpeg) / 1000:.0f}",
    ]

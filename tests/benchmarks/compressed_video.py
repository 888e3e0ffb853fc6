"""Pose error and its stated uncertainty in compressed video.

    PYTHONPATH=. python -m tests.benchmarks.compressed_video [--images 50] [--faces 3] [--cameras HD,A]

A moving marker of known pose is rendered, coded, decoded and tracked. Codecs that OpenCV cannot write need
`ffmpeg` on the path; without it those rows are left out.
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from tests.benchmarks.limits.evaluation import Evaluation, Outcome, claim_of, evaluate
from tests.benchmarks.limits.finders import tracker_of
from tests.benchmarks.limits.run import one_thread
from tests.benchmarks.machine import machine_line
from tests.benchmarks.scenes.faces import FACES
from tests.benchmarks.scenes.hand import hand_scenes
from tests.benchmarks.scenes.rigs import RIG_A, RIG_HD, Rig
from tests.benchmarks.scenes.scene import Scene, image_of
from tests.benchmarks.tables import Table, number, pair, share
from tests.tracker.scenes import Image8

CAMERAS = {"HD": RIG_HD, "A": RIG_A}
SPEEDS = ("still", "slow", "normal")
# Scenes are rendered at 60 images a second, and every second one is coded.
EVERY = 2
RATE_HZ = 30


@dataclass(frozen=True, slots=True, kw_only=True)
class Codec:
    """A way to code images: JPEG by quality, or video by FFmpeg options; neither keeps them."""

    name: str
    jpeg_quality: int = 0
    options: Sequence[str] = ()

    @property
    def is_predicted(self) -> bool:
        """Return whether images are predicted from earlier ones."""
        return bool(self.options)


def _video(name: str, *options: str) -> Codec:
    return Codec(name=name, options=options)


LIVE_H264 = ("-c:v", "libx264", "-preset", "veryfast", "-tune", "zerolatency", "-crf")
LIVE_H265 = ("-c:v", "libx265", "-preset", "fast", "-x265-params", "log-level=none", "-crf")
CODECS = (
    Codec(name="none"),
    *(Codec(name=f"JPEG {quality}", jpeg_quality=quality) for quality in (70, 40, 20)),
    *(_video(f"MPEG-4 q {q}", "-c:v", "mpeg4", "-q:v", q) for q in ("3", "6", "12")),
    *(_video(f"H.264 crf {crf}", *LIVE_H264, crf) for crf in ("18", "24", "30")),
    *(_video(f"H.265 crf {crf}", *LIVE_H265, crf) for crf in ("18", "24", "30")),
    _video("VP9 crf 32", "-c:v", "libvpx-vp9", "-deadline", "realtime", "-crf", "32", "-b:v", "0"),
)


def main() -> None:
    """Print one table for each camera and speed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--images", type=int, default=50, help="of each face")
    parser.add_argument("--faces", type=int, default=3)
    parser.add_argument("--cameras", default=",".join(CAMERAS))
    given = parser.parse_args()
    usable = [one for one in CODECS if not one.is_predicted or shutil.which("ffmpeg")]
    sys.stdout.write(f"{machine_line()}\n\n")
    with one_thread():
        for camera in given.cameras.split(","):
            for speed in SPEEDS:
                films = [
                    _film(CAMERAS[camera], speed, nth=nth, images=given.images) for nth in range(given.faces)
                ]
                rows = [_row(one, CAMERAS[camera], films) for one in usable]
                sys.stdout.write(
                    Table(title=f"Camera {camera}, {speed}", columns=COLUMNS, rows=rows).markdown
                )
                sys.stdout.write("\n")


@dataclass(frozen=True, slots=True, kw_only=True)
class Film:
    """Rendered images of a moving marker, with their scenes."""

    nth: int
    scenes: list[tuple[float, Scene]]
    images: list[Image8]


def _film(rig: Rig, speed: str, *, nth: int, images: int) -> Film:
    scenes = list(hand_scenes(rig, FACES[nth % len(FACES)], speed, seed=nth, count=EVERY * images))[::EVERY]
    return Film(nth=nth, scenes=scenes, images=[image_of(scene) for _, scene in scenes])


COLUMNS = ["codec", "images", "found", "tip mm", "inside 95 %: translation", "rotation", "tip"]


def _row(codec: Codec, rig: Rig, films: Sequence[Film]) -> list[str]:
    seen = [one for film in films for one in _evaluations(codec, rig, film)]
    found = [one for one in seen if one.outcome is Outcome.CORRECT]
    inside = np.array([one.covered for one in found]).sum(axis=0)
    tips_mm = [one.errors["tip_mm"] for one in found]
    return [
        codec.name,
        number(len(seen), 0),
        share(len(found), len(seen)),
        pair(tips_mm, 95.0),
        *(share(int(count), len(found)) for count in inside),
    ]


def _evaluations(codec: Codec, rig: Rig, film: Film) -> Iterator[Evaluation]:
    face = FACES[film.nth % len(FACES)]
    tracker = tracker_of(rig, [face])
    for (at_s, scene), image in zip(film.scenes, _decoded(codec, film.images), strict=True):
        sighting = tracker.step(image, captured_at_s=at_s, is_predicted=codec.is_predicted)[face.name]
        yield evaluate(scene, claim_of(sighting))


def _decoded(codec: Codec, images: Sequence[Image8]) -> list[Image8]:
    """Return the images after coding and decoding, in grey."""
    if codec.jpeg_quality:
        settings = [cv2.IMWRITE_JPEG_QUALITY, codec.jpeg_quality]
        coded = [cv2.imencode(".jpg", image, settings)[1] for image in images]
        return [np.asarray(cv2.imdecode(one, cv2.IMREAD_GRAYSCALE), dtype=np.uint8) for one in coded]
    if not codec.options:
        return list(images)
    height, width = images[0].shape
    raw = ["-f", "rawvideo", "-pix_fmt", "gray"]
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "film.mkv")
        source = [*raw, "-s", f"{width}x{height}", "-r", str(RATE_HZ), "-i", "-"]
        _ffmpeg([*source, *codec.options, "-g", str(RATE_HZ), "-pix_fmt", "yuv420p", path], images)
        pixels = _ffmpeg(["-i", path, *raw, "-"], [])
    return list(np.frombuffer(pixels, np.uint8).reshape(-1, height, width))


def _ffmpeg(options: Sequence[str], images: Sequence[Image8]) -> bytes:
    program = shutil.which("ffmpeg") or "ffmpeg"
    piped = b"".join(image.tobytes() for image in images)
    done = subprocess.run(
        [program, "-loglevel", "error", *options], input=piped, capture_output=True, check=True
    )
    return done.stdout


if __name__ == "__main__":
    main()

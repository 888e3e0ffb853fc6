"""Damaged JPEGs of a tracked marker: how many are rejected, and the errors of the tip in the others.

    PYTHONPATH=. python -m tests.benchmarks.damaged_images [--images 100] [--faces 3] [--camera HD]

A moving marker of known pose is rendered with noise of its own in each colour, and coded as a camera does.
Before each damaged image the tracker has tracked intact ones only. The last table has the time of decoding.
"""

import argparse
import copy
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from server.image_file import DamagedJpeg, decode_jpeg
from tests.benchmarks.limits.evaluation import Evaluation, Outcome, claim_of, evaluate
from tests.benchmarks.limits.finders import tracker_of
from tests.benchmarks.limits.run import one_thread
from tests.benchmarks.machine import machine_line
from tests.benchmarks.scenes.faces import FACES
from tests.benchmarks.scenes.hand import hand_scenes
from tests.benchmarks.scenes.rigs import RIG_A, RIG_HD, Rig
from tests.benchmarks.scenes.scene import Scene, image_of
from tests.benchmarks.tables import Table, median, number, pair, share
from tests.tracker.scenes import Image8
from tracker import Tracker

CAMERAS = {"HD": RIG_HD, "A": RIG_A}
CODED = (cv2.IMWRITE_JPEG_QUALITY, 85, cv2.IMWRITE_JPEG_SAMPLING_FACTOR, cv2.IMWRITE_JPEG_SAMPLING_FACTOR_422)
# Scenes are rendered at 60 images a second, and every second one is taken.
EVERY = 2
LEARNT_IMAGES = 5
COLOUR_NOISE = 2.0
MAX_TIP_MM = 2.0
TIMED_SIZE_WH_PX = (1920, 1296)
TIMED = 40

CELLS = ("shown", "found", "off", "tip mm", "inside")

Damage = Callable[[bytes, bytes, np.random.Generator], bytes]


def _flipped(bits: int) -> Damage:
    def damaged(jpeg: bytes, _: bytes, random: np.random.Generator) -> bytes:
        content = bytearray(jpeg)
        for at in random.integers(2, len(content), bits):
            content[at] ^= 1 << random.integers(8)
        return bytes(content)

    return damaged


def _gap(size: int) -> Damage:
    def damaged(jpeg: bytes, _: bytes, random: np.random.Generator) -> bytes:
        at = int(random.integers(2, len(jpeg) - size))
        return jpeg[:at] + jpeg[at + size :]

    return damaged


def _cut(jpeg: bytes, _: bytes, random: np.random.Generator) -> bytes:
    return jpeg[: int(random.integers(2, len(jpeg)))]


def _spliced(jpeg: bytes, after: bytes, random: np.random.Generator) -> bytes:
    at = int(random.integers(2, min(len(jpeg), len(after))))
    return jpeg[:at] + after[at:]


DAMAGES: dict[str, Damage] = {
    "1 bit": _flipped(1),
    "8 bits": _flipped(8),
    "gap of 16 bytes": _gap(16),
    "gap of 512 bytes": _gap(512),
    "gap of 3072 bytes": _gap(3072),
    "cut off": _cut,
    "two images": _spliced,
}


def main(arguments: list[str] | None = None) -> None:
    """Print a table of damages and one of times."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--images", type=int, default=100, help="of each face and damage")
    parser.add_argument("--faces", type=int, default=3)
    parser.add_argument("--camera", choices=CAMERAS, default="HD")
    given = parser.parse_args(arguments)
    sys.stdout.write(f"{machine_line()}\n\n")
    with one_thread():
        # The last image is only a part of the one before it.
        images = LEARNT_IMAGES + given.images + 1
        films = [_film(CAMERAS[given.camera], nth, images) for nth in range(given.faces)]
        shown = [one for film in films for one in _shown(film)]
        sys.stdout.write(_table(given.camera, shown).markdown + "\n" + _times().markdown)


@dataclass(frozen=True, slots=True, kw_only=True)
class Film:
    """Images of a moving marker as a camera sends them, with times and scenes."""

    rig: Rig
    nth: int
    scenes: list[tuple[float, Scene]]
    jpegs: list[bytes]


@dataclass(frozen=True, slots=True, kw_only=True)
class Shown:
    """One damaged image.

    Attributes:
        damage: Kind of damage; empty for an intact image.
        is_rejected: Whether it is not decoded here.
        before: Of the image that OpenCV decodes; None if it decodes none.
    """

    damage: str
    is_rejected: bool
    before: Evaluation | None


def _film(rig: Rig, nth: int, images: int) -> Film:
    face = FACES[nth % len(FACES)]
    scenes = list(hand_scenes(rig, face, "slow", seed=nth, count=EVERY * images))[::EVERY]
    random = np.random.default_rng(nth)
    return Film(rig=rig, nth=nth, scenes=scenes, jpegs=[_coded(image_of(one), random) for _, one in scenes])


def _coded(image: Image8, random: np.random.Generator) -> bytes:
    colours = image[:, :, None] + COLOUR_NOISE * random.standard_normal((*image.shape, 3))
    return cv2.imencode(".jpg", np.clip(np.rint(colours), 0, 255).astype(np.uint8), CODED)[1].tobytes()


def _shown(film: Film) -> Iterator[Shown]:
    face = FACES[film.nth % len(FACES)]
    tracker = tracker_of(film.rig, [face])
    random = np.random.default_rng(film.nth)
    for index, (at_s, scene) in enumerate(film.scenes[:-1]):
        jpeg, after = film.jpegs[index : index + 2]
        if index >= LEARNT_IMAGES:
            for name, damage in DAMAGES.items():
                content = damage(jpeg, after, random)
                image = cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_COLOR)
                seen = None
                if image is not None and image.shape[1::-1] == film.rig.size_wh_px:
                    seen = _evaluation(copy.deepcopy(tracker), image, at_s, scene)
                yield Shown(
                    damage=name, is_rejected=isinstance(decode_jpeg(content), DamagedJpeg), before=seen
                )
        image = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
        seen = _evaluation(tracker, np.asarray(image), at_s, scene)
        if index >= LEARNT_IMAGES:
            yield Shown(damage="", is_rejected=isinstance(decode_jpeg(jpeg), DamagedJpeg), before=seen)


def _evaluation(tracker: Tracker, image: np.ndarray, at_s: float, scene: Scene) -> Evaluation:
    (sighting,) = tracker.step(image, captured_at_s=at_s).values()
    return evaluate(scene, claim_of(sighting))


def _table(camera: str, shown: Sequence[Shown]) -> Table:
    rows = []
    for name in ("", *DAMAGES):
        of_damage = [one for one in shown if one.damage == name]
        decoded = [one.before for one in of_damage if one.before is not None]
        used = [one.before for one in of_damage if one.before is not None and not one.is_rejected]
        rejected = sum(one.is_rejected for one in of_damage)
        counts = [str(len(of_damage)), share(rejected, len(of_damage))]
        rows.append([name or "none", *counts, *_cells(decoded), *_cells(used)])
    return Table(
        title=f"Damaged JPEGs, camera {camera}",
        columns=[
            "damage",
            "images",
            "rejected",
            *(f"{cell}, {decoder}" for decoder in ("OpenCV", "here") for cell in CELLS),
        ],
        rows=rows,
        note=f"off: tip off by over {MAX_TIP_MM:g} mm, or the marker claimed elsewhere; tip: median / "
        "largest of those claimed in place; inside: tip inside its stated 95 % ellipsoid.",
    )


def _cells(seen: Sequence[Evaluation]) -> list[str]:
    found = [one for one in seen if one.outcome is not Outcome.MISSED]
    tips_mm = [one.errors["tip_mm"] for one in found if one.outcome is Outcome.CORRECT]
    off = sum(one > MAX_TIP_MM for one in tips_mm) + len(found) - len(tips_mm)
    inside = sum(one.covered[2] for one in found if one.outcome is Outcome.CORRECT)
    return [
        str(len(seen)),
        str(len(found)),
        str(off),
        pair(tips_mm, 100.0),
        share(inside, len(found)),
    ]


def _times() -> Table:
    width, height = TIMED_SIZE_WH_PX
    random = np.random.default_rng(0)
    coarse = random.integers(0, 256, (height // 16, width // 16), dtype=np.uint8)
    jpeg = _coded(np.asarray(cv2.resize(coarse, TIMED_SIZE_WH_PX), np.uint8), random)
    packet = np.frombuffer(jpeg, np.uint8)
    decoders: dict[str, Callable[[], object]] = {
        "OpenCV": lambda: cv2.imdecode(packet, cv2.IMREAD_COLOR),
        "here": lambda: decode_jpeg(packet),
    }
    times_ms: dict[str, list[float]] = {name: [] for name in decoders}
    for _ in range(TIMED):
        for name, decode in decoders.items():
            began_s = time.thread_time()
            decode()
            times_ms[name].append(1000.0 * (time.thread_time() - began_s))
    ratio = median(np.divide(times_ms["here"], times_ms["OpenCV"]))
    return Table(
        title=f"Processor time of decoding {width}x{height} px, {len(jpeg) / 1000:.0f} kB",
        columns=["decoder", "ms: median / 99th percentile", "by OpenCV"],
        rows=[
            ["OpenCV", pair(times_ms["OpenCV"], 99.0), "1.00"],
            ["here", pair(times_ms["here"], 99.0), number(ratio)],
        ],
    )


if __name__ == "__main__":
    main()

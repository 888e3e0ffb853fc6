"""Time of the first image of a fresh process against later ones: detects compilation at run time."""

import json
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from tests.benchmarks.limits.finders import tracker_of
from tests.benchmarks.scenes.faces import SAIL
from tests.benchmarks.scenes.placement import random_scene
from tests.benchmarks.scenes.rigs import RIGS
from tests.benchmarks.scenes.scene import image_of

CHECKOUT = Path(__file__).resolve().parents[3]
LATER = 12
PATIENCE_S = 300.0


@dataclass(frozen=True, slots=True, kw_only=True)
class FirstImage:
    """Times in ms of one fresh process.

    Attributes:
        rig: whose images.
        is_warmed: whether the process itself called `tracker.warm_up`, as the server's does.
        first_ms: of the first search.
        later_ms: median of those after it.
    """

    rig: str
    is_warmed: bool
    first_ms: float
    later_ms: float


def measure_first_images(rigs: str, *, repeats: int = 3) -> list[FirstImage]:
    """Measure fresh processes, after one that fills the compilation cache."""
    _run("-m", "tracker.warm_up")
    return [
        FirstImage(
            rig=rig,
            is_warmed=is_warmed,
            **json.loads(_run("-m", __spec__.name, rig, "warmed" if is_warmed else "cold")),
        )
        for rig in rigs
        for is_warmed in (False, True)
        for _ in range(repeats)
    ]


def _run(*arguments: str) -> str:
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=CHECKOUT,
        check=True,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
    ).stdout


def main(rig_name: str, state: str) -> None:
    """In the fresh process: search images of a camera, and print the times as JSON."""
    cv2.setNumThreads(1)
    rig = RIGS[rig_name]
    images = [image_of(random_scene(rig, SAIL, seed=number)) for number in range(LATER + 1)]
    if state == "warmed":
        from tracker.warm_up import warm_up  # noqa: PLC0415, a cold process must not have it

        warm_up()
    elapsed_ms = []
    tracker = tracker_of(rig, [SAIL])
    for image in images:
        started = time.perf_counter()
        tracker.search(image)
        elapsed_ms.append((time.perf_counter() - started) * 1e3)
    sys.stdout.write(json.dumps({"first_ms": elapsed_ms[0], "later_ms": float(np.median(elapsed_ms[1:]))}))


if __name__ == "__main__":
    main(*sys.argv[1:])

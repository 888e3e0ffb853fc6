"""Detection limit and false detections of lamp flicker.

    PYTHONPATH=. python -m tests.benchmarks.flicker --seeds 4

Rehearsed scenes under a flickering lamp, each depth with both mains frequencies and both kinds of shutter;
and the same scenes without one, under even light and under automatic exposure that steps. Last, the time of
an image.
"""

import argparse
import itertools
import sys
import time

import numpy as np

from tests.tracker.camera.lamps import lit
from tracker.camera.flicker import WINDOW_S, brightness_grid, detect_flicker
from tracker.rehearsal import Scene, Skill, Theatre, TheatreSettings

SCENES = (Scene.OPERATION, Scene.SWEEP, Scene.PIVOT, Scene.SPIN, Scene.BOARD, Scene.LANDMARKS)
RATES_HZ = (30.0, 25.0)
DEPTHS = (0.005, 0.01, 0.015, 0.02, 0.05, 0.2)
READOUTS_S = (0.0, 0.016)
FULL_HD = (1080, 1920, 3)


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=4)
    reported = dict.fromkeys(DEPTHS, 0)
    options = wrong_mains = false = even = 0
    for seed, scene in itertools.product(range(parser.parse_args().seeds), SCENES):
        settings = TheatreSettings(size_wh_px=(320, 240), scene=scene, seed=seed, skill=Skill.GOOD)
        renderer = Theatre(settings).renderer()
        for rate_hz in RATES_HZ:
            times_s = [float(at_s) for at_s in 5.0 * seed + np.arange(0.0, WINDOW_S + 0.1, 1.0 / rate_hz)]
            film = [renderer.image_at(at_s) for at_s in times_s]
            mains = 50 if rate_hz == 30.0 else 60
            for depth, readout_s in itertools.product(DEPTHS, READOUTS_S):
                means = [
                    brightness_grid(
                        lit(image, at_s, light_hz=2.0 * mains, depth_ratio=depth, readout_s=readout_s)
                    )
                    for at_s, image in zip(times_s, film, strict=True)
                ]
                found = detect_flicker(times_s, means).flicker
                reported[depth] += found is not None
                wrong_mains += found is not None and found.mains_hz != (mains,)
            options += len(READOUTS_S)
            stepped = [np.clip(image * (0.8 + 0.1 * (n % 50 // 20)), 0, 255) for n, image in enumerate(film)]
            for images in (film, [image.astype(np.uint8) for image in stepped]):
                false += (
                    detect_flicker(times_s, [brightness_grid(image) for image in images]).flicker is not None
                )
                even += 1
    image = np.random.default_rng(1).integers(0, 255, FULL_HD, dtype=np.uint8)
    took_us = [_timed_us(image) for _ in range(300)]
    lines = [
        *(
            f"depth {100.0 * depth:4.1f} %: told in {count} of {options} windows"
            for depth, count in reported.items()
        ),
        f"wrong mains frequency: {wrong_mains} of {sum(reported.values())}",
        f"without a lamp: told in {false} of {even} windows",
        f"an image of 1920 x 1080 px: {np.median(took_us):.0f} us",
    ]
    sys.stdout.write("\n".join(lines) + "\n")


def _timed_us(image: np.ndarray) -> float:
    began_s = time.perf_counter()
    brightness_grid(image)
    return (time.perf_counter() - began_s) * 1e6


if __name__ == "__main__":
    main()

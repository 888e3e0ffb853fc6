"""The warm-up compiles each kernel for every argument type, so that nothing compiles in theatre."""

import json
import subprocess
import sys
from pathlib import Path

from tests.benchmarks.limits.finders import tracker_of
from tests.benchmarks.scenes.conditions import conditions_of
from tests.benchmarks.scenes.faces import FACES
from tests.benchmarks.scenes.hand import hand_scenes
from tests.benchmarks.scenes.rigs import RIGS
from tests.benchmarks.scenes.scene import image_of
from tracker.plan import measure_pedicle
from tracker.rehearsal.ct import random_grid, random_phantom, scan
from tracker.warm_up import warm_up

CHECKOUT = Path(__file__).resolve().parents[3]
RIG = RIGS["A"]
# The first is sound, then the condition sets in.
IMAGES = 3
# Each makes another part of search, fit or verification run.
CONDITIONS = ("noise16", "defocus2", "motion8", "shadow0.8", "glare1.6", "cover30", "lens", "hard2")


def _versions() -> dict[str, int]:
    """Number of compiled signatures of each kernel of the tracker in this process."""
    return {
        f"{room}.{name}": len(loop.signatures)
        for room, module in list(sys.modules.items())
        if room.startswith("tracker.")
        for name, loop in vars(module).items()
        if hasattr(loop, "signatures")
    }


def _see_everything() -> None:
    """Search and track through these conditions of the benchmark."""
    for nth, name in enumerate(CONDITIONS):
        condition = conditions_of(RIG)[name]
        face = FACES[nth % len(FACES)]
        tracker = tracker_of(RIG, [face])
        scenes = hand_scenes(
            RIG, face, "still", seed=nth, count=IMAGES, condition=condition, undisturbed_images=1
        )
        for at_s, scene in scenes:
            image = image_of(scene)
            tracker.step(image, captured_at_s=at_s)
        tracker.search(image)


def _measure_a_pedicle() -> None:
    made = random_phantom(1)
    measure_pedicle(scan(made.hu_at, random_grid(made, 1)), made.seed_lps_mm("left"), "left")


def test_after_the_warm_up_no_image_and_no_ct_makes_anything_compile() -> None:
    # In its own process, because other tests call the kernels with other arrays.
    reported = subprocess.run(
        [sys.executable, "-m", "tests.tracker.pipeline.test_nothing_compiles"],
        cwd=CHECKOUT,
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    before, after = json.loads(reported)
    assert len(before) > 40
    assert {name: kinds for name, kinds in after.items() if kinds != before.get(name, 0)} == {}


if __name__ == "__main__":
    warm_up()
    at_first = _versions()
    _see_everything()
    _measure_a_pedicle()
    sys.stdout.write(json.dumps([at_first, _versions()]))

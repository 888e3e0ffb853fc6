"""Error of a stated focal length by the perspective of markers, against its truth.

python -m tests.benchmarks.focal_length [--hands 4]: a moving hand at 20 Hz for 4 s before cameras A and B,
with a camera model that is right or wrong, and prints that a printer stretched along one side.
"""

import argparse
import sys
from dataclasses import replace

import numpy as np

from tests.benchmarks.scenes.faces import FACES, Face
from tests.benchmarks.scenes.hand import hand_scenes
from tests.benchmarks.scenes.rigs import RIGS, Rig
from tests.benchmarks.scenes.scene import image_of
from tests.benchmarks.tables import NOTHING, Table
from tracker import CameraModel, Tracker
from tracker.photometric import FocalLengthError

# Stated by true focal length, minus 1, and width by height of the print, minus 1.
CASES = ((0.0, 0.0), (0.01, 0.0), (0.02, 0.0), (-0.03, 0.0), (0.0, 0.003), (0.0, 0.01))
# A hand at 60 Hz, of which the camera takes every third image.
SCENES, TAKEN = 240, 3


def main(arguments: list[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.focal_length", description=__doc__)
    parser.add_argument("--hands", type=int, default=4, help="motions of each row")
    hands = parser.parse_args(arguments).hands
    rows = [_row(rig, *case, hands=hands) for rig in RIGS.values() for case in CASES]
    table = Table(
        title=f"Focal length by the perspective of markers, {hands} hands of each row",
        columns=["camera, stated error, stretch of the print", "known", "error %", "sd %", "doubted"],
        rows=rows,
        note="Errors and standard deviations of the hands with enough different views.",
    )
    sys.stdout.write(table.markdown)


def _row(rig: Rig, stated_error: float, stretch: float, *, hands: int) -> list[str]:
    measured = [_measured(rig, stated_error, stretch, seed=seed) for seed in range(hands)]
    known = [one for one in measured if one is not None]
    return [
        f"{rig.name}, {stated_error:+.0%}, {stretch:.1%}",
        f"{len(known)} of {hands}",
        ", ".join(f"{one.ratio:+.2%}"[:-1] for one in known) or NOTHING,
        ", ".join(f"{one.sd:.2%}"[:-1] for one in known) or NOTHING,
        str(sum(one.is_doubtful for one in known)),
    ]


def _measured(rig: Rig, stated_error: float, stretch: float, *, seed: int) -> FocalLengthError | None:
    matrix = rig.matrix.copy()
    matrix[[0, 1], [0, 1]] *= 1.0 + stated_error
    face = FACES[seed % len(FACES)]
    camera = CameraModel(matrix=matrix, distortion=np.array(rig.distortion), size_wh_px=rig.size_wh_px)
    tracker = Tracker(camera=camera, models=[face.model])
    scenes = hand_scenes(rig, _stretched(face, stretch), "fast", seed=seed, count=SCENES)
    for number, (at_s, scene) in enumerate(scenes):
        if number % TAKEN == 0:
            tracker.step(image_of(scene), captured_at_s=at_s)
    return tracker.focal_length.error


def _stretched(face: Face, stretch: float) -> Face:
    """Return the face as printed by a printer that is not true to scale."""
    printed = replace(face)
    wider = tuple(outline * np.array([1.0 + stretch, 1.0, 1.0]) for outline in face.outlines_mm)
    object.__setattr__(printed, "outlines_mm", wider)
    return printed


if __name__ == "__main__":
    main()

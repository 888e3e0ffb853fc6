"""Is the stated error true in video whose images are predicted from earlier ones?"""

from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.benchmarks.limits.evaluation import claim_of, evaluate
from tests.benchmarks.limits.finders import tracker_of
from tests.benchmarks.scenes.faces import SAIL
from tests.benchmarks.scenes.hand import hand_scenes
from tests.benchmarks.scenes.rigs import RIG_HD
from tests.benchmarks.scenes.scene import Scene, image_of
from tests.tracker.scenes import Image8

IMAGES = 40


@pytest.fixture(scope="module")
def filmed() -> list[tuple[float, Scene]]:
    return list(hand_scenes(RIG_HD, SAIL, "slow", seed=7, count=IMAGES))


def _coded(path: Path, images: list[Image8]) -> list[Image8]:
    """The images as a video file gives them back."""
    height, width = images[0].shape[:2]
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"mp4v"), 60.0, (width, height))
    for image in images:
        writer.write(cv2.cvtColor(image, cv2.COLOR_GRAY2BGR))
    writer.release()
    video = cv2.VideoCapture(str(path))
    decoded = []
    while (read := video.read())[0]:
        decoded.append(np.asarray(read[1], dtype=np.uint8))
    return decoded


@pytest.mark.parametrize(("is_predicted", "min_ratio", "max_ratio"), [(False, 0.0, 0.85), (True, 0.92, 1.0)])
def test_the_tip_lies_inside_its_95_percent_ellipsoid_only_if_the_codec_is_known(
    tmp_path: Path, filmed: list[tuple[float, Scene]], is_predicted: bool, min_ratio: float, max_ratio: float
) -> None:
    images = _coded(tmp_path / "hand.mp4", [image_of(scene) for _, scene in filmed])
    assert len(images) == IMAGES
    tracker = tracker_of(RIG_HD, [SAIL])
    covered = []
    for (at_s, scene), image in zip(filmed, images, strict=True):
        sighting = tracker.step(image, captured_at_s=at_s, is_predicted=is_predicted)[SAIL.name]
        covered.append(evaluate(scene, claim_of(sighting)).covered[-1])
    assert min_ratio <= np.mean(covered) <= max_ratio

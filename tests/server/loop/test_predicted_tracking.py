"""Video that predicts its images makes the poses of the live path less certain."""

import numpy as np

from server.capture.shot import Shot
from server.config import Config, RehearsalConfig
from server.loop.tracking import Tracking
from server.setup import Preparation, build_setup
from tracker.geometry import Array
from tracker.navigation import ToolPose


def stated(preparation: Preparation, image: np.ndarray, *, is_predicted: bool) -> Array:
    """The covariance of the drill's tip in the first image of the rehearsal."""
    shot = Shot(image=image, number=0, captured_at_s=0.0, source_time_s=0.0, is_predicted=is_predicted)
    tool = Tracking(preparation).process(shot, skipped_images=0).tools["drill"]
    assert isinstance(tool, ToolPose)
    return tool.tip_covariance_mm2


def test_the_tip_is_less_certain_in_video_that_predicts_its_images() -> None:
    preparation = build_setup(Config(rehearsal=RehearsalConfig(width=640, height=360)))
    assert preparation.theatre is not None
    image = preparation.theatre.renderer().image_at(0.0)
    predicted, original = (stated(preparation, image, is_predicted=one) for one in (True, False))
    assert 2.5 < np.trace(predicted) / np.trace(original) < 20.0

"""Fixtures: a small theatre with known truth, instants made from it, and a real server on a free port."""

import dataclasses
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import cache

import numpy as np
import pytest
from fastapi import FastAPI

from server.live import Instant, ProcessState, ProcessStatus, SourceState, SourceStatus
from tests.served import served
from tests.shared_validators import share_validators
from tracker import CameraModel, Seen, ToolModel, Unseen, UnseenReason
from tracker.geometry import Camera, Rigid, Tool, Vertebra
from tracker.navigation import (
    Absent,
    AbsentReason,
    DrillReference,
    MotionState,
    NavigationSnapshot,
    Setup,
    navigate,
)
from tracker.plan import Channel
from tracker.registration import Registration

share_validators()

SIDE_MM = 25.0
CORNERS_MM = np.array([[-0.5, 0.5, 0], [0.5, 0.5, 0], [0.5, -0.5, 0], [-0.5, -0.5, 0]]) * SIDE_MM


def _seen(setup: Setup, place: Rigid[Camera, Vertebra], vertebra_from_tool: Rigid[Vertebra, Tool]) -> Seen:
    tool = setup.tools["drill"]
    camera_from_marker = place @ vertebra_from_tool @ tool.marker_from_tool.inverse
    return Seen(
        camera_from_marker=camera_from_marker,
        pose_covariance=np.eye(6) * 1e-4,
        corners_px=setup.camera.px_from_camera(camera_from_marker.move_points(CORNERS_MM)),
        score_ratio=0.93,
        target_score_ratio=0.9,
        model_coverage_ratio=0.95,
        target_coverage_ratio=0.9,
        fit_error_px2=0.1,
        found_by="track",
    )


def _whole_setup(size_wh_px: tuple[int, int], place: Rigid[Camera, Vertebra]) -> Setup:
    width, height = size_wh_px
    focal = 1.1 * width
    camera = CameraModel(
        matrix=np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1]]),
        distortion=np.array([-0.25, 0.06, 0.001, 0.0, 0.0]),
        size_wh_px=size_wh_px,
    )
    tool = ToolModel.from_tip_and_axis(
        name="drill",
        marker="drill",
        tip_in_marker_mm=[0, -70, 0],
        axis_in_marker=[0, -1, 0],
        radius_mm=2.0,
        length_mm=100.0,
    )
    channel = Channel(
        name="L3 left",
        entry_in_vertebra_mm=np.zeros(3),
        target_in_vertebra_mm=np.array([0.0, 0.0, 40.0]),
        radius_mm=4.0,
    )
    return Setup(
        camera=camera,
        camera_calibrated=True,
        tools={"drill": tool},
        channel=channel,
        registration=Registration.known_to_camera(place),
    )


@cache
def _guide() -> DrillReference:
    setup = _whole_setup((640, 360), Rigid[Camera, Vertebra].identity())
    assert isinstance(setup.channel, Channel)
    return DrillReference.of_channel(setup.channel)


def make_snapshot(
    *,
    size_wh_px: tuple[int, int] = (640, 360),
    tip_in_vertebra_mm: tuple[float, float, float] = (1.5, -1.0, 12.0),
    tilt_rad: float = 0.1,
    seen: bool = True,
    calibrated: bool = True,
    registered: bool = True,
    planned: bool = True,
    with_tool: bool = True,
    pose_variance: float = 1e-4,
    motion: MotionState | None = None,
    judged: bool = False,
    camera_from_vertebra: Rigid[Camera, Vertebra] | None = None,
    image_number: int = 0,
    captured_at_s: float = 0.0,
) -> NavigationSnapshot:
    """The drill near a channel 40 mm long, seen through a lens with distortion."""
    place = camera_from_vertebra or Rigid[Camera, Vertebra].from_vector([0.9, 0.35, 0.0], [5, -10, 260])
    whole = _whole_setup(size_wh_px, place)
    setup = dataclasses.replace(
        whole,
        camera_calibrated=calibrated,
        tools=whole.tools if with_tool else {},
        channel=whole.channel if planned else Absent(reason=AbsentReason.NO_PLAN),
        registration=whole.registration if registered else Absent(reason=AbsentReason.NOT_REGISTERED),
    )
    truth = Rigid[Vertebra, Tool].from_vector([tilt_rad, 0.04, 0.0], list(tip_in_vertebra_mm))
    unseen = Unseen(reason=UnseenReason.SCORE_TOO_LOW, best_score_ratio=0.4)
    seen_drill = dataclasses.replace(
        _seen(whole, place, truth), pose_covariance=np.diag([1.0] * 3 + [1e-4] * 3) * pose_variance
    )
    return navigate(
        setup=setup,
        sightings={"drill": seen_drill if seen else unseen},
        image_number=image_number,
        captured_at_s=captured_at_s,
        size_wh_px=size_wh_px,
        stage_ms={"edges": 3.0, "pose": 1.0},
        skipped_images=0,
        drill_reference=_guide() if judged else None,
        motion=motion or MotionState(),
    )


def make_instant(
    sequence: int,
    *,
    snapshot: NavigationSnapshot | None = None,
    jpeg: bytes = b"",
    source: SourceStatus | None = None,
    process: ProcessStatus | None = None,
) -> Instant:
    """An instant of a running source and process, unless specified otherwise."""
    return Instant(
        sequence=sequence,
        source=source or SourceStatus(name="rehearsal", state=SourceState.RUNNING, images=sequence + 1),
        process=process or ProcessStatus(state=ProcessState.RUNNING),
        snapshot=snapshot,
        jpeg=jpeg,
    )


@pytest.fixture(scope="session")
def snapshot_of() -> Callable[..., NavigationSnapshot]:
    return make_snapshot


@pytest.fixture(scope="session")
def instant_of() -> Callable[..., Instant]:
    return make_instant


@pytest.fixture
def serve() -> Iterator[Callable[[FastAPI], int]]:
    """Serve an application on a real socket; return the port."""
    with ExitStack() as stack:
        yield lambda app: stack.enter_context(served(app))

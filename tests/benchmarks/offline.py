"""Every image of a theatre through `Tracker.step`, and through other detectors for comparison."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import cv2
import numpy as np
import numpy.typing as npt

from tests.benchmarks.claims import Claim, Judgement, judge
from tracker.errors import InvalidInput
from tracker.navigation import Absent, AbsentReason, Setup, navigate
from tracker.pipeline import Tracker
from tracker.pose import Seen, Sighting
from tracker.registration import Registration
from tracker.rehearsal import Theatre

Image = npt.NDArray[np.uint8]


@dataclass(frozen=True, slots=True, kw_only=True)
class TimedImage:
    """Times of one image.

    Attributes:
        step_ms: of `Tracker.step`, whose stages are `step_stage_ms`.
        tracked: whether the step found the marker where it was expected.
        search_ms: of `Tracker.search` in the whole image, whose stages are `search_stage_ms`.
        aruco_ms: of OpenCV's marker detection with its own defaults.
    """

    step_ms: float
    step_stage_ms: dict[str, float]
    tracked: bool
    search_ms: float
    search_stage_ms: dict[str, float]
    aruco_ms: float


@dataclass(slots=True)
class OfflineRun:
    """Results image by image."""

    stepped: list[Judgement] = field(default_factory=list)
    searched: list[Judgement] = field(default_factory=list)
    timed: list[TimedImage] = field(default_factory=list)


def times_s(*, seconds: float, rate_hz: float) -> list[float]:
    """Return the times of the images."""
    return [number / rate_hz for number in range(round(seconds * rate_hz))]


def measure_offline(theatre: Theatre, at_s: Sequence[float]) -> OfflineRun:
    """Process all images of these times in order with one stateful tracker."""
    setup = setup_of(theatre)
    tracker = Tracker(camera=theatre.camera, models=[theatre.marker], clock=time.perf_counter)
    searcher = Tracker(camera=theatre.camera, models=[theatre.marker], clock=time.perf_counter)
    detector = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_6X6_250))
    renderer = theatre.renderer()
    measured = OfflineRun()
    for now_s in at_s:
        image = renderer.image_at(now_s)
        started = time.perf_counter()
        stepped = tracker.step(image, captured_at_s=now_s)["drill"]
        after_step = time.perf_counter()
        searched = searcher.search(image)["drill"]
        after_search = time.perf_counter()
        detector.detectMarkers(image)
        done = time.perf_counter()
        measured.stepped.append(judge(theatre, now_s, claim_of(setup, image, stepped)))
        measured.searched.append(judge(theatre, now_s, claim_of(setup, image, searched)))
        measured.timed.append(
            TimedImage(
                step_ms=(after_step - started) * 1e3,
                step_stage_ms=dict(tracker.stage_ms),
                tracked=isinstance(stepped, Seen) and stepped.found_by == "track",
                search_ms=(after_search - after_step) * 1e3,
                search_stage_ms=dict(searcher.stage_ms),
                aruco_ms=(done - after_search) * 1e3,
            )
        )
    return measured


def setup_of(theatre: Theatre) -> Setup:
    """Return the navigation setup before the first image of this theatre."""
    return Setup(
        camera=theatre.camera,
        camera_calibrated=True,
        tools={"drill": theatre.tool},
        channel=theatre.channels[0],
        registration=Registration.known_to_camera(theatre.camera_from_vertebra),
    )


def claim_of(setup: Setup, image: Image, sighting: Sighting) -> Claim | str:
    """Return the drill pose from a sighting by navigation, or the reason why there is none."""
    if not isinstance(sighting, Seen):
        return sighting.reason.value
    snapshot = navigate(
        setup=setup,
        sightings={"drill": sighting},
        image_number=0,
        captured_at_s=0.0,
        size_wh_px=(image.shape[1], image.shape[0]),
        stage_ms={},
        skipped_images=0,
    )
    tool, deviation = snapshot.tools["drill"], snapshot.deviations["drill"]
    if isinstance(tool, Absent) and tool.reason is AbsentReason.POSE_UNCERTAIN:
        return tool.reason.value
    if isinstance(tool, Absent) or isinstance(deviation, Absent):
        raise InvalidInput(
            "BENCHMARK_SETUP_INCOMPLETE",
            "a seen drill has no deviation in the rehearsal",
            "Look at `setup_of`: camera, channel and registration are all known there.",
        )
    return Claim(
        camera_from_marker=sighting.camera_from_marker,
        corners_px=sighting.corners_px,
        found_by=sighting.found_by,
        tip_in_camera_mm=tool.camera_from_tool.translation_mm,
        entry_offset_mm=deviation.entry_offset_mm,
        angle_deg=deviation.angle_deg,
        depth_mm=deviation.depth_mm,
        tip_covariance_mm2=tool.tip_covariance_mm2,
    )

"""Reports of the tracking process, run in a thread with the test's source and tracker."""

import multiprocessing
import threading
import time
from collections.abc import Iterator

import numpy as np
import pytest

from server.capture.address import source_from_text
from server.capture.industrial import IndustrialCameraSource
from server.capture.local_camera import LocalCameraSource
from server.capture.modes import WantedMode
from server.capture.shot import Shot
from server.config import CameraConfig, Config
from server.live import SourceState
from server.logs import LogSettings
from server.loop.report import Report, ReportUnpacker
from server.loop.ring import ImageRing
from server.loop.tracking import Tracking
from server.loop.worker import ReceivedOrders, WorkerLink, WorkerOrder, work
from server.setup import CaseSetup, Preparation, build_setup, nominal_camera
from tests.server.capture.fake_camera import FakeCamera, FakeDevices, FakeVideo, modes
from tests.server.capture.fake_industrial import FakeIndustrialCamera, FakeIndustrialCameras
from tests.server.loop.fake_workers import SIZE, made_image, made_setup
from tracker.camera import CameraControl
from tracker.errors import InvalidInput
from tracker.marker import ScoreSettings
from tracker.navigation import Setup
from tracker.pipeline import Tracker
from tracker.pose import Sighting

ORDER = WorkerOrder(config=Config(), log=LogSettings(as_json=True), first_number=10, skipped_before=4)


class Counting:
    """Three images, each one taken before the next, then the end."""

    name, waits_for_consumer, stalls, defect, camera = "counting", True, False, None, None

    def __init__(self) -> None:
        self.number = 10

    def open(self) -> None:
        pass

    def read(self) -> Shot | None:
        if self.number == 13:
            return None
        now_s = time.monotonic()
        shot = Shot(
            image=made_image(self.number), number=self.number, captured_at_s=now_s, source_time_s=now_s
        )
        self.number += 1
        return shot

    def close(self) -> None:
        pass


class Failing(Tracker):
    """Raises the given error for the image with this grey level."""

    def __init__(self, level: int, error: Exception) -> None:
        super().__init__(camera=made_setup().camera, models=[])
        self.level, self.error = level, error

    def step(
        self,
        image: np.ndarray,
        *,
        captured_at_s: float,
        full_search: bool = False,
        is_predicted: bool = False,
    ) -> dict[str, Sighting]:
        if int(image[0, 0, 0]) == self.level:
            raise self.error
        return super().step(
            image, captured_at_s=captured_at_s, full_search=full_search, is_predicted=is_predicted
        )


class Prepared(Preparation):
    """A preparation with a tracker provided by the test."""

    def __init__(self, tracker: Tracker) -> None:
        setup = made_setup()
        super().__init__(
            camera=None,
            models=(),
            tools={},
            channel=setup.channel,
            registration=setup.registration,
            reference=setup.reference,
            score_settings=ScoreSettings(),
            max_tip_sd_mm=3.0,
        )
        object.__setattr__(self, "made", tracker)

    made: Tracker

    def tracker_for(self, setup: Setup) -> Tracker:
        del setup
        return self.made


class SpyRing(ImageRing):
    """A ring that records everything that was written."""

    def __init__(self) -> None:
        super().__init__(image_bytes=20_000)
        self.reports: list[Report] = []
        self._unpacker = ReportUnpacker()
        self.ended = threading.Event()

    def write(self, payload: bytes, image: np.ndarray | None = None, *, encoded: bytes = b"") -> None:
        super().write(payload, image, encoded=encoded)
        report = self._unpacker.unpack(payload)
        self.reports.append(report)
        if report.source.state is SourceState.ENDED:
            self.ended.set()


@pytest.fixture
def link() -> Iterator[tuple[WorkerLink, SpyRing]]:
    ring = SpyRing()
    notices, notice = multiprocessing.Pipe(duplex=False)
    reported, stop = multiprocessing.Pipe(duplex=False)
    yield WorkerLink(ring=ring, notice=notice, orders=reported), ring
    for end in (notices, notice, reported, stop):
        end.close()


def run_to_the_end(link: tuple[WorkerLink, SpyRing], tracker: Tracker) -> list[Report]:
    stop = threading.Event()
    thread = threading.Thread(
        target=work,
        args=(ORDER, link[0], stop, Counting(), Tracking(Prepared(tracker))),
        kwargs={"received": ReceivedOrders()},
    )
    thread.start()
    assert link[1].ended.wait(30)
    stop.set()
    thread.join(30)
    return link[1].reports


def test_each_image_is_reported_with_its_number_and_the_counts_go_on(
    link: tuple[WorkerLink, SpyRing],
) -> None:
    reports = run_to_the_end(link, Failing(255, ZeroDivisionError()))
    shown = [report for report in reports if report.snapshot]
    assert [report.snapshot.image_number for report in shown if report.snapshot] == [10, 11, 12]
    assert [report.tracked_images for report in shown] == [1, 2, 3]
    assert shown[-1].source.images == 13
    assert shown[-1].source.skipped_images == 4
    assert reports[-1].snapshot is None


def test_an_image_that_the_tracker_rejects_becomes_a_problem_and_the_next_one_ends_it(
    link: tuple[WorkerLink, SpyRing],
) -> None:
    rejection = InvalidInput("IMAGE_ODD", "an image is odd", "Give an even one.")
    reports = run_to_the_end(link, Failing(11, rejection))
    problems = [report.problem.code if report.problem else None for report in reports[1:4]]
    numbers = [report.snapshot.image_number if report.snapshot else None for report in reports[1:4]]
    assert problems == [None, "IMAGE_ODD", None]
    assert numbers == [10, None, 12]


def test_a_fault_in_the_tracker_ends_the_loop_and_is_not_swallowed(
    link: tuple[WorkerLink, SpyRing],
) -> None:
    tracking = Tracking(Prepared(Failing(11, ZeroDivisionError("a bug"))))
    with pytest.raises(ZeroDivisionError):
        work(ORDER, link[0], threading.Event(), Counting(), tracking, received=ReceivedOrders())


def test_a_case_that_is_opened_sets_its_camera_to_its_calibration_and_tracking_learns_which_camera_it_is(
    link: tuple[WorkerLink, SpyRing],
) -> None:
    small = tuple(modes("YUYV", SIZE, 30.0))
    video = FakeVideo(FakeCamera(offered=small))
    source = LocalCameraSource(
        source_from_text("0"), devices=FakeDevices(video.camera), open_video=video, clock=video.clock
    )
    received, stop = ReceivedOrders(), threading.Event()
    controls = {CameraControl.FOCUS: 45, CameraControl.AUTOFOCUS: 0}
    received.put(CaseSetup(camera=nominal_camera(SIZE), camera_controls=controls))
    tracking = Tracking(build_setup(Config(camera=CameraConfig(source="0"))))
    thread = threading.Thread(
        target=work, args=(ORDER, link[0], stop, source, tracking), kwargs={"received": received}
    )
    thread.start()
    deadline_s = time.monotonic() + 30.0
    while video.camera.controls[CameraControl.FOCUS] != 45 or not tracking.device:
        assert time.monotonic() < deadline_s
        threading.Event().wait(0.002)
    stop.set()
    thread.join(30)
    assert video.camera.was_set == [(CameraControl.AUTOFOCUS, 0), (CameraControl.FOCUS, 45)]
    assert tracking.device == "Webcam"


def test_a_case_that_is_opened_moves_the_cut_out_of_an_industrial_camera(
    link: tuple[WorkerLink, SpyRing],
) -> None:
    camera = FakeIndustrialCamera()
    stop = threading.Event()
    source = IndustrialCameraSource(
        source_from_text("basler:4711"),
        cameras=FakeIndustrialCameras(sn4711=camera),
        stop=stop,
        wanted=WantedMode(size_wh_px=SIZE),
        clock=camera.clock,
    )
    received = ReceivedOrders()
    received.put(CaseSetup(camera=nominal_camera(SIZE), camera_controls={CameraControl.PAN: 96}))
    tracking = Tracking(build_setup(Config(camera=CameraConfig(source="basler:4711"))))
    thread = threading.Thread(
        target=work, args=(ORDER, link[0], stop, source, tracking), kwargs={"received": received}
    )
    thread.start()
    deadline_s = time.monotonic() + 30.0
    while camera.features["OffsetX"] != 96:
        assert time.monotonic() < deadline_s
        threading.Event().wait(0.002)
    stop.set()
    thread.join(30)

"""Snapshots, reports, and fake tracking processes."""

import os
import signal
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from server.live import Instant, LiveHub, SourceState, SourceStatus
from server.loop.report import Report
from server.loop.worker import WorkerLink, WorkerOrder
from server.setup import nominal_camera
from tracker.navigation import Absent, AbsentReason, NavigationSnapshot, Setup, navigate
from tracker.pose import Unseen, UnseenReason

SIZE = (64, 48)
DEADLINE_S = 60.0


def made_setup() -> Setup:
    return Setup(
        camera=nominal_camera(SIZE),
        camera_calibrated=False,
        tools={},
        channel=Absent(reason=AbsentReason.NO_PLAN),
        registration=Absent(reason=AbsentReason.NOT_REGISTERED),
    )


def made_snapshot(number: int, setup: Setup | None = None) -> NavigationSnapshot:
    return navigate(
        setup=setup or made_setup(),
        sightings={"drill": Unseen(reason=UnseenReason.NO_CANDIDATE)},
        image_number=number,
        captured_at_s=time.monotonic(),
        size_wh_px=SIZE,
        stage_ms={"edges": 1.0},
        skipped_images=0,
    )


def made_source(images: int = 0) -> SourceStatus:
    return SourceStatus(name="made", state=SourceState.RUNNING, images=images)


def made_image(number: int) -> np.ndarray:
    return np.full((SIZE[1], SIZE[0], 3), number % 256, dtype=np.uint8)


def send_images(
    link: WorkerLink, first_number: int, *, count: int | None = None, setup: Setup | None = None
) -> None:
    """Reports images until told to stop, or `count` of them."""
    setup = setup or made_setup()
    sent = 0
    while not _ended(link) and (count is None or sent < count):
        number = first_number + sent
        sent += 1
        shot_like = made_image(number)
        report = Report(
            source=made_source(number + 1), snapshot=made_snapshot(number, setup), tracked_images=sent
        )
        link.ring.write(link._packer.pack(report), shot_like)
        os.write(link.notice.fileno(), b".")


def _ended(link: WorkerLink) -> bool:
    """Whether the server has ended the connection; waits a moment."""
    return link.orders.poll(0.005)


def steady_worker(order: WorkerOrder, link: WorkerLink) -> None:
    send_images(link, order.first_number)


def echoing_worker(order: WorkerOrder, link: WorkerLink) -> None:
    """Reports images with the camera of the case: first from its order, then from later messages."""
    case = order.case
    number = order.first_number
    while True:
        camera = case.camera
        setup = made_setup() if camera is None else replace(made_setup(), camera=camera)
        send_images(link, number, setup=setup)
        number += 100
        try:
            case = link.orders.recv()
        except EOFError:
            return


def silent_worker(order: WorkerOrder, link: WorkerLink) -> None:
    """Reports three images, then hangs and reacts to SIGKILL only."""
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    send_images(link, order.first_number, count=3)
    while True:
        signal.pause()


def failing_worker(order: WorkerOrder, link: WorkerLink) -> None:
    del order, link
    os._exit(7)


class Seen(LiveHub):
    """A hub that stores every instant, in order."""

    def __init__(self) -> None:
        super().__init__()
        self.instants: list[Instant] = []

    def publish(self, instant: Instant) -> None:
        self.instants.append(instant)
        super().publish(instant)

    def until(self, true: Callable[[Instant], bool], *, after: int = 0) -> Instant:
        """The first instant for which this is true, from index `after` on."""
        deadline_s = time.monotonic() + DEADLINE_S
        index = after
        while time.monotonic() < deadline_s:
            while index < len(self.instants):
                if true(self.instants[index]):
                    return self.instants[index]
                index += 1
            time.sleep(0.001)
        raise AssertionError(f"not within {DEADLINE_S:g} s; the last was {self.newest}")

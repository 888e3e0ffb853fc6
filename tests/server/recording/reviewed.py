"""A recording of a drill with prescribed poses: the figures are known, and nothing is tracked."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np

from server.alarms import AlarmService, ProcedureFacts
from server.alarms.evaluation import AlarmState, AlarmStep
from server.config import Config
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from server.logs import LogSettings
from server.loop.report import Report, ReportPacker
from server.loop.ring import ImageRing
from server.loop.tracking import Tracking
from server.loop.tracking_state import tracking_state_bytes
from server.recording.messages import session_message
from server.recording.process import (
    AlarmsBegin,
    Recording,
    RecordingOrder,
    RingChanged,
    StepsTaken,
    TextMessage,
)
from server.recording_file import Topic, WriterLimits
from server.setup import Preparation
from tests.server.texts.drilled_rod import UNSEEN, concluded, seen_at, setup_of
from tests.tracker.navigation.assessed import drill_reference
from tracker.marker import ScoreSettings
from tracker.navigation.alarms import AlarmSnapshot

RATE_HZ = 10.0
WIDTH, HEIGHT = 320, 180
BEGIN_S, UNIX_OFFSET_S = 100.0, 1_767_225_600.0
# Arguments of `seen_at`: depth, two offsets from the axis, and tilt.
PLACES = {
    "path": (25.0, 0.1, 0.0, 0.2, 0.1, 1.0),
    "near": (29.0, 2.4, 0.0, 0.0, 0.0, 1.0),
    "breach": (29.0, 3.75, 0.0, 0.0, 0.0, 1.0),
}
# The grey level of an image encodes its number.
DRILLED = ("path",) * 10 + ("hidden",) * 8 + ("near",) * 6 + ("breach",) * 6 + ("path",) * 10
ACKNOWLEDGED_AT, MARKED_AT, NAVIGATES = 27, 33, range(5, 36)
SOURCE = SourceStatus(name="/dev/video0", state=SourceState.RUNNING)
RUNNING = ProcessStatus(state=ProcessState.RUNNING)


def write_drilling(path: Path, modes: Sequence[str] = DRILLED, *, has_setup: bool = False) -> Path:
    """Write a recording with one image for each mode, from navigation to a breach and back.

    `has_setup`: with a tracking state, and so with the setup of the results, for the 3-D scene. Its images
    show no marker, so that it cannot be replayed.
    """
    path.write_bytes(_recorded(tuple(modes), has_setup=has_setup))
    return path


@cache
def _recorded(modes: tuple[str, ...], *, has_setup: bool) -> bytes:
    """The file of a recording, made once a process."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "case.mcap"
        _record(path, modes, has_setup=has_setup)
        return path.read_bytes()


def _record(path: Path, modes: tuple[str, ...], *, has_setup: bool) -> None:
    now_s = BEGIN_S
    config = Config()
    alarms = AlarmService(config, clock=lambda: now_s)
    order = RecordingOrder(
        path=path,
        limits=WriterLimits(max_bytes=1e12, min_free_bytes=0),
        session=session_message(
            config,
            case_id="0" * 16,
            started_at="2026-01-01T00:00:00Z",
            unix_offset_s=UNIX_OFFSET_S,
            product_version="0",
        ),
        log=LogSettings(as_json=True),
    )
    recording = Recording(order, send=lambda _: None, clock=lambda: now_s)
    ring, packer = ImageRing(slots=4, image_bytes=WIDTH * HEIGHT * 3), ReportPacker()
    recording.take(RingChanged(ring=ring))

    def begin(state: AlarmState, at_s: float) -> None:
        recording.take(AlarmsBegin(state=state, at_s=at_s))

    def take(step: AlarmStep, picture: AlarmSnapshot) -> None:
        recording.take(StepsTaken(steps=((step, picture),)))

    alarms.record_steps(take, begin)
    setup, reference = setup_of(), drill_reference()
    first_state = ring.write_state(tracking_state_bytes(Tracking(_preparation()))) if has_setup else -1
    for number, mode in enumerate(modes):
        now_s = BEGIN_S + number / RATE_HZ
        sighting = UNSEEN if mode == "hidden" else seen_at(np.array(PLACES[mode]), setup.tools["drill"])
        snapshot = concluded(setup, reference, {"drill": sighting}, number=1000 + number, captured_at_s=now_s)
        snapshot = replace(snapshot, size_wh_px=(WIDTH, HEIGHT))
        report = Report(
            source=SOURCE,
            snapshot=snapshot,
            tracked_images=number + 1,
            state=first_state if number == 0 else 0,
        )
        image, jpeg = drawn(number)
        ring.write(packer.pack(report), image, encoded=jpeg)
        recording.read_all()
        alarms.set_facts(ProcedureFacts(navigating=number in NAVIGATES))
        now_s += 0.01
        alarms.observe(snapshot, SOURCE, RUNNING)
        if number == ACKNOWLEDGED_AT:
            alarms.acknowledge([one.number for one in alarms.picture.alarms], by="Anna")
        if number == MARKED_AT:
            text = '{"by": "Dr Sato", "role": "supervisor", "draw": {"shape": "circle"}}'
            recording.take(TextMessage(topic=Topic.MARKS, text=text, at_s=now_s))
        recording.tick()
    recording.note("STOPPED", "the test ended it")
    recording.close()


def _preparation() -> Preparation:
    """Return what gives the setup of the results for images of this size."""
    setup = setup_of()
    return Preparation(
        camera=setup.camera,
        models=(),
        tools=setup.tools,
        channel=setup.channel,
        registration=setup.registration,
        reference="",
        score_settings=ScoreSettings(),
        max_tip_sd_mm=setup.max_tip_sd_mm,
        same_sensor_area=True,
    )


def drawn(number: int) -> tuple[np.ndarray, bytes]:
    """Return an image with its number as grey level; every other one with its original JPEG."""
    image = np.full((HEIGHT, WIDTH, 3), 3 * number + 20, dtype=np.uint8)
    cv2.putText(image, str(number), (20, 120), cv2.FONT_HERSHEY_SIMPLEX, 3.0, (255, 255, 255), 4)
    if number % 2:
        return image, b""
    jpeg = cv2.imencode(".jpg", image)[1].tobytes()
    return np.asarray(cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR), dtype=np.uint8), jpeg

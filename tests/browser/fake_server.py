"""The real web server over a theatre of two lines: synthetic instants, selected by words on standard input.

live      instants with the marker seen (the initial mode)
fast      the same at a higher rate
unseen    instants whose marker is not seen
lost      the camera is disconnected: no snapshot, and a problem with its remedy
bare      images of a camera that is not calibrated
deep      the tip is past the planned end, which is an alarm
path, entry, near, breach   a drill in a bone: on path, off at its entry, near a wall, through it
hidden    the same drill is not seen
stopped   figures are withheld until somebody confirms that nothing has moved
wander    the same drill moves through all of these, back and forth
stop      nothing is published any more, the server keeps running
anew      the server ends; one without memory starts on another port, with instants as in live

Standard output gets the port of each server on its own line. The process ends with its standard input.

"""

import argparse
import socket
import sys
import threading
import time
from contextlib import ExitStack
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
import numpy.typing as npt
import uvicorn

from server.alarms import AlarmService
from server.app import AppParts, create_app
from server.config import Config
from server.jobs import Jobs
from server.live import Instant, LiveHub, Problem, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.logs import LogSettings
from server.procedure import Steps, TrackingLink
from server.store import CaseStore, Home
from tests.server.texts.drilled_rod import UNSEEN, concluded, seen_at, setup_of
from tests.tracker.navigation.assessed import drill_reference
from tracker import CameraModel, Seen, ToolModel, Unseen, UnseenReason
from tracker.geometry import Camera, Rigid, Tool, Vertebra
from tracker.navigation import AbsentReason, NavigationSnapshot, Setup, min_errors_95_mm, navigate
from tracker.plan import Channel
from tracker.registration import Registration

SIZE_WH_PX = (1280, 720)
# Each image takes processor time of server and pages.
RATE_HZ, FAST_RATE_HZ = 4.0, 15.0
SIDE_MM = 25.0
# How long a page that still watches may keep an ending server alive.
FAREWELL_S = 2
CORNERS_MM = np.array([[-0.5, 0.5, 0], [0.5, 0.5, 0], [0.5, -0.5, 0], [-0.5, -0.5, 0]]) * SIDE_MM
CAMERA_FROM_VERTEBRA = Rigid[Camera, Vertebra].from_vector([0.9, 0.35, 0.0], [5, -10, 260])
PLACES_IN_BONE = {
    "path": (25.0, 0.1, 0.0, 0.2, 0.1, 1.0),
    "entry": (-10.0, -2.4, 1.3, 0.2, 0.1, 1.0),
    "near": (29.0, 2.4, 0.0, 0.0, 0.0, 1.0),
    "breach": (29.0, 3.75, 0.0, 0.0, 0.0, 1.0),
}
IN_BONE = {*PLACES_IN_BONE, "hidden", "stopped", "wander", "insufficient"}
UNPLUGGED = Problem(
    code="CAMERA_LOST",
    message="the camera has given no image for 2.0 s, allowed 1.0 s",
    remedy="Check the camera's cable; it is tried again by itself.",
)


def setup(*, calibrated: bool = True) -> Setup:
    """A camera, a drill and a channel 40 mm long."""
    focal = 1.1 * SIZE_WH_PX[0]
    tool = ToolModel.from_tip_and_axis(
        name="drill",
        marker="drill",
        tip_in_marker_mm=[0, -70, 0],
        axis_in_marker=[0, -1, 0],
        radius_mm=2.0,
        length_mm=100.0,
    )
    return Setup(
        camera=CameraModel(
            matrix=np.array([[focal, 0, SIZE_WH_PX[0] / 2], [0, focal, SIZE_WH_PX[1] / 2], [0, 0, 1]]),
            distortion=np.zeros(5),
            size_wh_px=SIZE_WH_PX,
        ),
        camera_calibrated=calibrated,
        tools={"drill": tool},
        channel=Channel(
            name="L3 left",
            entry_in_vertebra_mm=np.zeros(3),
            target_in_vertebra_mm=np.array([0.0, 0.0, 40.0]),
            radius_mm=4.0,
        ),
        registration=Registration.known_to_camera(CAMERA_FROM_VERTEBRA),
    )


def snapshot_at(
    number: int, now_s: float, *, seen: bool, calibrated: bool, deep: bool = False
) -> NavigationSnapshot:
    """The drill on its slow path along the channel."""
    phase = number / RATE_HZ
    stands = setup(calibrated=calibrated)
    drill = Rigid[Vertebra, Tool].from_vector(
        [0.08 * np.sin(phase), 0.05, 0.0],
        [1.5 * np.sin(0.9 * phase), -1.0, 43.0 if deep else 12.0 + 20.0 * np.sin(0.5 * phase)],
    )
    marker = CAMERA_FROM_VERTEBRA @ drill @ stands.tools["drill"].marker_from_tool.inverse
    sighting = Seen(
        camera_from_marker=marker,
        pose_covariance=np.eye(6) * 1e-4,
        corners_px=stands.camera.px_from_camera(marker.move_points(CORNERS_MM)),
        score_ratio=0.93,
        target_score_ratio=0.88,
        model_coverage_ratio=0.95,
        target_coverage_ratio=0.9,
        fit_error_px2=0.1,
        found_by="track",
    )
    unseen = Unseen(reason=UnseenReason.SCORE_TOO_LOW, best_score_ratio=0.41)
    return navigate(
        setup=stands,
        sightings={"drill": sighting if seen else unseen},
        image_number=number,
        captured_at_s=now_s,
        size_wh_px=SIZE_WH_PX,
        stage_ms={"edges": 3.1, "marker": 2.4, "pose": 0.8},
        skipped_images=3,
    )


@cache
def setup_in_bone(*, suffices: bool) -> Setup:
    """The rod's set-up with its smallest errors, which take longer to compute than an image may take."""
    # 95 % of 0.9 mm is 2.21 mm, and 1.8 mm are left.
    rod = setup_of(registered_sd_mm=0.0 if suffices else 0.9)
    return replace(rod, min_errors_95_mm=min_errors_95_mm(rod, drill_reference()))


def snapshot_in_bone(mode: str, number: int, now_s: float) -> NavigationSnapshot:
    """A drill in the rod, whose walls are known."""
    if mode == "wander":
        # A new place every two seconds, with motion in between.
        places, along = list(PLACES_IN_BONE.values()), number / RATE_HZ / 2.0
        share = along - int(along)
        first, second = (np.array(places[int(along + step) % len(places)]) for step in (0, 1))
        where = first + share * (second - first)
    else:
        where = np.array(PLACES_IN_BONE.get(mode, PLACES_IN_BONE["path"]))
    stands = setup_in_bone(suffices=mode != "insufficient")
    if mode == "stopped":
        stands = replace(stands, withheld=AbsentReason.NOT_CONFIRMED)
    sighting = UNSEEN if mode == "hidden" else seen_at(where, stands.tools["drill"])
    return concluded(stands, drill_reference(), {"drill": sighting}, number=number, captured_at_s=now_s)


def instant_at(sequence: int, mode: str, ground: npt.NDArray[np.uint8], alarms: AlarmService) -> Instant:
    """Return the instant of this mode."""
    process = ProcessStatus(state=ProcessState.RUNNING)
    if mode == "lost":
        away = SourceStatus(
            name="/dev/video0", state=SourceState.RECONNECTING, problem=UNPLUGGED, images=sequence
        )
        picture = alarms.observe(None, away, process)
        return Instant(sequence=sequence, source=away, process=process, alarms=picture)
    now_s = time.monotonic()
    if mode in IN_BONE:
        snapshot = snapshot_in_bone(mode, sequence, now_s)
    else:
        snapshot = snapshot_at(
            sequence,
            now_s,
            seen=mode in ("live", "fast", "bare", "deep"),
            calibrated=mode != "bare",
            deep=mode == "deep",
        )
    source = SourceStatus(name="/dev/video0", state=SourceState.RUNNING, images=sequence, rate_hz=RATE_HZ)
    picture = alarms.observe(snapshot, source, process)
    return Instant(
        sequence=sequence, source=source, process=process, snapshot=snapshot, image=ground, alarms=picture
    )


def backdrop() -> npt.NDArray[np.uint8]:
    """A static grey picture, as soft as an operating field."""
    noise = np.random.default_rng(1).uniform(40, 110, (9, 16, 3)).astype(np.uint8)
    return np.asarray(cv2.resize(noise, SIZE_WH_PX, interpolation=cv2.INTER_CUBIC), dtype=np.uint8)


# On a busy machine images are older than the usual limit, and the page would switch off its 3-D scene.
LIMITS = {"pose_stale_after_ms": 700}


def with_ct(instant: Instant, ct_id: str) -> Instant:
    """The same with a channel planned on this CT."""
    snapshot = instant.snapshot
    if snapshot is None or ct_id == "":
        return instant
    return replace(instant, snapshot=replace(snapshot, setup=replace(snapshot.setup, ct_id=ct_id)))


class Feeder(threading.Thread):
    """Publishes instants until the process ends, with a CT if it has an id."""

    def __init__(
        self, hub: LiveHub, alarms: AlarmService, *, rate_hz: float = RATE_HZ, ct_id: str = ""
    ) -> None:
        super().__init__(name="feeder", daemon=True)
        self._rate_hz = rate_hz
        self._ct_id = ct_id
        self._hub = hub
        self._alarms = alarms
        self._ended = threading.Event()
        self.mode = "live"

    def run(self) -> None:
        """Publish instants at the rate."""
        ground = backdrop()
        sequence = 0
        while not self._ended.wait(1.0 / (FAST_RATE_HZ if self.mode == "fast" else self._rate_hz)):
            if self.mode != "stop":
                instant = instant_at(sequence, self.mode, ground, self._alarms)
                self._hub.publish(with_ct(instant, self._ct_id))
                sequence += 1

    def end(self) -> None:
        """Stop publishing."""
        self._ended.set()
        self.join()


def main() -> None:
    """Serve until standard input ends."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--port", type=int, default=0)
    port = parser.parse_args().port
    with ExitStack() as ending:
        feeder = begun(ending, port)
        for line in sys.stdin:
            if line.strip() == "anew":
                ending.close()
                feeder = begun(ending, 0)
            else:
                feeder.mode = line.strip()


def begun(ending: ExitStack, port: int) -> Feeder:
    """Start a server without a store; return its port and feeder, both stopped at the end."""
    hub = LiveHub()
    config = Config.model_validate({"limits": LIMITS})
    alarms = AlarmService(config)
    feeder = Feeder(hub, alarms)
    door = ending.enter_context(socket.create_server(("127.0.0.1", port), reuse_port=False))
    app = create_app(parts_with_store(ending, AppParts(hub=hub, config=config, setup=setup(), alarms=alarms)))
    said = uvicorn.Config(app, log_level="error", lifespan="on", timeout_graceful_shutdown=FAREWELL_S)
    server = uvicorn.Server(said)
    serving = threading.Thread(target=server.run, args=([door],), name="web server", daemon=True)

    def end() -> None:
        feeder.end()
        server.should_exit = True
        serving.join()

    serving.start()
    feeder.start()
    ending.callback(end)
    sys.stdout.write(f"{door.getsockname()[1]}\n")
    sys.stdout.flush()
    return feeder


def parts_with_store(ending: ExitStack, parts: AppParts) -> AppParts:
    """The same with an empty store, deleted at the end."""
    home = ending.enter_context(Home(Path(ending.enter_context(TemporaryDirectory()))))
    store = ending.enter_context(CaseStore(home))
    jobs = Jobs(log=LogSettings(as_json=False))
    ending.callback(jobs.close)
    steps = Steps.of(
        hub=parts.hub,
        store=store,
        jobs=jobs,
        config=parts.config,
        markers=[],
        tracking=TrackingLink(publish_setup=lambda _: None),
    )
    return replace(parts, store=store, jobs=jobs, steps=steps)


if __name__ == "__main__":
    main()

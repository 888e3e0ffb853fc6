"""Source, tracking process, ring and publisher together, as the server runs them."""

import json
import os
import select
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest

from server.config import CameraConfig, Config, MarkerConfig
from server.live import SourceState
from server.logs import LogSettings
from server.loop.tracking_system import TrackingSystem
from server.priority import NICENESS
from server.setup import CaseSetup, nominal_camera
from tests.server.loop.fake_workers import Seen

MAX_NICENESS = 19
REPOSITORY = Path(__file__).parents[3]


def film(path: Path, *, images: int = 10, size_wh_px: tuple[int, int] = (64, 48)) -> Path:
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 50.0, size_wh_px)
    for number in range(images):
        writer.write(np.full((size_wh_px[1], size_wh_px[0], 3), 20 * number, dtype=np.uint8))
    writer.release()
    return path


def config(folder: Path, *, loop: bool = True, calibrated_wh_px: tuple[int, int] | None = None) -> Config:
    picture = np.zeros((40, 40), np.uint8)
    picture[10:20, 10:] = 255
    cv2.imwrite(str(folder / "m.png"), picture)
    calibration = None
    if calibrated_wh_px is not None:
        calibration = folder / "c.json"
        k = [[500, 0, 30], [0, 500, 20], [0, 0, 1]]
        calibration.write_text(
            json.dumps({"matrix": k, "distortion": [0] * 5, "size_wh_px": calibrated_wh_px})
        )
    return Config(
        camera=CameraConfig(source=str(folder / "v.avi"), loop=loop, calibration=calibration),
        markers={"m": MarkerConfig(image=folder / "m.png", side_mm=25.0)},
    )


class Running:
    def __init__(self, settings: Config) -> None:
        self.tracked = TrackingSystem(settings, log=LogSettings(as_json=True))
        self.hub = Seen()
        self.tracked.hub = self.hub
        self.tracked.start()
        self.tracked.publish()


@pytest.fixture
def running(request: pytest.FixtureRequest) -> Iterator[list[Running]]:
    del request
    made: list[Running] = []
    yield made
    for each in made:
        each.tracked.stop()


def test_a_file_that_comes_later_is_found_and_tracked_by_itself(
    tmp_path: Path, running: list[Running]
) -> None:
    running.append(Running(config(tmp_path)))
    hub = running[0].hub
    away = hub.until(lambda instant: instant.source.state is SourceState.RECONNECTING)
    assert away.snapshot is None
    assert away.source.problem is not None
    assert away.source.problem.code == "SOURCE_NOT_FOUND"
    film(tmp_path / "part.avi").replace(tmp_path / "v.avi")
    shown = hub.until(lambda instant: instant.snapshot is not None, after=away.sequence)
    assert shown.snapshot is not None
    assert shown.source.state is SourceState.RUNNING
    assert shown.source.problem is None
    assert set(shown.snapshot.sightings) == {"m"}
    assert not shown.snapshot.setup.camera_calibrated
    assert {"waiting", "navigation"} <= set(shown.snapshot.stage_ms)


def test_a_file_that_is_not_looped_ends_and_its_last_picture_goes(
    tmp_path: Path, running: list[Running]
) -> None:
    film(tmp_path / "v.avi", images=3)
    running.append(Running(config(tmp_path, loop=False)))
    ended = running[0].hub.until(
        lambda instant: instant.source.state is SourceState.ENDED and instant.image is None
    )
    assert ended.source.images == 3
    assert ended.snapshot is None


def test_images_of_another_size_than_calibrated_are_shown_without_millimetres_and_reported(
    tmp_path: Path, running: list[Running]
) -> None:
    film(tmp_path / "v.avi")
    running.append(Running(config(tmp_path, calibrated_wh_px=(640, 480))))
    shown = running[0].hub.until(lambda instant: instant.snapshot is not None)
    assert shown.snapshot is not None
    assert not shown.snapshot.setup.camera_calibrated
    assert shown.process.problem is not None
    assert shown.process.problem.code == "CAMERA_SIZE_MISMATCH"
    assert "64x48" in shown.process.problem.message
    assert "640x480" in shown.process.problem.message


def test_a_case_that_is_opened_while_tracking_brings_its_camera(
    tmp_path: Path, running: list[Running]
) -> None:
    film(tmp_path / "v.avi")
    running.append(Running(config(tmp_path)))
    hub = running[0].hub
    before = hub.until(lambda instant: instant.snapshot is not None)
    assert before.snapshot is not None
    assert not before.snapshot.setup.camera_calibrated
    running[0].tracked.adopt(CaseSetup(camera=nominal_camera((64, 48))))
    hub.until(lambda instant: instant.snapshot is not None and instant.snapshot.setup.camera_calibrated)
    assert hub.instants[-1].process.restarts == 0
    running[0].tracked.adopt(CaseSetup())
    seen = len(hub.instants)
    hub.until(
        lambda instant: instant.snapshot is not None and not instant.snapshot.setup.camera_calibrated,
        after=seen,
    )


SERVER = """
import sys
from pathlib import Path
from server.config import CameraConfig, Config
from server.logs import LogSettings, configure_logging
from server.loop.tracking_system import TrackingSystem

if __name__ == "__main__":
    camera = CameraConfig(source=sys.argv[1])
    log = LogSettings(as_json=True)
    configure_logging(log)
    tracked = TrackingSystem(Config(camera=camera), log=log)
    tracked.start()
    tracked.publish()
    import asyncio
    sequence = -1
    while True:
        instant = asyncio.run(tracked.hub.next_after(sequence))
        sequence = instant.sequence
        if instant.snapshot is not None:
            print(tracked.pid, flush=True)
            sys.stdin.read()
"""


def nicenesses(pid: int) -> list[int]:
    stats = [(task / "stat").read_text() for task in Path(f"/proc/{pid}/task").iterdir()]
    return sorted(int(stat.rpartition(")")[2].split()[16]) for stat in stats)


@pytest.mark.skipif(sys.platform != "linux", reason="threads have priorities on Linux only")
def test_only_the_images_of_a_rehearsal_are_made_at_low_priority(
    tmp_path: Path, running: list[Running]
) -> None:
    film(tmp_path / "v.avi")
    for settings, low in ((config(tmp_path), 0), (Config(), 1)):
        running.append(Running(settings))
        running[-1].hub.until(lambda instant: instant.snapshot is not None)
        pid = running[-1].tracked.pid
        assert pid is not None
        # A process that was starved at its start has a raised priority.
        main = os.getpriority(os.PRIO_PROCESS, pid)
        lowered = sum(one >= min(main + NICENESS, MAX_NICENESS) for one in nicenesses(pid))
        assert lowered == low


def parent_of(pid: int) -> int:
    return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])


def wait_until_ended(pid: int) -> None:
    """Return when the process has ended, reaped or not."""
    try:
        handle = os.pidfd_open(pid)
    except ProcessLookupError:
        return
    try:
        poller = select.poll()
        poller.register(handle)
        assert poller.poll(30_000), f"process {pid} was left behind"
    finally:
        os.close(handle)


@pytest.mark.skipif(not hasattr(os, "pidfd_open"), reason="needs Linux")
def test_no_process_is_left_behind_when_the_server_is_killed(tmp_path: Path) -> None:
    film(tmp_path / "v.avi")
    script = tmp_path / "serve.py"
    script.write_text(SERVER)
    environment = {**os.environ, "PYTHONPATH": str(REPOSITORY)}
    with subprocess.Popen(
        [sys.executable, str(script), str(tmp_path / "v.avi")],
        env=environment,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as server:
        assert server.stdout is not None
        tracking = int(server.stdout.readline())
        forking = parent_of(tracking)
        assert forking != server.pid
        server.send_signal(signal.SIGKILL)
        wait_until_ended(tracking)
        wait_until_ended(forking)
        assert server.stderr is not None
        assert "leaked" not in server.stderr.read()

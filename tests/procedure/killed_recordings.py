"""Kill the processes of a server with `kill -9` while it records a rehearsed operation.

    PYTHONPATH=. python -m tests.procedure.killed_recordings --times 50 --seed 1

Each kill ends one recording: of the web process, of tracking, of the process that records, or of all at once.
The file must be readable, contain all images but those of at most a second before the kill, and be
replayed exactly. After a kill of tracking the recording goes on, and is stopped later.
"""

import argparse
import random
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from server.config import Config
from server.errors import RecordingError
from server.recording.replay import check_recording
from server.recording_file import RecordingReader, Topic
from tests.procedure.killing.people import CONFIRM
from tests.procedure.killing.processes import family_of, kill, left_behind
from tests.procedure.killing.theatre import prepare, settings_of
from tests.procedure.real_server import unended_server

TARGETS = ("web", "tracking", "recorder", "all")
MAX_LOST_S = 1.0
IMAGES_AFTER_RESTART = 10
COLUMNS = "{:>4} {:<9} {:>7} {:>7} {:>7} {:>7}  {}\n"


@dataclass(slots=True, kw_only=True)
class KilledRecording:
    """One kill, and what the recording contains.

    Attributes:
        target: What was killed.
        images, steps: Images and alarm steps that were replayed.
        lost_s: Time from the last image in the file to the one that was shown before the kill.
        broken: Promises that were broken.
    """

    target: str
    images: int = 0
    steps: int = 0
    lost_s: float = float("nan")
    broken: list[str] = field(default_factory=list)


class RecordedOperation:
    """A server that records a rehearsed operation, is killed, and started again in the same folder."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._settings = folder, settings_of(reference=True)
        self._settings["recording"] = {"when": "manual"}
        folder.mkdir(parents=True)
        prepare(folder / "home", Config.model_validate(self._settings))
        self._ending = ExitStack()
        self._start()
        (case,) = self._server.ask("GET", "/api/cases", 200)["cases"]
        consent = {"case_id": case["id"], "is_given": True}
        self._server.ask("POST", "/api/recordings/consent", 200, json=consent)

    def kill_once(self, target: str, *, images: int, after_s: float = 0.0) -> KilledRecording:
        """Record some images and this time, kill, and check the file."""
        one = KilledRecording(target=target)
        name = self._server.ask("POST", "/api/recordings/start", 200)["name"]
        self._until_recorded(images)
        threading.Event().wait(after_s)
        path = next(self._folder.rglob(name))
        family = family_of(self._server.process.pid)
        one_of = {"web": family.web, "tracking": family.tracking, "recorder": family.recording}
        pids = family.pids if target == "all" else (one_of[target],)
        # A busy machine falls behind for a moment, and then shows nothing.
        shown_at_s = self._server.shown()["captured_at_s"]
        kill(tuple(pid for pid in pids if pid is not None))
        if target in {"web", "all"}:
            self._ending.close()
            one.broken += left_behind(family)
            self._start()
        elif target == "recorder":
            state = self._server.until("the recording has ended", self._ended)
            if state["problem"] is None:
                one.broken.append("nobody is told that the recording has ended")
        else:
            self._until_recorded(self._state()["images"] + IMAGES_AFTER_RESTART)
            self._server.ask("POST", "/api/recordings/stop", 200)
        listed = self._server.ask("GET", "/api/recordings", 200)["recordings"]
        if name not in {each["name"] for each in listed}:
            one.broken.append("it is not listed")
        self._check(one, path, shown_at_s)
        return one

    def end(self) -> None:
        """Kill the last server."""
        kill(family_of(self._server.process.pid).pids)
        self._ending.close()

    def _check(self, one: KilledRecording, path: Path, shown_at_s: float) -> None:
        try:
            tracked_at_s = [
                float(message.json()["captured_at_s"])
                for message in RecordingReader(path).messages()
                if message.topic is Topic.TRACKED
            ]
            report = check_recording(path)
        except RecordingError as error:
            one.broken.append(f"{error.code}: {error.message}")
            return
        one.images, one.steps = report.images, report.steps
        one.lost_s = shown_at_s - max((at_s for at_s in tracked_at_s if at_s <= shown_at_s), default=0.0)
        if not report.is_equal:
            first = report.poses.first or report.alarms.first or report.incomplete_reason
            one.broken.append(f"the replay of {report.images} images differs: {first}")

    def _start(self) -> None:
        self._server = unended_server(self._ending, self._folder, self._settings)
        self._server.shown()
        needed = self._server.ask("GET", "/api/procedure", 200)["confirmation"]
        if needed is not None:
            self._server.ask("POST", CONFIRM, 200, json={"registration_id": needed["registration_id"]})

    def _state(self) -> dict[str, Any]:
        state: dict[str, Any] = self._server.ask("GET", "/api/recordings/state", 200)
        return state

    def _ended(self) -> dict[str, Any] | None:
        state = self._state()
        return None if state["is_recording"] else state

    def _until_recorded(self, images: int) -> None:
        self._server.until(f"{images} recorded images", lambda: self._state()["images"] >= images)


def kills(times: int, *, seed: int, max_s: float) -> Iterator[KilledRecording]:
    """Record and kill this many times in one folder."""
    rng = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        operation = RecordedOperation(Path(folder) / "operation")
        try:
            for _ in range(times):
                yield operation.kill_once(rng.choice(TARGETS), images=5, after_s=rng.uniform(0.0, max_s))
        finally:
            operation.end()


def main() -> None:
    """Run the kills and print the results."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--times", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--max-s", type=float, default=5.0, help="that it records before a kill")
    given = parser.parse_args()
    tell = sys.stdout.write
    tell(COLUMNS.format("kill", "killed", "images", "steps", "lost s", "broken", ""))
    reported: list[KilledRecording] = []
    for one in kills(given.times, seed=given.seed, max_s=given.max_s):
        reported.append(one)
        if one.lost_s > MAX_LOST_S:
            one.broken.append(f"more than {MAX_LOST_S:g} s are lost")
        row = (len(reported), one.target, one.images, one.steps, f"{one.lost_s:.2f}", len(one.broken))
        tell(COLUMNS.format(*row, "; ".join(one.broken)))
        sys.stdout.flush()
    broken = sum(len(one.broken) for one in reported)
    worst_s = max(one.lost_s for one in reported)
    tell(f"{len(reported)} kills, at most {worst_s:.2f} s lost, {broken} promises broken\n")
    sys.exit(1 if broken else 0)


if __name__ == "__main__":
    main()

"""Cost of the simulated theatre: processor time of each image, and start-up time.

python -m tests.benchmarks.rehearsal_cost [--images 150] [--size 1280x720] [--threads 2]
"""

import argparse
import multiprocessing
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import cv2

from server.capture.frozen_image import FrozenImageDetector
from server.capture.shot import Shot
from server.loop.still_files import StillFiles
from server.loop.worker import OPENCV_THREADS
from tests.benchmarks.machine import machine_line
from tests.benchmarks.tables import Table, number, percentile
from tracker.rehearsal import BoardKind, Event, EventKind, Renderer, Scene, Skill, Theatre, TheatreSettings
from tracker.rehearsal.board_renderer import BoardRenderer

RATE_HZ = 30.0
WARMING = 5
EVENTS = (
    Event(kind=EventKind.CAMERA_MOVES, at_s=8.0, lasts_s=6.0),
    Event(kind=EventKind.PATIENT_MOVES, at_s=12.0, lasts_s=6.0),
    Event(kind=EventKind.DRILL_HIDDEN, at_s=10.0, lasts_s=5.0),
    Event(kind=EventKind.REFERENCE_HIDDEN, at_s=18.0, lasts_s=8.0),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Played:
    """A scene with its special settings.

    Attributes:
        name: of its row.
        scene: what is played.
        skill: of the hand in the operation.
        board: shown in its scene.
        reference: whether there is a marker on the patient.
        events: what goes wrong.
    """

    name: str
    scene: Scene
    skill: Skill = Skill.WANDERING
    board: BoardKind = BoardKind.DOTS
    reference: bool = True
    events: tuple[Event, ...] = ()

    def settings(self, size_wh_px: tuple[int, int]) -> TheatreSettings:
        """Return the theatre settings."""
        return TheatreSettings(
            size_wh_px=size_wh_px,
            scene=self.scene,
            skill=self.skill,
            board=self.board,
            reference=self.reference,
            events=self.events,
        )


PLAYED = (
    Played(name="operation, without reference", scene=Scene.OPERATION, reference=False),
    *(Played(name=f"operation, {skill}", scene=Scene.OPERATION, skill=skill) for skill in Skill),
    Played(name="operation, with events", scene=Scene.OPERATION, events=EVENTS),
    *(Played(name=f"board, {board}", scene=Scene.BOARD, board=board) for board in BoardKind),
    *(Played(name=str(scene), scene=scene) for scene in Scene if scene not in (Scene.OPERATION, Scene.BOARD)),
)


def image_ms(theatre: Theatre, renderer: Renderer | BoardRenderer, images: int) -> list[float]:
    """Return the processor time of images spread evenly over the scene's cycle, including capture."""
    same, spent = FrozenImageDetector(), []
    for number_of in range(-WARMING, images):
        # Not a whole part of the cycle: each place of a board is seen held and moved.
        at_s = round((number_of % images) / images * theatre.cycle_s * RATE_HZ) / RATE_HZ
        began = time.process_time()
        image = renderer.image_at(at_s)
        same.repeated_for_s(Shot(image=image, number=number_of, captured_at_s=at_s, source_time_s=at_s))
        spent.append(1e3 * (time.process_time() - began))
    return spent[WARMING:]


def image_table(images: int, size_wh_px: tuple[int, int]) -> Table:
    """Table of the processor time of an image and its share of a core, by scene."""
    rows = []
    before: Renderer | BoardRenderer | None = None
    for played in PLAYED:
        theatre = Theatre(played.settings(size_wh_px))
        began_s = time.perf_counter()
        renderer = theatre.renderer(after=before)
        renderer.prepare()
        ready_s = time.perf_counter() - began_s
        before = renderer
        spent = image_ms(theatre, renderer, images)
        mean = sum(spent) / len(spent)
        share = f"{mean * RATE_HZ / 10.0:.1f} %"
        values = (percentile(spent, 50.0), mean, percentile(spent, 99.0))
        rows.append([played.name, *(number(one) for one in values), share, f"{ready_s:.2f}"])
    return Table(
        title="Processor time of an image, ms",
        columns=[
            "scene",
            "median",
            "mean",
            "p99",
            f"of a core at {RATE_HZ:g} Hz",
            "ready after the one before, s",
        ],
        rows=rows,
    )


def start_table(size_wh_px: tuple[int, int]) -> Table:
    """Table of the time from the loaded program to the first image, each in its own process."""
    with tempfile.TemporaryDirectory() as folder:
        first, second = (_start(size_wh_px, Path(folder)) for _ in range(2))
    rows = [[name, *(f"{value:.2f}" for value in (*first[name], *second[name]))] for name in first]
    columns = ["step", "first start: processor s", "s", "next start: processor s", "s"]
    return Table(title="Start", columns=columns, rows=rows)


Steps = dict[str, tuple[float, float]]  # processor time and time of each, in seconds


def _start(size_wh_px: tuple[int, int], home: Path) -> Steps:
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(_started, (size_wh_px, home))


def _started(size_wh_px: tuple[int, int], home: Path) -> Steps:
    cv2.setNumThreads(OPENCV_THREADS)
    marks = [(time.process_time(), time.perf_counter())]
    theatre = Theatre(PLAYED[0].settings(size_wh_px))
    marks.append((time.process_time(), time.perf_counter()))
    renderer = theatre.renderer(store=StillFiles(home))
    marks.append((time.process_time(), time.perf_counter()))
    renderer.image_at(0.0)
    marks.append((time.process_time(), time.perf_counter()))
    while not list(home.rglob("*.npz")):
        time.sleep(0.01)
    steps = {"theatre": (0, 1), "still scenery": (1, 2), "first image": (2, 3), "all": (0, 3)}
    return {
        name: (marks[end][0] - marks[start][0], marks[end][1] - marks[start][1])
        for name, (start, end) in steps.items()
    }


def main() -> None:
    """Measure, and print two tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--images", type=int, default=150, help="of each scene")
    parser.add_argument("--size", default="1280x720", help="width x height in px")
    parser.add_argument("--threads", type=int, default=OPENCV_THREADS, help="of OpenCV")
    given = parser.parse_args()
    width, height = (int(side) for side in given.size.split("x"))
    cv2.setNumThreads(given.threads)
    tables = (start_table((width, height)), image_table(given.images, (width, height)))
    sys.stdout.write("\n".join([f"{machine_line()}\n", *(table.markdown for table in tables)]))


if __name__ == "__main__":
    main()

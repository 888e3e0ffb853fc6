"""`coaxial track`: every image of a video through the tracker, and what it says as JSON lines.

The output file gets its name when every image was processed; images that cannot be read are listed, with
exit status 2, since no further image would come. Only an interrupted run leaves a `.part` file.
"""

import contextlib
import json
import signal
import statistics
import threading
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cv2
import structlog
import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from server.capture.address import SourceKind, source_from_text
from server.capture.choose import source_from_config
from server.capture.codecs import open_file
from server.capture.shot import Shot, Source
from server.cli.options import Given, config_from_options
from server.cli.output import lines_to
from server.cli.stopping import Stopping
from server.config import Config
from server.errors import CaptureError
from server.logs import LogSettings, configure_logging
from server.marker_remarks import warn_of_markers
from server.setup import Preparation, build_setup
from tracker.errors import InvalidInput
from tracker.navigation import Setup
from tracker.pipeline import Tracker
from tracker.pose import Seen, Sighting, Unseen

BAD_INPUT = 2
STOPPED = 130
log = structlog.get_logger(__name__)


def track_video(
    given: Given,
    *,
    json_file: str | None,
    replace: bool,
    images: int | None,
    log_json: bool,
    debug: bool,
) -> int:
    """Track every image, and give the exit status: 0, 2 when some cannot be read, 130 when stopped.

    Raises:
        NavigationError: an option, the video, a marker or the camera file cannot be used.
    """
    configure_logging(LogSettings.for_terminal(as_json=True if log_json else None, debug=debug))
    config = config_from_options(given)
    address = source_from_text(config.camera.source)
    if address.kind not in (SourceKind.PATH, SourceKind.REHEARSAL):
        raise InvalidInput(
            "TRACK_NEEDS_A_FILE",
            f"'{address.name}' is a {address.kind.value}, which has no end",
            "Give a video file, a folder of images or 'rehearsal'; for a live source use 'coaxial run'.",
        )
    preparation = _with_a_marker(build_setup(config))
    warn_of_markers(preparation.models)
    theatre = preparation.theatre
    if theatre is not None:
        cycle = round(theatre.cycle_s * config.rehearsal.rate_hz)
        images = cycle if images is None else images
    renderer = None if theatre is None else theatre.renderer()
    silences = () if theatre is None else theatre.settings.events
    source = source_from_config(config, stop=threading.Event(), renderer=renderer, silences=silences)
    summary = _Summary()
    output = lines_to(json_file, inputs=_read_files(given, config), replace=replace)
    try:
        with Stopping().caught() as stopping:
            # A signal waits for the end of the image: inside a compiled loop it would end in a traceback.
            stopping.call_when_asked(_let_a_second_one_end_it)
            source.open()
            with output as lines, _progress(_count(config, images)) as advance:
                for shot, read_ms in _shots(source, images, stopping):
                    for line in summary.lines_of(shot, read_ms, preparation):
                        if lines is not None:
                            lines.write(json.dumps(line, allow_nan=False))
                    advance()
    except CaptureError as error:
        # Nothing is tried again here, and it was no setting.
        remedy = "Give a video file that plays, or a folder of images."
        raise InvalidInput(error.code, error.message, remedy, error.context) from error
    except _StoppedError:
        typer.echo(f"Stopped: {summary.sentence()}", err=True)
        return STOPPED
    finally:
        source.close()
    typer.echo(summary.sentence(), err=True)
    if source.defect is not None:
        typer.echo(f"Error: {source.defect.message}.\n{source.defect.remedy}", err=True)
        return BAD_INPUT
    return 0


def _with_a_marker(preparation: Preparation) -> Preparation:
    if not preparation.models:
        raise InvalidInput(
            "NO_MARKER",
            "there is no marker to look for",
            "Give its picture with --marker PNG and its side with --side-mm, or put it into the settings.",
        )
    return preparation


class _StoppedError(Exception):
    """Somebody pressed Ctrl+C: leaves the lines as they are, so that a cut file keeps its .part."""


def _let_a_second_one_end_it() -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def _shots(source: Source, images: int | None, stopping: Stopping) -> Iterator[tuple[Shot, float]]:
    """Each image of the source, with the time it took to read."""
    count = 0
    while images is None or count < images:
        if stopping.asked:
            raise _StoppedError
        started_s = time.monotonic()
        shot = source.read()
        if shot is None:
            return
        count += 1
        yield shot, (time.monotonic() - started_s) * 1000.0


class _Summary:
    """Tracks, and remembers what the last line of the output says."""

    def __init__(self) -> None:
        self._images = 0
        self._seen: dict[str, int] = {}
        self._reasons: dict[str, Counter[str]] = defaultdict(Counter)
        self._whole_ms: list[float] = []
        self._times: dict[str, list[float]] = defaultdict(list)
        self._setup: Setup | None = None
        self._tracker: Tracker | None = None

    def lines_of(self, shot: Shot, read_ms: float, preparation: Preparation) -> list[dict[str, Any]]:
        """What is written of one image: a line a marker."""
        height, width = shot.image.shape[:2]
        if self._tracker is None or self._setup is None or self._setup.camera.size_wh_px != (width, height):
            self._setup = preparation.setup_for((width, height), image=_named(shot))
            self._tracker = preparation.tracker_for(self._setup)
        sightings = self._tracker.step(shot.image, captured_at_s=shot.source_time_s, whole=True)
        stage_ms = {"reading": read_ms, **self._tracker.stage_ms}
        self._images += 1
        self._whole_ms.append(sum(stage_ms.values()))
        for stage, took_ms in stage_ms.items():
            self._times[stage].append(took_ms)
        for name, sighting in sightings.items():
            self._seen[name] = self._seen.get(name, 0) + isinstance(sighting, Seen)
            if isinstance(sighting, Unseen):
                self._reasons[name][sighting.reason.value] += 1
        calibrated = self._setup.camera_calibrated
        sides_mm = {model.name: model.side_mm for model in self._tracker.models}
        return [
            {
                "image_number": shot.number,
                "time_s": round(shot.source_time_s, 6),
                "name": name,
                "side_mm": sides_mm[name],
                **_sighting(sighting, calibrated=calibrated),
                "stage_ms": {stage: round(took_ms, 3) for stage, took_ms in stage_ms.items()},
            }
            for name, sighting in sightings.items()
        ]

    def sentence(self) -> str:
        """Images, how many of them show each marker, why others do not, and the median times."""
        seen = ", ".join(f"{name} seen in {count}{self._why_not(name)}" for name, count in self._seen.items())
        whole = f"{statistics.median(self._whole_ms):.1f} an image" if self._whole_ms else "-"
        # A stage that an image could do without is no part of that image's time.
        times = "".join(
            f", {stage} {statistics.median(ms):.1f}{'' if len(ms) == self._images else f' in {len(ms)}'}"
            for stage, ms in self._times.items()
        )
        calibrated = self._setup is None or self._setup.camera_calibrated
        blind = "" if calibrated else "; no millimetres, as no camera file was given (--camera)"
        images = f"{self._images} image{'' if self._images == 1 else 's'}"
        return f"{images}: {seen or 'nothing'}; median ms: {whole}{times}{blind}"

    def _why_not(self, name: str) -> str:
        reasons = ", ".join(f"{reason} {count}" for reason, count in self._reasons[name].most_common())
        return f" (not in the others: {reasons})" if reasons else ""


def _named(shot: Shot) -> str:
    """The image by the number that its line has, and by its file."""
    return f"image {shot.number}" + ("" if shot.file is None else f" ({shot.file})")


def _sighting(sighting: Sighting, *, calibrated: bool) -> dict[str, Any]:
    """One marker in one image; millimetres only from a calibrated camera."""
    if not isinstance(sighting, Seen):
        return {
            "seen": False,
            "reason": sighting.reason.value,
            "best_score_ratio": sighting.best_score_ratio,
            **dict.fromkeys(SEEN_KEYS),
        }
    pose = sighting.camera_from_marker
    rigid = {"rotation": pose.rotation.tolist(), "translation_mm": pose.translation_mm.tolist()}
    return {
        "seen": True,
        "reason": None,
        "best_score_ratio": sighting.score_ratio,
        "camera_from_marker": rigid if calibrated else None,
        "pose_covariance": sighting.pose_covariance.tolist() if calibrated else None,
        "corners_px": sighting.corners_px.tolist(),
        "score_ratio": sighting.score_ratio,
        "target_score_ratio": sighting.target_score_ratio,
        "model_coverage_ratio": sighting.model_coverage_ratio,
        "target_coverage_ratio": sighting.target_coverage_ratio,
        "fit_error_px2": sighting.fit_error_px2,
        "found_by": sighting.found_by,
    }


SEEN_KEYS = (
    "camera_from_marker",
    "pose_covariance",
    "corners_px",
    "score_ratio",
    "target_score_ratio",
    "model_coverage_ratio",
    "target_coverage_ratio",
    "fit_error_px2",
    "found_by",
)


def _read_files(given: Given, config: Config) -> list[Path]:
    """What is read, and must not be written over."""
    files = [Path(str(config.camera.source)), *(marker.image for marker in config.markers.values())]
    return files + [file for file in (config.camera.calibration, given.config) if file is not None]


def _count(config: Config, images: int | None) -> int | None:
    """How many images there will be, if that can be told."""
    path = Path(str(config.camera.source))
    if images is not None or not path.is_file():
        return images
    video = open_file(str(path))
    count = int(video.get(cv2.CAP_PROP_FRAME_COUNT))
    video.release()
    return count if count > 0 else None


@contextlib.contextmanager
def _progress(total: int | None) -> Iterator[Any]:
    """A progress bar on standard error if that is a terminal; gives the function that moves it on."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda: None
        return
    columns = (TextColumn("images"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task("images", total=total)
        yield lambda: progress.advance(task)

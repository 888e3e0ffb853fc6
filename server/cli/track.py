"""`coaxial track`: track every image of a video and write the results as JSON lines.

The output file is renamed from `.part` when every image was processed. Images that cannot be read are
reported, with exit status 2. Only an interrupted run leaves a `.part` file.
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

from server.camera_remarks import warn_of_configured_camera, warn_of_doubtful_focal_length
from server.capture.address import SourceKind, source_from_text
from server.capture.codecs import open_file
from server.capture.shot import Shot, Source
from server.capture.source_factory import source_from_config
from server.certificate import calibration_sha256
from server.cli.options import SettingOptions, config_from_options
from server.cli.output import line_writer
from server.cli.stop_signal import StopSignal
from server.config import Config
from server.errors import CaptureError
from server.logs import LogSettings, configure_logging
from server.marker_remarks import reject_ambiguous_markers
from server.setup import Preparation, build_setup
from tracker.errors import InvalidInput
from tracker.navigation import Setup
from tracker.photometric import FocalLengthError
from tracker.pipeline import Tracker
from tracker.pose import Seen, Sighting, Unseen

BAD_INPUT = 2
STOPPED = 130
log = structlog.get_logger(__name__)


def track_video(
    given: SettingOptions,
    *,
    json_file: str | None,
    replace: bool,
    images: int | None,
    log_json: bool,
    debug: bool,
) -> int:
    """Track every image. Return the exit status: 0, 2 if images cannot be read, 130 if stopped.

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
    preparation = _require_marker(build_setup(config))
    reject_ambiguous_markers(preparation.models)
    warn_of_configured_camera(config)
    theatre = preparation.theatre
    if theatre is not None:
        cycle = round(theatre.cycle_s * config.rehearsal.rate_hz)
        images = cycle if images is None else images
    renderer = None if theatre is None else theatre.renderer()
    silences = () if theatre is None else theatre.settings.events
    source = source_from_config(config, stop=threading.Event(), renderer=renderer, outages=silences)
    summary = _Summary()
    output = line_writer(json_file, inputs=_read_files(given, config), replace=replace)
    try:
        with StopSignal().caught() as stopping:
            # A signal waits for the end of the image: inside a compiled loop it would end in a traceback.
            stopping.on_stop(_exit_on_second_signal)
            source.open()
            with output as lines, _progress(_count(config, images)) as advance:
                for shot, read_ms in _shots(source, images, stopping):
                    for line in summary.lines_of(shot, read_ms, preparation):
                        if lines is not None:
                            lines.write(json.dumps(line, allow_nan=False))
                    advance()
    except CaptureError as error:
        # A file is not reopened, and the error is in the input, not in the settings.
        remedy = "Give a readable video file or a folder of images."
        raise InvalidInput(error.code, error.message, remedy, error.context) from error
    except _StoppedError:
        typer.echo(f"Stopped: {summary.sentence()}", err=True)
        return STOPPED
    finally:
        source.close()
    typer.echo(summary.sentence(), err=True)
    if (error := summary.focal_length_error) is not None:
        warn_of_doubtful_focal_length(error)
    if source.defect is not None:
        typer.echo(f"Error: {source.defect.message}.\n{source.defect.remedy}", err=True)
        return BAD_INPUT
    return 0


def _require_marker(preparation: Preparation) -> Preparation:
    if not preparation.models:
        raise InvalidInput(
            "NO_MARKER",
            "no marker is configured",
            "Give its image with --marker PNG and its side with --side-mm, or add it to the settings.",
        )
    return preparation


class _StoppedError(Exception):
    """Raised after Ctrl+C; the incomplete output file keeps its .part suffix."""


def _exit_on_second_signal() -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def _shots(source: Source, images: int | None, stopping: StopSignal) -> Iterator[tuple[Shot, float]]:
    """Yield each image of the source and its read time in ms."""
    count = 0
    while images is None or count < images:
        if stopping.count:
            raise _StoppedError
        started_s = time.monotonic()
        shot = source.read()
        if shot is None:
            return
        count += 1
        yield shot, (time.monotonic() - started_s) * 1000.0


class _Summary:
    """Tracker of one run, with the statistics for its summary."""

    def __init__(self) -> None:
        self._images = 0
        self._seen: dict[str, int] = {}
        self._reasons: dict[str, Counter[str]] = defaultdict(Counter)
        self._total_ms: list[float] = []
        self._times: dict[str, list[float]] = defaultdict(list)
        self._setup: Setup | None = None
        self._tracker: Tracker | None = None
        self._calibration_sha256: str | None = None

    def lines_of(self, shot: Shot, read_ms: float, preparation: Preparation) -> list[dict[str, Any]]:
        """Track one image; return one output line per marker."""
        height, width = shot.image.shape[:2]
        if self._tracker is None or self._setup is None or self._setup.camera.size_wh_px != (width, height):
            self._setup = preparation.setup_for((width, height), image=_named(shot))
            self._tracker = preparation.tracker_for(self._setup)
            calibrated = self._setup.camera_calibrated
            self._calibration_sha256 = calibration_sha256(self._setup.camera) if calibrated else None
        sightings = self._tracker.step(
            shot.image, captured_at_s=shot.source_time_s, full_search=True, is_predicted=shot.is_predicted
        )
        stage_ms = {"reading": read_ms, **self._tracker.stage_ms}
        self._images += 1
        self._total_ms.append(sum(stage_ms.values()))
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
                "calibration_sha256": self._calibration_sha256,
                **_sighting(sighting, calibrated=calibrated),
                "stage_ms": {stage: round(took_ms, 3) for stage, took_ms in stage_ms.items()},
            }
            for name, sighting in sightings.items()
        ]

    @property
    def focal_length_error(self) -> FocalLengthError | None:
        """Return the error of the camera file by the markers; None if unknown, or without a camera file."""
        is_calibrated = self._setup is not None and self._setup.camera_calibrated
        return self._tracker.focal_length.error if self._tracker is not None and is_calibrated else None

    def sentence(self) -> str:
        """Return the summary: detections and misses per marker, and median times per stage."""
        seen = ", ".join(
            f"{name} seen in {count}{self._miss_reasons(name)}" for name, count in self._seen.items()
        )
        total = f"{statistics.median(self._total_ms):.1f} per image" if self._total_ms else "-"
        # A stage that was skipped in an image does not count towards the time of that image.
        times = "".join(
            f", {stage} {statistics.median(ms):.1f}{'' if len(ms) == self._images else f' in {len(ms)}'}"
            for stage, ms in self._times.items()
        )
        calibrated = self._setup is None or self._setup.camera_calibrated
        uncalibrated = "" if calibrated else "; no result in mm without a camera file (--camera)"
        images = f"{self._images} image{'' if self._images == 1 else 's'}"
        return f"{images}: {seen or 'nothing'}; median ms: {total}{times}{uncalibrated}"

    def _miss_reasons(self, name: str) -> str:
        reasons = ", ".join(f"{reason} {count}" for reason, count in self._reasons[name].most_common())
        return f" (missed: {reasons})" if reasons else ""


def _named(shot: Shot) -> str:
    """Return the number and the file of an image, for messages."""
    return f"image {shot.number}" + ("" if shot.file is None else f" ({shot.file})")


def _sighting(sighting: Sighting, *, calibrated: bool) -> dict[str, Any]:
    """Return the output fields of one marker. Poses are null without a calibrated camera."""
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


def _read_files(given: SettingOptions, config: Config) -> list[Path]:
    """Return the input files, which must not be overwritten."""
    files = [Path(str(config.camera.source)), *(marker.image for marker in config.markers.values())]
    return files + [file for file in (config.camera.calibration, given.config) if file is not None]


def _count(config: Config, images: int | None) -> int | None:
    """Return the expected number of images; None if unknown."""
    path = Path(str(config.camera.source))
    if images is not None or not path.is_file():
        return images
    video = open_file(str(path))
    count = int(video.get(cv2.CAP_PROP_FRAME_COUNT))
    video.release()
    return count if count > 0 else None


@contextlib.contextmanager
def _progress(total: int | None) -> Iterator[Any]:
    """Show a progress bar if standard error is a terminal; yield the function that advances it."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda: None
        return
    columns = (TextColumn("images"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task("images", total=total)
        yield lambda: progress.advance(task)

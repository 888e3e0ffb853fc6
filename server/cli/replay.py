"""`coaxial replay`: describe a recording, and check that replaying it gives the same results."""

import json
from pathlib import Path

import cv2
import typer

from server.alarms import alarm_limits
from server.config_file import load_config
from server.loop.worker import OPENCV_THREADS
from server.recording.messages import SessionMessage
from server.recording.replay import Difference, Differences, ReplayReport, check_recording
from server.recording_file import RecordingReader, Topic, rejecting_other_content

EQUAL, DIFFERENT = 0, 1


def describe_file(path: Path, *, as_json: bool) -> int:
    """Print the contents of a recording. Return the exit status.

    Raises:
        RecordingError: The recording cannot be read.
    """
    reader = RecordingReader(path)
    session: SessionMessage | None = None
    images, notes, first_s, last_s = 0, [], None, 0.0
    with rejecting_other_content(path):
        for message in reader.messages():
            if message.topic is Topic.SESSION:
                session = SessionMessage.model_validate(message.json())
            elif message.topic is Topic.IMAGE:
                images += 1
                first_s = message.unix_s if first_s is None else first_s
                last_s = message.unix_s
            elif message.topic is Topic.NOTE:
                notes.append(str(message.json()["message"]))
    duration_s = 0.0 if first_s is None else last_s - first_s
    if as_json:
        values = {
            "images": images,
            "duration_s": duration_s,
            "is_whole": reader.is_whole,
            "incomplete_reason": reader.incomplete_reason,
            "notes": notes,
            "session": None if session is None else session.model_dump(mode="json"),
        }
        typer.echo(json.dumps(values, ensure_ascii=False))
        return EQUAL if images else DIFFERENT
    if session is not None:
        typer.echo(f"recorded {session.started_at} from {session.source}")
        typer.echo(f"by Coaxial {session.product_version} on {session.machine}, Python {session.python}")
    typer.echo(f"{images} images in {duration_s:.1f} s, {path.stat().st_size / 1e6:.1f} MB")
    _print_end(notes, is_whole=reader.is_whole, incomplete_reason=reader.incomplete_reason)
    return EQUAL if images else DIFFERENT


def check_file(path: Path, *, config: Path | None, as_json: bool) -> int:
    """Replay a recording and print the first and the largest difference. Return the exit status.

    Raises:
        NavigationError: The recording or the settings cannot be read.
    """
    limits = None if config is None else alarm_limits(load_config(config))
    # The same number of threads as during the recording.
    cv2.setNumThreads(OPENCV_THREADS)
    report = check_recording(path, limits=limits)
    if as_json:
        typer.echo(json.dumps(_values(report), ensure_ascii=False))
    else:
        _print(report)
    return EQUAL if report.is_equal else DIFFERENT


def _print(report: ReplayReport) -> None:
    for line in report.changed_versions:
        typer.echo(line)
    _print_differences("poses", report.poses, f"{report.images} images", "images")
    _print_differences("alarms", report.alarms, f"{report.steps} steps", "steps")
    if report.unchecked_images or report.missing_images:
        typer.echo(
            f"not compared: {report.unchecked_images} images, because the tracking state before them is not "
            f"in the file; {report.missing_images} images are missing"
        )
    if report.unchecked_steps:
        typer.echo(f"not compared: {report.unchecked_steps} alarm steps")
    if not report.images:
        typer.echo("no image could be compared")
    if report.is_damaged:
        typer.echo(f"the file is damaged: {report.incomplete_reason}; nothing after that point was compared")
    _print_end(
        report.remarks,
        is_whole=report.is_whole or report.is_damaged,
        incomplete_reason=report.incomplete_reason,
    )


def _print_differences(what: str, found: Differences, compared: str, unit: str) -> None:
    if found.first is None or found.worst is None:
        typer.echo(f"{what}: identical in {compared}")
        return
    typer.echo(f"{what}: {found.images} of {compared} differ")
    typer.echo(f"  first of these {unit}: {found.first}")
    typer.echo(f"  largest difference: {found.worst}")


def _print_end(remarks: list[str], *, is_whole: bool, incomplete_reason: str) -> None:
    for remark in remarks:
        typer.echo(f"note: {remark}")
    if not is_whole:
        typer.echo(f"the file is incomplete: {incomplete_reason}; it was read up to that point")


def _values(report: ReplayReport) -> dict[str, object]:
    return {
        "is_equal": report.is_equal,
        "images": report.images,
        "unchecked_images": report.unchecked_images,
        "missing_images": report.missing_images,
        "steps": report.steps,
        "unchecked_steps": report.unchecked_steps,
        "poses": _difference_values(report.poses),
        "alarms": _difference_values(report.alarms),
        "changed_versions": report.changed_versions,
        "remarks": report.remarks,
        "is_whole": report.is_whole,
        "is_damaged": report.is_damaged,
        "incomplete_reason": report.incomplete_reason,
    }


def _difference_values(found: Differences) -> dict[str, object]:
    return {"different": found.images, "first": _one(found.first), "worst": _one(found.worst)}


def _one(found: Difference | None) -> dict[str, object] | None:
    if found is None:
        return None
    return {
        "image_number": found.image_number,
        "what": found.what,
        "recorded": found.recorded,
        "replayed": found.replayed,
    }

"""`coaxial certify rehearse`: the files of a simulated accuracy test."""

import json
from datetime import UTC, datetime
from pathlib import Path

import typer
import yaml

from server.camera_file import CameraFile, camera_file_text
from server.certificate import PlateFile, calibration_sha256, text_of_plate_file
from server.cli.output import write_atomically
from server.printing import grid_of_divots
from server.printing.plate_sheet import RULER_MM
from server.tool_file import PivotPart, ToolFile, text_of_tool_file
from tracker.accuracy.rehearsed import RehearsedCapture, RehearsedFaults, RehearsedSystem, rehearse
from tracker.errors import InvalidInput

MARKER = "drill"


def write_rehearsal(folder: Path, faults: RehearsedFaults, *, seed: int) -> None:
    """Write plate, camera, tool and captures, and print the command that reads them.

    Raises:
        InvalidInput: OUTPUT_EXISTS, OUTPUT_NOT_WRITABLE.
    """
    if folder.exists() and any(folder.iterdir()):
        raise InvalidInput(
            "OUTPUT_EXISTS",
            f"the folder {folder} is not empty",
            "Give another folder with --output.",
            {"file": str(folder)},
        )
    plate = PlateFile(
        name="rehearsal",
        sd_mm=0.1,
        rulers_mm=float(RULER_MM),
        divots={name: list(point) for name, point in grid_of_divots(3, 3, 60.0).items()},
    )
    system = RehearsedSystem(plate=plate.plate(), faults=faults, seed=seed)
    captures = rehearse(system, seed=0)
    for name, text in (
        ("plate.yaml", text_of_plate_file(plate)),
        (
            "camera.yaml",
            camera_file_text(CameraFile(model=system.stated_camera, camera_name="rehearsal"), {}),
        ),
        ("tool.yaml", text_of_tool_file(_tool_file(system))),
    ):
        write_atomically(folder / name, text.encode())
    entries = []
    for number, capture in enumerate(captures, start=1):
        poses = f"poses/{number:03d}.jsonl"
        write_atomically(folder / poses, _lines(capture, system).encode())
        entries.append(
            {
                "divot": capture.divot,
                "placement": capture.placement,
                "posture": capture.posture,
                "poses": poses,
            }
        )
    listed = {"kind": "coaxial accuracy captures", "captures": entries}
    write_atomically(folder / "captures.yaml", yaml.safe_dump(listed, sort_keys=False).encode())
    length = RULER_MM * (1.0 + faults.print_scale_ratio)
    typer.echo(
        f"Wrote {len(captures)} captures into {folder}. Its rulers measure {length:g} mm. Assess it with:\n"
        f"coaxial certify issue {folder}/captures.yaml --plate {folder}/plate.yaml "
        f"--camera {folder}/camera.yaml --tool {folder}/tool.yaml --rulers-mm {length:g},{length:g}"
    )


def _tool_file(system: RehearsedSystem) -> ToolFile:
    tool = system.tool
    return ToolFile(
        marker=MARKER,
        side_mm=system.side_mm,
        pivot=PivotPart(
            tip_in_marker_mm=tool.tip_in_marker_mm.tolist(),
            covariance_mm2=tool.tip_covariance_mm2.tolist(),
            rms_3d_mm=0.1,
            used=60,
            rejected=0,
            tilt_range_deg=60.0,
            made_at=datetime(2026, 1, 1, tzinfo=UTC),
        ),
    )


def _lines(capture: RehearsedCapture, system: RehearsedSystem) -> str:
    """Return the poses as `coaxial track --json` writes them."""
    poses = capture.poses
    lines = []
    for number in range(len(poses)):
        line = {
            "name": MARKER,
            "side_mm": system.side_mm,
            "calibration_sha256": calibration_sha256(system.stated_camera),
            "seen": True,
            "camera_from_marker": {
                "rotation": poses.rotations[number].tolist(),
                "translation_mm": poses.translations_mm[number].tolist(),
            },
        }
        if poses.covariances is not None:
            line["pose_covariance"] = poses.covariances[number].tolist()
        lines.append(json.dumps(line))
    return "\n".join(lines) + "\n"

"""`coaxial cameras`: list the cameras of this computer with their modes and controls."""

import contextlib
import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

import typer

from server.camera_file import load_camera_file
from server.capture.modes import WantedMode, choose_mode
from server.capture.source_factory import wanted_mode
from server.capture.v4l2 import (
    ControlReading,
    DeviceDescription,
    VideoDevices,
    system_devices,
)
from server.cli.industrial_cameras import (
    control_values,
    find_industrial_cameras,
    industrial_lines,
    industrial_values,
    installed_libraries,
    mode_values,
)
from server.config_file import load_config
from server.live import CameraMode
from tracker.camera import CameraControl

NO_CAMERA = 1
NONE_FOUND = (
    "no camera was found on this computer",
    "Connect a camera and check that it appears as /dev/video0 or similar (ls /dev/video*); pass it to a "
    "container with --device /dev/video0. Network cameras are not listed: give their address with --source. "
    "A phone can be the camera as well: --source phone. Industrial cameras need pip install "
    "'coaxial[basler]', or 'coaxial[genicam]' and a GenTL producer.",
)
NONE_KNOWN = (
    "cameras can only be listed on Linux",
    "Try them by number: coaxial run --source 0, then 1.",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class FoundCamera:
    """A camera, or a video device that could not be queried.

    Attributes:
        path: Device file.
        description: None if the query failed.
        modes: Supported modes.
        chosen: The mode that Coaxial selects; None if it can decode none of them.
        controls: Supported controls with their present values.
        problem: Why the query failed; empty if it succeeded.
    """

    path: str
    description: DeviceDescription | None = None
    modes: tuple[CameraMode, ...] = ()
    chosen: CameraMode | None = None
    controls: Mapping[CameraControl, ControlReading]
    problem: str = ""


def list_cameras(config_file: Path | None, *, as_json: bool) -> int:
    """Print the cameras, and return the exit status: 0, or 1 if there is none.

    Raises:
        NavigationError: the settings or their camera file cannot be used.
    """
    config = load_config(config_file)
    calibration = config.camera.calibration
    size_wh_px = None if calibration is None else load_camera_file(calibration).size_wh_px
    wanted = wanted_mode(config.camera)
    found = find_cameras(system_devices(), wanted, calibrated_size_wh_px=size_wh_px)
    industrial = find_industrial_cameras(
        installed_libraries(),
        wanted,
        calibrated_size_wh_px=size_wh_px,
        is_triggered=config.camera.trigger is not None,
    )
    if as_json:
        values = [*map(camera_values, found), *map(industrial_values, industrial)]
        typer.echo(json.dumps({"cameras": values}, indent=2))
    else:
        lines = [line for camera in found for line in _lines(camera)]
        lines += [line for camera in industrial for line in industrial_lines(camera)]
        typer.echo("\n".join(lines), nl=bool(lines))
    if found or any(camera.description.serial for camera in industrial):
        return 0
    message, remedy = NONE_FOUND if sys.platform == "linux" else NONE_KNOWN
    typer.echo(f"Error: {message}.\n{remedy}", err=True)
    return NO_CAMERA


def find_cameras(
    devices: VideoDevices, wanted: WantedMode, *, calibrated_size_wh_px: tuple[int, int] | None
) -> list[FoundCamera]:
    """Return the devices that capture images, and those that could not be queried."""
    found: list[FoundCamera] = []
    for path in devices.paths():
        try:
            device = devices.open(path)
            with contextlib.closing(device):
                description = device.description()
                if not description.captures:
                    continue
                modes = device.modes()
                readings = {control: device.control(control) for control in CameraControl}
        except OSError as error:
            problem = (error.strerror or str(error)).lower()
            found.append(FoundCamera(path=path, controls={}, problem=problem))
            continue
        found.append(
            FoundCamera(
                path=path,
                description=description,
                modes=modes,
                chosen=choose_mode(modes, wanted, calibrated_size_wh_px=calibrated_size_wh_px),
                controls={control: one for control, one in readings.items() if one is not None},
            )
        )
    return found


def camera_values(camera: FoundCamera) -> dict[str, object]:
    """Return a camera as a JSON object."""
    description = camera.description
    if description is None:
        return {"path": camera.path, "problem": camera.problem}
    return {
        "path": camera.path,
        "name": description.name,
        "driver": description.driver,
        "bus": description.bus,
        "modes": [mode_values(mode) for mode in camera.modes],
        "chosen": None if camera.chosen is None else mode_values(camera.chosen),
        "controls": control_values(camera.controls),
    }


def _lines(camera: FoundCamera) -> list[str]:
    description = camera.description
    if description is None:
        return [
            f"{camera.path}  cannot be opened: {camera.problem}",
            "    Check the read permission (group 'video') and the cable.",
        ]
    lines = [f"{camera.path}  {description.name}  ({description.bus}, {description.driver})"]
    for (fourcc, (width, height)), modes in groupby(
        camera.modes, key=lambda mode: (mode.fourcc, mode.size_wh_px)
    ):
        rates = ", ".join(f"{mode.rate_hz:.4g}" for mode in modes if mode.rate_hz > 0.0)
        lines.append(f"    {fourcc:<5} {width:>5} x {height:<5} {rates + ' Hz' if rates else 'any rate'}")
    controls = [f"{control.value} {reading.value}" for control, reading in camera.controls.items()]
    if controls:
        lines.append(f"    controls: {', '.join(controls)}")
    lines.append(
        "    Coaxial cannot decode any of these formats"
        if camera.chosen is None
        else f"    Coaxial uses {camera.chosen}"
    )
    return lines

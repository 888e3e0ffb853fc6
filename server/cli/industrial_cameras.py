"""Industrial cameras in `coaxial cameras`: modes and controls, for each installed vendor library."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from server.capture.industrial import (
    BaslerCameras,
    Bounds,
    CameraCapabilities,
    GenTLCameras,
    IndustrialCameras,
    IndustrialControls,
    IndustrialDescription,
    choose_industrial_mode,
    producers,
    read_capabilities,
)
from server.capture.modes import WantedMode
from server.capture.v4l2 import ControlReading
from server.live import CameraMode
from tracker.camera import CameraControl


@dataclass(frozen=True, slots=True, kw_only=True)
class FoundIndustrialCamera:
    """An industrial camera, one that could not be opened, or a library that could not list its cameras.

    Attributes:
        description: its identity; without a serial number for a library.
        offer: its capabilities; None if the query failed.
        chosen: the mode that Coaxial selects; None if it can decode none of its formats.
        controls: supported controls with their present values.
        problem: why the query failed; empty if it succeeded.
    """

    description: IndustrialDescription
    offer: CameraCapabilities | None = None
    chosen: CameraMode | None = None
    controls: Mapping[CameraControl, ControlReading]
    problem: str = ""


def installed_libraries() -> tuple[IndustrialCameras, ...]:
    """Return the installed vendor libraries; harvesters needs a GenTL producer of the vendor."""
    return (BaslerCameras(), GenTLCameras()) if producers() else (BaslerCameras(),)


def find_industrial_cameras(
    libraries: Sequence[IndustrialCameras],
    wanted: WantedMode,
    *,
    calibrated_size_wh_px: tuple[int, int] | None,
    is_triggered: bool,
) -> list[FoundIndustrialCamera]:
    """Return the cameras of all libraries; a missing library has none, one that fails has an address only."""
    found: list[FoundIndustrialCamera] = []
    for library in libraries:
        try:
            descriptions = library.descriptions()
        except ImportError:
            continue
        except OSError as error:
            failed = IndustrialDescription(address=f"{library.extra}:", name="", serial="", bus="")
            found.append(FoundIndustrialCamera(description=failed, controls={}, problem=str(error)))
            continue
        for description in descriptions:
            try:
                camera = library.open(description.serial)
            except OSError as error:
                found.append(FoundIndustrialCamera(description=description, controls={}, problem=str(error)))
                continue
            try:
                offer = read_capabilities(camera)
                reading = IndustrialControls(camera).control
                chosen = choose_industrial_mode(
                    offer, wanted, calibrated_size_wh_px=calibrated_size_wh_px, is_triggered=is_triggered
                )
                controls = {one: at for one in CameraControl if (at := reading(one)) is not None}
                found.append(
                    FoundIndustrialCamera(
                        description=description, offer=offer, chosen=chosen, controls=controls
                    )
                )
            except OSError as error:
                found.append(FoundIndustrialCamera(description=description, controls={}, problem=str(error)))
            finally:
                camera.close()
    return found


def industrial_values(camera: FoundIndustrialCamera) -> dict[str, object]:
    """Return a camera as a JSON object."""
    description, offer = camera.description, camera.offer
    values: dict[str, object] = {
        "path": description.address,
        "name": description.name,
        "serial": description.serial,
        "bus": description.bus,
    }
    if offer is None:
        return values | {"problem": camera.problem}
    return values | {
        "pixel_formats": list(offer.pixel_formats),
        "width_px": _bounds_values(offer.width_px),
        "height_px": _bounds_values(offer.height_px),
        "rate_hz": None if offer.rate_hz is None else _bounds_values(offer.rate_hz),
        "triggers": list(offer.triggers),
        "chosen": None if camera.chosen is None else mode_values(camera.chosen),
        "controls": control_values(camera.controls),
    }


def mode_values(mode: CameraMode) -> dict[str, object]:
    """Return a mode as a JSON object."""
    width, height = mode.size_wh_px
    return {"fourcc": mode.fourcc, "width_px": width, "height_px": height, "rate_hz": mode.rate_hz}


def control_values(controls: Mapping[CameraControl, ControlReading]) -> dict[str, object]:
    """Return controls as a JSON object."""
    return {
        control.value: {"value": one.value, "min": one.min_value, "max": one.max_value}
        for control, one in controls.items()
    }


def industrial_lines(camera: FoundIndustrialCamera) -> list[str]:
    """Return the printed lines of a camera."""
    description, offer = camera.description, camera.offer
    if not description.serial:
        return [
            f"{description.address}  its cameras cannot be listed: {camera.problem}",
            "    Check that its library and driver are installed completely.",
        ]
    if offer is None:
        return [
            f"{description.address}  cannot be opened: {camera.problem}",
            "    Check that no other program uses it.",
        ]
    width, height, rate = offer.width_px, offer.height_px, offer.rate_hz
    lines = [
        f"{description.address}  {description.name}  ({description.bus})",
        f"    {', '.join(offer.pixel_formats)}",
        f"    {_range(width)} x {_range(height)}, "
        + ("any rate" if rate is None else f"{rate.min_value:.4g} to {rate.max_value:.4g} Hz"),
    ]
    if offer.triggers:
        lines.append(f"    triggers: {', '.join(offer.triggers)}")
    if camera.controls:
        values = (f"{control.value} {reading.value}" for control, reading in camera.controls.items())
        lines.append(f"    controls: {', '.join(values)}")
    lines.append(
        "    Coaxial cannot decode any of these formats"
        if camera.chosen is None
        else f"    Coaxial uses {camera.chosen}"
    )
    return lines


def _range(bounds: Bounds) -> str:
    return f"{bounds.min_value:.0f} to {bounds.max_value:.0f}"


def _bounds_values(bounds: Bounds) -> dict[str, float]:
    return {"min": bounds.min_value, "max": bounds.max_value, "step": bounds.step}

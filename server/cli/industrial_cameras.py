"""The industrial cameras in `coaxial cameras`: of each library that is installed, what its cameras offer."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from server.capture.industrial import (
    BaslerCameras,
    Bounds,
    GenTLCameras,
    IndustrialCameras,
    IndustrialControls,
    IndustrialDescription,
    Offer,
    chosen_mode,
    offer_of,
    producers,
)
from server.capture.modes import WantedMode
from server.capture.v4l2 import ControlReading
from server.live import CameraMode
from tracker.camera import CameraControl


@dataclass(frozen=True, slots=True, kw_only=True)
class FoundIndustrialCamera:
    """One industrial camera, or one that could not be asked.

    Attributes:
        description: which one.
        offer: None when it could not be asked.
        chosen: the mode that Coaxial takes; None where it offers no pixel format that is read.
        controls: that it has, with their values now.
        problem: why it could not be asked; empty where it could.
    """

    description: IndustrialDescription
    offer: Offer | None = None
    chosen: CameraMode | None = None
    controls: Mapping[CameraControl, ControlReading]
    problem: str = ""


def installed_libraries() -> tuple[IndustrialCameras, ...]:
    """Those that can be asked; harvesters finds nothing without a vendor's producer."""
    return (BaslerCameras(), GenTLCameras()) if producers() else (BaslerCameras(),)


def find_industrial_cameras(
    libraries: Sequence[IndustrialCameras],
    wanted: WantedMode,
    *,
    calibrated_size_wh_px: tuple[int, int] | None,
    is_triggered: bool,
) -> list[FoundIndustrialCamera]:
    """All cameras of all libraries; of a library that is missing or does not answer, none."""
    found: list[FoundIndustrialCamera] = []
    for library in libraries:
        try:
            descriptions = library.descriptions()
        except (ImportError, OSError):
            continue
        for description in descriptions:
            try:
                camera = library.open(description.serial)
            except OSError as error:
                found.append(FoundIndustrialCamera(description=description, controls={}, problem=str(error)))
                continue
            try:
                offer = offer_of(camera)
                reading = IndustrialControls(camera).control
                chosen = chosen_mode(
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
    """A camera as JSON has it."""
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
    """A mode as JSON has it."""
    width, height = mode.size_wh_px
    return {"fourcc": mode.fourcc, "width_px": width, "height_px": height, "rate_hz": mode.rate_hz}


def control_values(controls: Mapping[CameraControl, ControlReading]) -> dict[str, object]:
    """Controls as JSON has them."""
    return {
        control.value: {"value": one.value, "min": one.min_value, "max": one.max_value}
        for control, one in controls.items()
    }


def industrial_lines(camera: FoundIndustrialCamera) -> list[str]:
    """A camera as a person reads it."""
    description, offer = camera.description, camera.offer
    if offer is None:
        return [
            f"{description.address}  cannot be asked: {camera.problem}",
            "    See that no other program has it.",
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
        told = (f"{control.value} {reading.value}" for control, reading in camera.controls.items())
        lines.append(f"    controls: {', '.join(told)}")
    lines.append(
        "    Coaxial takes none of them: it reads none of these formats"
        if camera.chosen is None
        else f"    Coaxial takes {camera.chosen}"
    )
    return lines


def _range(bounds: Bounds) -> str:
    return f"{bounds.min_value:.0f} to {bounds.max_value:.0f}"


def _bounds_values(bounds: Bounds) -> dict[str, float]:
    return {"min": bounds.min_value, "max": bounds.max_value, "step": bounds.step}

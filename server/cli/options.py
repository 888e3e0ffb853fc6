"""Settings from the options of a command."""

from dataclasses import dataclass
from pathlib import Path

from server.capture.address import SourceKind, source_from_text
from server.config import Config
from server.config_file import Override, load_config
from tracker.errors import InvalidInput


@dataclass(frozen=True, slots=True, kw_only=True)
class SettingOptions:
    """Options that override settings; None or empty if not given."""

    config: Path | None = None
    source: str | None = None
    markers: tuple[Path, ...] = ()
    sides_mm: tuple[float, ...] = ()
    names: tuple[str, ...] = ()
    camera: Path | None = None
    port: int | None = None
    loop: bool | None = None
    rate: str | None = None
    speed: float | None = None


def config_from_options(given: SettingOptions) -> Config:
    """Return the settings file with the options applied.

    Raises:
        ConfigError: a setting cannot be used.
        InvalidInput: MARKER_OPTIONS_UNEVEN.
    """
    overrides: dict[tuple[str, ...], Override] = {}

    def put(key: tuple[str, ...], value: object, origin: str) -> None:
        if value is not None:
            overrides[key] = Override(value=value, origin=origin)

    put(("server", "port"), given.port, "--port")
    put(("camera", "calibration"), None if given.camera is None else str(given.camera), "--camera")
    put(("camera", "loop"), given.loop, "--loop")
    put(("camera", "rate"), given.rate, "--rate")
    put(("camera", "playback_speed"), given.speed, "--speed")
    if given.source is not None:
        put(("camera", "source"), given.source, "--source")
        if source_from_text(given.source).kind is SourceKind.REHEARSAL:
            # The simulated theatre has its own calibration.
            overrides.setdefault(("camera", "calibration"), Override(value=None, origin="--source"))
    for name, picture, side_mm in _markers(given):
        put(("markers", name), {"image": str(picture), "side_mm": side_mm}, f"--marker {picture}")
    return load_config(given.config, overrides=overrides)


def _markers(given: SettingOptions) -> list[tuple[str, Path, float]]:
    """Return name, image and side of each --marker."""
    count = len(given.markers)
    sides = given.sides_mm * count if len(given.sides_mm) == 1 else given.sides_mm
    names = given.names or tuple(_name_from_file(picture) for picture in given.markers)
    if len(sides) != count or len(names) != count or len(set(names)) != count:
        raise InvalidInput(
            "MARKER_OPTIONS_UNEVEN",
            f"--marker is given {count} times, --side-mm {len(given.sides_mm)} times, "
            f"--name {len(given.names)} times"
            + (" (two markers have the same name)" if len(set(names)) != len(names) else ""),
            "Give one --side-mm per --marker or one for all, and a different --name for each or none.",
            {"markers": count, "sides": len(given.sides_mm), "names": len(given.names)},
        )
    return list(zip(names, given.markers, sides, strict=True))


def _name_from_file(picture: Path) -> str:
    """Return a valid marker name from a file name."""
    stored = "".join(
        letter if letter.isascii() and (letter.isalnum() or letter in "_-") else "-"
        for letter in picture.stem
    )
    return stored.strip("-_")[:40] or "marker"

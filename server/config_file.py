"""Load `Config` from config.yaml, environment and command line, and report all errors at once."""

import difflib
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, TypeAlias

import yaml
from pydantic import ValidationError

from server.allowed_values import allowed_keys, allowed_text, key_text
from server.camera_file import read_camera_file, reject_other_camera
from server.capture.address import SourceKind, source_from_text
from server.config import Config
from server.errors import ConfigError
from server.marker_file import load_marker_image
from server.plugins import IMAGE_SOURCES, SINKS, SOURCE_PREFIX, plugin_names
from server.tool_file import tool_from_config, tool_mistakes
from server.yaml_file import BoundedLoader, parsed_yaml
from tracker.errors import NavigationError

DEFAULT_FILE = Path("config.yaml")
# COAXIAL__CAMERA__RATE_HZ is the key camera.rate_hz.
ENVIRONMENT_PREFIX, ENVIRONMENT_SEPARATOR = "COAXIAL__", "__"
Key: TypeAlias = tuple[str | int, ...]
# What became of keys of older releases; * stands for any name. None is ever removed.
#     "camera.speed_hz": "was renamed to 'camera.rate_hz' in 1.2.0"
#     "tools.*.tip": "was removed in 2.0.0: give 'calibration'"
FORMER_KEYS: Mapping[str, str] = {}


@dataclass(frozen=True, slots=True, kw_only=True)
class Override:
    """A setting from environment or command line, with its origin for messages."""

    value: object
    origin: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Mistake:
    """An invalid setting."""

    where: str
    key: str
    sentence: str
    context: dict[str, object] = field(default_factory=dict)


def load_config(
    path: Path | None = None,
    *,
    overrides: Mapping[tuple[str, ...], Override] | None = None,
    environment: Mapping[str, str] | None = None,
) -> Config:
    """Load the settings from `path`, else ./config.yaml if it exists, else the defaults.

    The environment (COAXIAL__CAMERA__RATE_HZ for `camera.rate_hz`, its value in YAML; COAXIAL_PORT) overrides
    the file, and `overrides` (the command line) overrides both.
    Paths in the file are relative to the file, paths in overrides to the working directory.

    Raises:
        ConfigError: CONFIG_INVALID with all errors, each with file, key, value and allowed values;
            CONFIG_FILE_UNREADABLE.
    """
    environment = os.environ if environment is None else environment
    file = path if path is not None else (DEFAULT_FILE if DEFAULT_FILE.is_file() else None)
    raw = {} if file is None else _mapping_from_file(file)
    changes = dict(_from_environment(environment))
    changes.update(overrides or {})
    mistakes: list[Mistake] = []
    origins: dict[Key, str] = {}
    for key, change in changes.items():
        _set(raw, key, change.value)
        origins[key] = change.origin
    where = _Where(file=file, origins=origins)
    try:
        config = Config.model_validate(raw)
    except ValidationError as error:
        mistakes.extend(_mistakes_from_validation(error, where))
        raise _config_error(mistakes, file) from None
    config = _with_absolute_paths(config, folder=Path() if file is None else file.parent, origins=origins)
    mistakes.extend(_mistakes_between_keys(config, where))
    mistakes.extend(_mistakes_in_files(config, where))
    if mistakes:
        raise _config_error(mistakes, file)
    return config


@dataclass(frozen=True, slots=True, kw_only=True)
class _Where:
    """Origin of the value of a key."""

    file: Path | None
    origins: Mapping[Key, str]

    def of(self, key: Key) -> str:
        for length in range(len(key), 0, -1):
            if key[:length] in self.origins:
                return self.origins[key[:length]]
        return "the built-in settings" if self.file is None else str(self.file)


class _StrictLoader(BoundedLoader):
    """Loader that rejects duplicate keys."""

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:  # noqa: ANN401  PyYAML's node types
        keys: list[object] = []
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if key in keys:
                line = key_node.start_mark.line + 1
                raise yaml.YAMLError(f"line {line}: duplicate key '{key}'")
            keys.append(key)
        mapping: dict[Any, Any] = super().construct_mapping(node, deep)
        return mapping


def _mapping_from_file(file: Path) -> dict[str, Any]:
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text"
        raise ConfigError(
            "CONFIG_FILE_UNREADABLE",
            f"the settings file {file} cannot be read: {reason}",
            "Give an existing YAML file with --config, or omit --config.",
            {"file": str(file)},
        ) from error
    try:
        raw = parsed_yaml(text, _StrictLoader)
    except ValueError as error:
        raise _yaml_error(file, error) from None
    if raw is None:
        return {}
    if not isinstance(raw, dict):
        raise _yaml_error(file, ValueError(f"it is a {type(raw).__name__}, expected keys with values"))
    # A section with only comments is empty.
    return {key: value for key, value in raw.items() if value is not None}


def _yaml_error(file: Path, error: ValueError) -> ConfigError:
    mark = getattr(error.__cause__, "problem_mark", None)
    reason = getattr(error.__cause__, "problem", None) or str(error)
    place = f"line {mark.line + 1}, column {mark.column + 1}: " if mark is not None else ""
    return ConfigError(
        "CONFIG_INVALID",
        f"{file} is not valid YAML: {place}{reason}",
        "Correct the line; write keys as 'key: value', indented by two spaces under their section.",
        {"file": str(file)},
    )


def _from_environment(environment: Mapping[str, str]) -> dict[tuple[str, ...], Override]:
    settings: dict[tuple[str, ...], Override] = {}
    port = environment.get("COAXIAL_PORT", "").strip()
    if port:
        value: object = int(port) if port.isdecimal() and port.isascii() else port
        settings[("server", "port")] = Override(value=value, origin="COAXIAL_PORT")
    # Sorted: a section comes before the keys in it.
    for name in sorted(environment):
        text = environment[name].strip()
        if name.startswith(ENVIRONMENT_PREFIX) and text:
            key = tuple(name.removeprefix(ENVIRONMENT_PREFIX).lower().split(ENVIRONMENT_SEPARATOR))
            settings[key] = Override(value=_yaml_value(name, text), origin=name)
    return settings


def _yaml_value(name: str, text: str) -> object:
    try:
        return parsed_yaml(text, _StrictLoader)
    except ValueError as error:
        raise ConfigError(
            "CONFIG_INVALID",
            f"{name} is not valid YAML: {getattr(error.__cause__, 'problem', None) or error}",
            "Write the value as in config.yaml, a list as [1, 2].",
            {"name": name},
        ) from None


def _set(raw: dict[str, Any], key: tuple[str, ...], value: object) -> None:
    """Set a value in nested mappings; an intermediate value that is no mapping is left to the validation."""
    inner: Any = raw
    for part in key[:-1]:
        if inner.get(part) is None:
            inner[part] = {}
        inner = inner[part]
        if not isinstance(inner, dict):
            return
    inner[key[-1]] = value


def _mistakes_from_validation(error: ValidationError, where: _Where) -> list[Mistake]:
    mistakes: dict[str, Mistake] = {}
    for detail in error.errors(include_url=False):
        location = detail["loc"]
        # A union reports an error for each member; one message with all allowed values suffices.
        key = tuple(part for part in location if not str(part).startswith(("constrained-", "[key]")))
        text = key_text(key)
        if text not in mistakes:
            mistakes[text] = _mistake(detail["type"], key, location, detail["input"], where)
    return list(mistakes.values())


def fate_of_key(key: str) -> str | None:
    """Return what became of a key of an older release; None if no release had it."""
    return next((fate for former, fate in FORMER_KEYS.items() if fnmatchcase(key, former)), None)


def _mistake(kind: str, key: Key, location: Key, given: object, where: _Where) -> Mistake:
    text = key_text(key)
    former = fate_of_key(text)
    if kind == "extra_forbidden" and former is not None:
        sentence = f"'{text}' {former}"
    elif kind in {"extra_forbidden", "invalid_key"} or location[-1] == "[key]":
        keys = allowed_keys(key[:-1])
        near = difflib.get_close_matches(str(key[-1]), keys, n=1, cutoff=0.5)
        meant = f", did you mean '{key_text((*key[:-1], near[0]))}'?" if near else ""
        allowed = ", ".join(keys) if keys else "letters, digits, - and _, at most 40, a letter or digit first"
        sentence = f"'{text}' is not a known key{f'{meant} Allowed' if meant else ', allowed'}: {allowed}"
        if location[-1] == "[key]":
            sentence = f"'{text}' has an invalid name, allowed: {allowed}"
    elif kind == "missing":
        sentence = f"'{text}' is missing, expected: {allowed_text(key)}"
    else:
        sentence = f"'{text}' is {given!r}, allowed: {allowed_text(key)}"
    return Mistake(where=where.of(key), key=text, sentence=sentence, context={"given": repr(given)})


def _with_absolute_paths(config: Config, *, folder: Path, origins: Mapping[Key, str]) -> Config:
    """Return the settings with absolute paths; those of the file are relative to its folder."""

    def resolved(path: Path, key: Key) -> Path:
        base = Path.cwd() if any(key[:n] in origins for n in range(1, len(key) + 1)) else folder
        return (base / path.expanduser()).resolve()

    camera = config.camera
    changes: dict[str, object] = {}
    if camera.calibration is not None:
        changes["calibration"] = resolved(camera.calibration, ("camera", "calibration"))
    source = source_from_text(camera.source)
    if source.kind is SourceKind.PATH:
        changes["source"] = str(resolved(Path(source.text), ("camera", "source")))
    markers = {
        name: marker.model_copy(update={"image": resolved(marker.image, ("markers", name, "image"))})
        for name, marker in config.markers.items()
    }
    tools = {
        name: tool
        if tool.calibration is None
        else tool.model_copy(
            update={"calibration": resolved(tool.calibration, ("tools", name, "calibration"))}
        )
        for name, tool in config.tools.items()
    }
    tls = config.server.tls
    files = {
        part: resolved(path, ("server", "tls", part))
        for part, path in (("certificate", tls.certificate), ("key", tls.key))
        if path is not None
    }
    server = config.server.model_copy(update={"tls": tls.model_copy(update=files)})
    archive, receive = config.dicom.archive, config.dicom.receive
    if archive.ca is not None:
        archive = archive.model_copy(update={"ca": resolved(archive.ca, ("dicom", "archive", "ca"))})
    if receive.client_ca is not None:
        file = resolved(receive.client_ca, ("dicom", "receive", "client_ca"))
        receive = receive.model_copy(update={"client_ca": file})
    hub = config.hub
    hub_files = {
        part: resolved(path, ("hub", "tls", part))
        for part in ("ca", "certificate", "key")
        if (path := getattr(hub.tls, part)) is not None
    }
    hub = hub.model_copy(update={"tls": hub.tls.model_copy(update=hub_files)})
    if hub.credentials is not None:
        hub = hub.model_copy(update={"credentials": resolved(hub.credentials, ("hub", "credentials"))})
    updated = {
        "hub": hub,
        "dicom": config.dicom.model_copy(update={"archive": archive, "receive": receive}),
        "server": server,
        "camera": camera.model_copy(update=changes),
        "markers": markers,
        "tools": tools,
    }
    return config.model_copy(update=updated)


def _mistakes_between_keys(config: Config, where: _Where) -> list[Mistake]:
    mistakes = []
    camera = config.camera
    if (camera.width is None) != (camera.height is None):
        lone, other = ("width", "height") if camera.height is None else ("height", "width")
        given = getattr(camera, lone)
        sentence = f"'camera.{lone}' is {given}, but 'camera.{other}' is missing, allowed: both or none"
        mistakes.append(Mistake(where=where.of(("camera", lone)), key=f"camera.{other}", sentence=sentence))
    source = source_from_text(camera.source)
    if camera.trigger is not None and source.kind is not SourceKind.INDUSTRIAL_CAMERA:
        sentence = (
            f"'camera.trigger' is '{camera.trigger}', but 'camera.source' is {source.name}, allowed: null, "
            "or an industrial camera as the source"
        )
        mistakes.append(
            Mistake(where=where.of(("camera", "trigger")), key="camera.trigger", sentence=sentence)
        )
    receive = config.dicom.receive
    if receive.port is not None and not receive.allowed_ae_titles:
        key = "dicom.receive.allowed_ae_titles"
        sentence = f"'{key}' is empty, but 'dicom.receive.port' is set, allowed: at least one AE title"
        mistakes.append(Mistake(where=where.of(("dicom", "receive")), key=key, sentence=sentence))
    if receive.client_ca is not None and not receive.tls:
        key = "dicom.receive.client_ca"
        sentence = f"'{key}' is given, but 'dicom.receive.tls' is false, allowed: with TLS only"
        mistakes.append(Mistake(where=where.of(("dicom", "receive")), key=key, sentence=sentence))
    known = set(config.markers)
    if source.kind is SourceKind.OPENIGTLINK:
        mistakes.extend(_mistakes_of_tracker(config, where))
        known = set() if config.external_tracker is None else set(config.external_tracker.transforms)
    if source_from_text(camera.source).kind is SourceKind.REHEARSAL:
        taken = [("markers", "drill"), ("tools", "drill")]
        taken += [("markers", "reference")] if config.rehearsal.reference else []
        known |= {name for _, name in taken}
        for section, name in taken:
            if name in getattr(config, section):
                sentence = f"'{section}.{name}' is taken by the rehearsal's own {name}, allowed: another name"
                mistakes.append(
                    Mistake(where=where.of((section, name)), key=f"{section}.{name}", sentence=sentence)
                )
    reference = config.reference.marker
    if reference is not None and reference not in known:
        allowed = ", ".join(sorted(known)) or "none, since there is no marker under 'markers'"
        sentence = f"'reference.marker' is '{reference}', allowed: {allowed}"
        mistakes.append(
            Mistake(where=where.of(("reference", "marker")), key="reference.marker", sentence=sentence)
        )
    for name, tool in config.tools.items():
        key = f"tools.{name}.marker"
        if tool.marker not in known:
            allowed = ", ".join(sorted(known)) or "none, since there is no marker under 'markers'"
            sentence = f"'{key}' is '{tool.marker}', allowed: {allowed}"
            mistakes.append(Mistake(where=where.of(("tools", name, "marker")), key=key, sentence=sentence))
        for lone, sentence in tool_mistakes(name, tool):
            key = f"tools.{name}.{lone}"
            mistakes.append(Mistake(where=where.of(("tools", name)), key=key, sentence=sentence))
    return [*mistakes, *_sizes_of_no_screw(config, where), *_missing_plugins(config, where)]


def _mistakes_of_tracker(config: Config, where: _Where) -> list[Mistake]:
    """Return what an external tracker lacks: its section, one frame of all transforms, and the reference."""
    tracker = config.external_tracker
    if tracker is None:
        sentence = "'external_tracker' is missing, but 'camera.source' is openigtlink, expected: its section"
        return [Mistake(where=where.of(("camera", "source")), key="external_tracker", sentence=sentence)]
    mistakes = []
    names = tracker.transforms
    # An inverse transform, as TrackerToDrill, has another frame than the others.
    frames = sorted({name[name.index("To", 1) + 2 :] for name in names})
    if len(frames) > 1 or len(set(names)) < len(names):
        key = "external_tracker.transforms"
        sentence = (
            f"'{key}' lead to the frames {', '.join(frames)}, allowed: different bodies, all to the one "
            "frame of the tracker, as DrillToTracker and ReferenceToTracker"
        )
        mistakes.append(
            Mistake(where=where.of(("external_tracker", "transforms")), key=key, sentence=sentence)
        )
    if config.reference.marker is None:
        # Nothing would notice that the tracker or the patient was moved.
        sentence = (
            "'reference.marker' is missing, but 'camera.source' is openigtlink, expected: the transform of "
            f"the body on the patient, one of {', '.join(names)}"
        )
        mistakes.append(
            Mistake(where=where.of(("reference", "marker")), key="reference.marker", sentence=sentence)
        )
    return mistakes


def _sizes_of_no_screw(config: Config, where: _Where) -> list[Mistake]:
    """Return a mistake for each product line with a size that the catalogue lacks."""
    mistakes = []
    for place, one in enumerate(config.plan.screw_ranges):
        for name, sizes in (("diameters_mm", one.diameters_mm), ("lengths_mm", one.lengths_mm)):
            offered = getattr(config.plan, f"screw_{name}")
            missing = ", ".join(f"{size:g}" for size in sizes if size not in offered)
            if missing:
                key = f"plan.screw_ranges[{place}].{name}"
                mistakes.append(
                    Mistake(
                        where=where.of(("plan", "screw_ranges")),
                        key=key,
                        sentence=f"'{key}' of {one.name!r} has {missing}, allowed: sizes of "
                        f"'plan.screw_{name}'",
                    )
                )
    return mistakes


def _missing_plugins(config: Config, where: _Where) -> list[Mistake]:
    """Return a mistake for each plug-in that is not installed. None is imported."""
    named: list[tuple[Key, str, str]] = [(("plugins", "sinks"), SINKS, name) for name in config.plugins.sinks]
    source = source_from_text(config.camera.source)
    if source.kind is SourceKind.PLUGIN:
        named.append((("camera", "source"), IMAGE_SOURCES, source.name.removeprefix(SOURCE_PREFIX)))
    mistakes = []
    for key, group, name in named:
        installed = plugin_names(group)
        if name not in installed:
            allowed = ", ".join(installed) or f"none, since no installed package has one in {group}"
            sentence = f"'{key_text(key)}' names the plug-in '{name}', allowed: {allowed}"
            mistakes.append(Mistake(where=where.of(key), key=key_text(key), sentence=sentence))
    return mistakes


def _mistakes_in_files(config: Config, where: _Where) -> list[Mistake]:
    """Return the errors of files that the settings refer to."""
    mistakes = []
    if config.camera.calibration is not None:
        try:
            file = read_camera_file(config.camera.calibration)
            camera = config.camera
            reject_other_camera(file, path=config.camera.calibration, name=camera.name, source=camera.source)
        except NavigationError as error:
            mistakes.append(_mistake_in_file(("camera", "calibration"), error, where))
    for name, marker in config.markers.items():
        try:
            load_marker_image(marker.image)
        except NavigationError as error:
            mistakes.append(_mistake_in_file(("markers", name, "image"), error, where))
    for name, tool in config.tools.items():
        if tool_mistakes(name, tool):
            continue
        try:
            tool_from_config(name, tool, config.markers.get(tool.marker))
        except NavigationError as error:
            mistakes.append(_mistake_in_file(("tools", name, "calibration"), error, where))
    return mistakes


def _mistake_in_file(key: Key, error: NavigationError, where: _Where) -> Mistake:
    text = key_text(key)
    sentence = f"'{text}': {error.message}. {error.remedy}"
    return Mistake(where=where.of(key), key=text, sentence=sentence, context=error.context)


def _config_error(mistakes: list[Mistake], file: Path | None) -> ConfigError:
    lines = [f"{mistake.where}: {mistake.sentence}" for mistake in mistakes]
    message = lines[0] if len(lines) == 1 else "\n  ".join([f"{len(lines)} settings are invalid:", *lines])
    return ConfigError(
        "CONFIG_INVALID",
        message.rstrip("."),
        "Correct it and start again; coaxial config prints every key with its default.",
        {
            "file": str(file) if file else "",
            "mistakes": [{"where": m.where, "key": m.key, "message": m.sentence} for m in mistakes],
        },
    )

"""Creation of the image source of the settings."""

import threading
from collections.abc import Sequence
from pathlib import Path

from server.capture.address import SourceAddress, SourceKind, source_from_text
from server.capture.folder import FolderSource
from server.capture.industrial import BaslerCameras, GenTLCameras, IndustrialCameraSource
from server.capture.local_camera import CalibratedCamera, LocalCameraSource
from server.capture.modes import WantedMode
from server.capture.openigtlink import OpenIgtLinkSource
from server.capture.pacer import Pacer
from server.capture.phone import Inbox, PhoneSource
from server.capture.plugin import PluginSource
from server.capture.recording import RecordingSource
from server.capture.rehearsal import CameraOutage, PlayedScene, RehearsalSource, Renderer
from server.capture.shot import Shot, Source
from server.capture.stream import StreamSource
from server.capture.video_file import VideoFileSource
from server.config import CameraConfig, Config
from server.errors import CaptureError
from server.live import CameraStatus
from server.recording_file.topics import SUFFIX as RECORDING_SUFFIX


def source_from_config(
    config: Config,
    *,
    stop: threading.Event,
    renderer: Renderer | None = None,
    first_number: int = 0,
    played_scene: PlayedScene | None = None,
    outages: Sequence[CameraOutage] = (),
    calibration: CalibratedCamera | None = None,
    inbox: Inbox | None = None,
) -> Source:
    """Return the source that `camera.source` names, not yet opened.

    Args:
        config: settings.
        stop: ends a wait for the next image.
        renderer: renderer of the rehearsal; needed for that source only.
        first_number: the number of its first image.
        played_scene: played scene of the rehearsal, and its first image.
        outages: times at which the rehearsal's camera gives no image.
        calibration: calibration in use, for a local or industrial camera; None without one.
        inbox: images of a phone; needed for that source only.

    Raises:
        CaptureError: REHEARSAL_WITHOUT_THEATRE, TRACKER_NOT_CONFIGURED, PHONE_WITHOUT_SERVER.
    """
    camera = config.camera
    address = source_from_text(camera.source)
    if address.kind is SourceKind.REHEARSAL:
        if renderer is None:
            raise CaptureError(
                "REHEARSAL_WITHOUT_THEATRE",
                "the rehearsal was requested, but its theatre was not built",
                "Restart the program; if the error persists, send the server log to the maintainer.",
            )
        return RehearsalSource(
            renderer,
            rate_hz=config.rehearsal.rate_hz,
            stop=stop,
            fast=camera.rate == "fast",
            first_number=first_number,
            played_scene=played_scene,
            outages=outages,
        )
    if address.kind is SourceKind.OPENIGTLINK:
        if config.external_tracker is None:
            raise CaptureError(
                "TRACKER_NOT_CONFIGURED",
                "the source is openigtlink, but the settings have no external_tracker",
                "Add the section external_tracker to the settings.",
            )
        return OpenIgtLinkSource(
            address, settings=config.external_tracker, stop=stop, first_number=first_number
        )
    if address.kind is SourceKind.PHONE:
        return _phone(inbox, stop, wanted_mode(camera), first_number)
    if address.kind is SourceKind.INDUSTRIAL_CAMERA:
        return _industrial_camera(camera, address, stop, calibration, first_number)
    if address.kind is SourceKind.LOCAL_CAMERA:
        return LocalCameraSource(
            address,
            wanted=wanted_mode(camera),
            calibration=calibration,
            lock_controls=camera.lock_controls,
            lock_light=camera.lock_light,
            first_number=first_number,
        )
    if address.kind is SourceKind.PLUGIN:
        return PluginSource(address, first_number=first_number)
    if address.kind is SourceKind.STREAM:
        return StreamSource(address, stop=stop, first_number=first_number)
    return PathSource(address, config=config, stop=stop, first_number=first_number)


def _industrial_camera(
    camera: CameraConfig,
    address: SourceAddress,
    stop: threading.Event,
    calibration: CalibratedCamera | None,
    first_number: int,
) -> IndustrialCameraSource:
    return IndustrialCameraSource(
        address,
        cameras=BaslerCameras() if address.text.startswith("basler:") else GenTLCameras(),
        stop=stop,
        wanted=wanted_mode(camera),
        calibration=calibration,
        trigger=camera.trigger,
        lock_controls=camera.lock_controls,
        first_number=first_number,
    )


def _phone(inbox: Inbox | None, stop: threading.Event, wanted: WantedMode, first_number: int) -> PhoneSource:
    if inbox is None:
        raise CaptureError(
            "PHONE_WITHOUT_SERVER",
            "the source 'phone' needs a running server",
            "Start it with coaxial run --source phone.",
        )
    return PhoneSource(inbox, stop=stop, wanted=wanted, first_number=first_number)


def wanted_mode(camera: CameraConfig) -> WantedMode:
    """Return the camera mode of the settings; a size only where both its numbers are given."""
    size = None if camera.width is None or camera.height is None else (camera.width, camera.height)
    return WantedMode(size_wh_px=size, rate_hz=camera.rate_hz)


class PathSource:
    """A video file, recording or folder; decided each time it is opened, because it may not exist yet."""

    def __init__(
        self, address: SourceAddress, *, config: Config, stop: threading.Event, first_number: int
    ) -> None:
        self.name = address.name
        self.waits_for_consumer = config.camera.rate == "fast"
        self.stalls = False
        self.camera: CameraStatus | None = None
        self._path = Path(address.text)
        self._camera = config.camera
        self._pacer = (
            None if self.waits_for_consumer else Pacer(stop=stop, speed=config.camera.playback_speed)
        )
        self._number = first_number
        self._source: VideoFileSource | FolderSource | RecordingSource | None = None
        self._defect: CaptureError | None = None

    @property
    def defect(self) -> CaptureError | None:
        """Problem of a source that still delivers images."""
        return self._defect if self._source is None else self._source.defect

    def open(self) -> None:
        """Open the file or folder."""
        self.close()
        if self._path.suffix.lower() == RECORDING_SUFFIX and not self._path.is_dir():
            recording = RecordingSource(
                self._path,
                loop=self._camera.loop,
                pacer=self._pacer,
                first_number=self._number,
            )
            recording.open()
            self._source = recording
            return
        kind = FolderSource if self._path.is_dir() else VideoFileSource
        source = kind(
            self._path,
            loop=self._camera.loop,
            pacer=self._pacer,
            rate_hz=self._camera.rate_hz,
            first_number=self._number,
        )
        source.open()
        self._source = source

    def read(self) -> Shot | None:
        """Return the next image."""
        shot = None if self._source is None else self._source.read()
        if shot is not None:
            self._number = shot.number + 1
        return shot

    def close(self) -> None:
        """Close what is open."""
        if self._source is not None:
            self._defect = self._source.defect
            self._source.close()
            self._source = None

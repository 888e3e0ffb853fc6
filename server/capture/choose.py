"""From the settings to the source of images."""

import threading
from collections.abc import Sequence
from pathlib import Path

from server.capture.address import SourceAddress, SourceKind, source_from_text
from server.capture.folder import FolderSource
from server.capture.industrial import BaslerCameras, GenTLCameras, IndustrialCameraSource
from server.capture.local_camera import CalibratedCamera, LocalCameraSource
from server.capture.modes import WantedMode
from server.capture.phone import Inbox, PhoneSource
from server.capture.rehearsal import Begun, RehearsalSource, Renderer, Silence
from server.capture.shot import Shot, Source
from server.capture.stream import StreamSource
from server.capture.video_file import VideoFileSource
from server.config import CameraConfig, Config
from server.errors import CaptureError
from server.live import CameraStatus


def source_from_config(
    config: Config,
    *,
    stop: threading.Event,
    renderer: Renderer | None = None,
    first_number: int = 0,
    begun: Begun | None = None,
    silences: Sequence[Silence] = (),
    calibration: CalibratedCamera | None = None,
    inbox: Inbox | None = None,
) -> Source:
    """The source that `camera.source` names, not yet opened.

    Args:
        config: the settings.
        stop: set when the source shall wait no longer for the next image to be due.
        renderer: of the rehearsal's theatre; needed for that source only.
        first_number: the number of its first image.
        begun: what of the rehearsal is played, and since when.
        silences: when the rehearsal's camera gives no image.
        calibration: that is in use, for a local or an industrial camera; None while there is none.
        inbox: where the images of a phone come in; needed for that source only.

    Raises:
        CaptureError: REHEARSAL_WITHOUT_THEATRE, PHONE_WITHOUT_SERVER.
    """
    camera = config.camera
    address = source_from_text(camera.source)
    if address.kind is SourceKind.REHEARSAL:
        if renderer is None:
            raise CaptureError(
                "REHEARSAL_WITHOUT_THEATRE",
                "the rehearsal was asked for, but no theatre was built for it",
                "Start the program anew; if it happens again, report it with the log.",
            )
        return RehearsalSource(
            renderer,
            rate_hz=config.rehearsal.rate_hz,
            stop=stop,
            fast=camera.rate == "fast",
            first_number=first_number,
            begun=begun,
            silences=silences,
        )
    if address.kind is SourceKind.PHONE:
        return _phone(inbox, stop, first_number)
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


def _phone(inbox: Inbox | None, stop: threading.Event, first_number: int) -> PhoneSource:
    if inbox is None:
        raise CaptureError(
            "PHONE_WITHOUT_SERVER",
            "a phone sends its images to a running server, and there is none here",
            "Start it with coaxial run --source phone.",
        )
    return PhoneSource(inbox, stop=stop, first_number=first_number)


def wanted_mode(camera: CameraConfig) -> WantedMode:
    """What the settings ask of a camera: a size where both its numbers are given."""
    size = None if camera.width is None or camera.height is None else (camera.width, camera.height)
    return WantedMode(size_wh_px=size, rate_hz=camera.rate_hz)


class PathSource:
    """A path: a video file or a folder, maybe not there yet, so decided each time it is opened."""

    def __init__(
        self, address: SourceAddress, *, config: Config, stop: threading.Event, first_number: int
    ) -> None:
        self.name = address.name
        self.waits_for_taker = config.camera.rate == "fast"
        self.stalls = False
        self.camera: CameraStatus | None = None
        self._path = Path(address.text)
        self._camera = config.camera
        self._stop = stop
        self._number = first_number
        self._source: VideoFileSource | FolderSource | None = None
        self._defect: CaptureError | None = None

    @property
    def defect(self) -> CaptureError | None:
        """What is wrong with it although it gives images."""
        return self._defect if self._source is None else self._source.defect

    def open(self) -> None:
        """Open it as what it is now."""
        self.close()
        kind = FolderSource if self._path.is_dir() else VideoFileSource
        source = kind(
            self._path,
            loop=self._camera.loop,
            fast=self.waits_for_taker,
            stop=self._stop,
            rate_hz=self._camera.rate_hz,
            first_number=self._number,
        )
        source.open()
        self._source = source

    def read(self) -> Shot | None:
        """The next image."""
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

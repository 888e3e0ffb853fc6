"""The accuracy test step: guided captures on a plate with divots, and the certificate that they support."""

from dataclasses import dataclass, replace
from pathlib import Path

from server.camera_file import CameraFile, read_camera_file
from server.certificate import (
    Certificate,
    CertifiedAudit,
    ExaminedSystem,
    InstalledCertificates,
    Issue,
    PlateFile,
    examine,
)
from server.clock import Clock, utc_now
from server.errors import CaptureError, SetupOrderError
from server.installation import product_version
from server.live import LiveHub, SourceStatus
from server.procedure.accuracy_collection import AccuracyCollection
from server.procedure.camera import MAIN_CAMERA, camera_from_document
from server.procedure.collecting_step import CollectingStep
from server.procedure.divot_capture import tool_in_use
from server.procedure.images_in_use import no_camera_in_use
from server.procedure.markers import MarkerStep
from server.store import CaseStore, DocumentKind
from server.store.latency_file import LatencyFile
from tracker.accuracy import TrackedTool, plate_problems
from tracker.camera import CameraModel
from tracker.navigation import NavigationSnapshot


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuredPlate:
    """A plate with the lengths of its rulers.

    Attributes:
        file: the plate as it is stated.
        rulers_mm: measured lengths along x and y; None for a plate without rulers.
        ruler_sd_mm: standard deviation of these lengths.
    """

    file: PlateFile
    rulers_mm: tuple[float, float] | None
    ruler_sd_mm: float


class CalibratedCameraFinder:
    """Finds the identity of the camera in use, as in its camera file.

    Args:
        store: the calibration of the open case has precedence.
        source: name of the image source.
        calibration: camera file of the settings.
    """

    def __init__(self, store: CaseStore, *, source: str, calibration: Path | None) -> None:
        self._store = store
        self.source = source
        self._calibration = calibration

    def find(self, model: CameraModel, *, device: str) -> CameraFile:
        """Return the file of the camera with this model, as the tracking process uses it.

        Raises:
            NavigationError: the calibration of the case or the camera file cannot be read.
        """
        case = self._store.get_open_case()
        document = (
            None if case is None else self._store.find_current(case.id, DocumentKind.CAMERA, MAIN_CAMERA)
        )
        if document is not None:
            file = camera_from_document(document, source=self.source)
        elif self._calibration is not None:
            file = read_camera_file(self._calibration)
        else:
            file = CameraFile(model=model, camera_source=self.source)
        # The model is scaled to the size of the images.
        return replace(file, model=model, device=device or file.device)


class AccuracyStep(CollectingStep[AccuracyCollection]):
    """Tests the accuracy of a tool on a plate, one test at a time. Thread-safe.

    Args:
        hub: the live images.
        store: the case store.
        installed: where certificates are installed.
        markers: the tracked markers, with their sides.
        latencies: measured latencies by camera source, for the certificate.
        cameras: finds the identity of the camera.
        clock: wall clock, in UTC.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        store: CaseStore,
        installed: InstalledCertificates,
        markers: MarkerStep,
        latencies: LatencyFile,
        cameras: CalibratedCameraFinder,
        clock: Clock = utc_now,
    ) -> None:
        super().__init__("accuracy test is", remedy="Begin an accuracy test with a tool and a plate.")
        self._hub = hub
        self._store = store
        self._installed = installed
        self._markers = markers
        self._latencies = latencies
        self._cameras = cameras
        self._clock = clock

    def begin(self, tool: str, plate: MeasuredPlate) -> AccuracyCollection:
        """Begin a test of this tool with the camera and tool of the newest image; discard a previous one.

        Raises:
            InvalidInput: PLATE_INVALID, PLATE_RULERS_INVALID, TOOL_UNKNOWN, CERTIFICATE_NOT_APPLICABLE.
            CalibrationError: ACCURACY_PLATE_UNMEASURED or ACCURACY_PLATE_SCALE.
            CaptureError: NO_PICTURE.
            SetupOrderError: NO_CAMERA_IN_USE.
        """
        plate.file.plate()
        scale = plate.file.scale(plate.rulers_mm, sd_mm=plate.ruler_sd_mm)
        problems = plate_problems(scale)
        if problems:
            raise problems[0]
        snapshot, source = self._newest_image()
        used, camera = tool_in_use(snapshot, tool), snapshot.setup.camera
        marker = self._markers.one(used.marker).model
        if marker is None:
            raise no_camera_in_use()
        system = ExaminedSystem(
            camera=self._cameras.find(camera, device=source.device),
            marker=used.marker,
            tool=TrackedTool(
                camera=camera,
                side_mm=marker.side_mm,
                tip_in_marker_mm=used.marker_from_tool.translation_mm,
                tip_covariance_mm2=used.tip_covariance_mm2,
            ),
            plate=plate.file,
            scale=scale,
        )
        return self._start(lambda: AccuracyCollection(self._hub, tool=tool, system=system))

    def conclude(self, *, made_by: str, valid_days: int, audit: CertifiedAudit | None) -> Certificate:
        """Issue, sign and install the certificate of a complete test without problems, and end the test.

        A refused test stays, so that its problems can be read.

        Raises:
            SetupOrderError: COLLECTION_MISSING or ACCURACY_TEST_INCOMPLETE.
            CalibrationError: the first problem of the test, or ACCURACY_SYSTEM_CHANGED.
            InvalidInput: the captures cannot be assessed, or CERTIFICATE_PERIOD_INVALID.
            CaptureError: NO_PICTURE.
            StoreError: the certificate cannot be stored.
        """
        collection = self.collection
        status = collection.status
        if status.due is not None:
            raise SetupOrderError(
                "ACCURACY_TEST_INCOMPLETE",
                f"{len(status.captures)} of {len(status.planned)} captures of the accuracy test are taken",
                "Take the captures that are missing.",
                {"captures": len(status.captures), "planned": len(status.planned)},
            )
        collection.tool_of(*self._newest_image())
        issue = Issue(
            at=self._clock(),
            valid_days=valid_days,
            by=made_by[:80],
            software_version=product_version(),
            audit=audit,
            latency=self._latencies.of(self._cameras.source),
        )
        found = examine(status.captures, status.system, issue)
        if found.certificate is None:
            raise found.assessment.problems[0]
        self._installed.install(self._installed.key.signed_json(found.certificate.json_values()))
        self.end()
        return found.certificate

    def _newest_image(self) -> tuple[NavigationSnapshot, SourceStatus]:
        newest = self._hub.newest
        if newest is None or newest.snapshot is None:
            raise CaptureError(
                "NO_PICTURE",
                "there is no image for the measurement",
                "Wait until the video runs, and try again.",
            )
        return newest.snapshot, newest.source

"""The rolling-shutter readout time of the camera: measured or entered, stored with its calibration."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from server.camera_file import readout_in
from server.errors import SetupOrderError
from server.jobs import Job, Jobs
from server.live import LiveHub
from server.planning.camera import fit_readout
from server.procedure.camera import MAIN_CAMERA, READOUT_KEYS, camera_from_document
from server.procedure.collecting_step import CollectingStep
from server.procedure.images_in_use import reject_without_images
from server.procedure.open_case import require_open_case
from server.procedure.readout_collection import BurstStage, ReadoutCollection
from server.store import Case, CaseStore, Document, DocumentKind
from tracker.camera import Board, CameraModel
from tracker.errors import CalibrationError


class ReadoutSource(StrEnum):
    """Source of a readout time."""

    MEASURED = "measured"  # with a moving board
    STATED = "stated"  # entered by a person, from the data sheet


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadoutRecord:
    """A stored readout time.

    Attributes:
        readout_ms: readout time for tracking; 0 for a global shutter.
        sd_ms: standard deviation of the measurement; None if it was entered.
        found_by: its source.
    """

    readout_ms: float
    sd_ms: float | None
    found_by: ReadoutSource


class ReadoutStep(CollectingStep[ReadoutCollection]):
    """Measures or stores the readout time; one burst at a time. Thread-safe.

    It is stored as a new version of the calibration. Documents that depend on the previous version become
    out of date, because poses of moving objects change with the readout time.

    Args:
        hub: the live images.
        store: where the result is stored.
        jobs: runs the computation.
        source: name of the camera source, as in its calibration.
    """

    def __init__(self, *, hub: LiveHub, store: CaseStore, jobs: Jobs, source: str) -> None:
        super().__init__("readout measurement is", remedy="Start a measurement of the readout time.")
        self._hub = hub
        self._store = store
        self._jobs = jobs
        self._source = source

    def begin(self, board: Board) -> ReadoutCollection:
        """Wait for this board to move, and take a burst; a previous burst is discarded.

        Raises:
            SetupOrderError: NO_CASE_OPEN, NO_CAMERA_IN_USE.
            OutOfDateError: DOCUMENT_MISSING or DOCUMENT_OUT_OF_DATE, the camera has to be calibrated first.
        """
        reject_without_images(self._hub)
        self._calibration(require_open_case(self._store))
        return self._start(lambda: ReadoutCollection(self._hub, board))

    def stored_readout(self) -> ReadoutRecord | None:
        """Return the readout time of the newest calibration of the open case; None if it is unknown."""
        case = self._store.get_open_case()
        document = None if case is None else self._store.latest(case.id, DocumentKind.CAMERA, MAIN_CAMERA)
        camera = {} if document is None else _camera_in(document)
        readout_ms = readout_in(camera)
        if readout_ms is None:
            return None
        sd_ms = camera.get("readout_sd_ms")
        return ReadoutRecord(
            readout_ms=readout_ms,
            sd_ms=float(sd_ms) if isinstance(sd_ms, int | float) else None,
            found_by=ReadoutSource(str(camera.get("readout_found_by", ReadoutSource.STATED))),
        )

    def measure(self, *, made_by: str) -> Job:
        """Estimate the readout time from the burst, and store it with the calibration.

        Raises:
            SetupOrderError: NO_CASE_OPEN, COLLECTION_MISSING, COLLECTION_UNREADY.
            OutOfDateError: DOCUMENT_MISSING or DOCUMENT_OUT_OF_DATE.
            CalibrationError: CAMERA_DIFFERS; CAMERA_SIZE_MISMATCH, the image size differs from that of the
                calibration, and so does the readout time.
        """
        case = require_open_case(self._store)
        collection = self.collection
        status, views = collection.status, collection.views
        if status.stage is not BurstStage.READY:
            raise SetupOrderError(
                "COLLECTION_UNREADY",
                f"{status.read_images} images of the burst have been processed so far",
                "Move the board until all images are taken and processed.",
                {"images": status.read_images},
            )
        camera = camera_from_document(self._calibration(case), source=self._source).model
        _reject_other_size(collection.size_wh_px, camera)

        def keep(values: Any) -> object:  # noqa: ANN401  what JSON made of the answer of `fit_readout`
            self._keep(
                case, _values(values["used_ms"], values["sd_ms"], ReadoutSource.MEASURED), made_by=made_by
            )
            self.end()
            return values

        return self._jobs.start(
            "measuring the readout", fit_readout, {"views": views, "camera": camera}, conclude=keep
        )

    def state(self, readout_ms: float | None, *, made_by: str) -> Document:
        """Store a readout time from the data sheet; 0 for a global shutter, None for unknown.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
            OutOfDateError: DOCUMENT_MISSING or DOCUMENT_OUT_OF_DATE.
        """
        values = {} if readout_ms is None else _values(readout_ms, None, ReadoutSource.STATED)
        return self._keep(require_open_case(self._store), values, made_by=made_by)

    def _calibration(self, case: Case) -> Document:
        return self._store.current(case.id, DocumentKind.CAMERA, MAIN_CAMERA)

    def _keep(self, case: Case, values: Mapping[str, object], *, made_by: str) -> Document:
        before = self._calibration(case)
        camera = {key: value for key, value in _camera_in(before).items() if key not in READOUT_KEYS}
        return self._store.put(
            case.id,
            DocumentKind.CAMERA,
            MAIN_CAMERA,
            {**before.content, "camera": {**camera, **values}},
            made_by=made_by,
            files=list(before.files),
            expected_version=before.version,
        )


def _reject_other_size(size_wh_px: tuple[int, int], camera: CameraModel) -> None:
    if size_wh_px == camera.size_wh_px:
        return
    (width, height), (width_before, height_before) = size_wh_px, camera.size_wh_px
    raise CalibrationError(
        "CAMERA_SIZE_MISMATCH",
        f"images of the board are {width}x{height} px, but the camera was calibrated at "
        f"{width_before}x{height_before} px, and the readout time is stored for that size",
        f"Set the camera to {width_before}x{height_before} px and measure again, or calibrate it at "
        f"{width}x{height} px.",
        {"image_size_wh_px": [width, height], "calibrated_size_wh_px": [width_before, height_before]},
    )


def _values(readout_ms: float, sd_ms: float | None, found_by: ReadoutSource) -> dict[str, object]:
    values: dict[str, object] = {"readout_ms": round(readout_ms, 2), "readout_found_by": found_by.value}
    return values if sd_ms is None else {**values, "readout_sd_ms": round(sd_ms, 2)}


def _camera_in(document: Document) -> Mapping[str, object]:
    camera = document.content.get("camera")
    return camera if isinstance(camera, Mapping) else {}

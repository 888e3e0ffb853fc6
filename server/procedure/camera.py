"""The camera calibration step: views are collected, the camera is fitted, the result is stored."""

from collections.abc import Mapping, Sequence
from typing import Any

from server.calibration import accuracy_values
from server.camera_file import CameraFile, controls_in, controls_values, readout_in
from server.config import CalibrationConfig
from server.errors import CaptureError, SetupOrderError
from server.jobs import Job, Jobs
from server.live import LiveHub
from server.planning.camera import calibrate_views
from server.procedure.board_collection import BoardCollection
from server.procedure.collecting_step import CollectingStep
from server.procedure.images_in_use import reject_without_images
from server.procedure.open_case import require_open_case
from server.setup import camera_for_size
from server.store import Case, CaseStore, Document, DocumentKind, Validity
from tracker.camera import Board, CameraControl, CameraModel
from tracker.camera.accuracy import accuracy_of_grid
from tracker.camera.detection import BoardNotFound, find_board
from tracker.errors import CalibrationError, InvalidInput

# Name of the camera's document; so far there is one camera.
MAIN_CAMERA = "main"
ACCURACY = "accuracy of the camera"
READOUT_KEYS = ("readout_ms", "readout_sd_ms", "readout_found_by")


class CameraStep(CollectingStep[BoardCollection]):
    """Calibrates the camera from live views; one collection at a time. Thread-safe.

    Args:
        hub: the live images.
        store: where the result is stored.
        jobs: runs the computation.
        gate: acceptance limits of calibration and accuracy check.
        source: name of the camera source, stored with the result.
        same_sensor_area: whether images of all sizes show the same area of the sensor.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        store: CaseStore,
        jobs: Jobs,
        gate: CalibrationConfig,
        source: str,
        same_sensor_area: bool = False,
    ) -> None:
        super().__init__(
            "collection of board views is",
            remedy="Start a collection for a calibration board.",
        )
        self._hub = hub
        self._store = store
        self._jobs = jobs
        self._gate = gate
        self._source = source
        self._same_sensor_area = same_sensor_area

    def begin(self, board: Board) -> BoardCollection:
        """Start to collect views of this board; a previous collection is discarded.

        Raises:
            SetupOrderError: NO_CAMERA_IN_USE.
        """
        reject_without_images(self._hub)
        return self._start(lambda: BoardCollection(self._hub, board))

    def calibrate(self, *, made_by: str) -> Job:
        """Fit the camera to the collected views; if it is accepted, store it and end the collection.

        Raises:
            SetupOrderError: NO_CASE_OPEN, COLLECTION_MISSING, COLLECTION_EMPTY.
        """
        case = require_open_case(self._store)
        collection = self.collection
        taken, status = collection.taken, collection.status
        controls, device = collection.controls, collection.device
        if not taken:
            raise SetupOrderError(
                "COLLECTION_EMPTY",
                "no view of the board has been taken yet",
                "Show the board to the camera until views are taken: at least 3, better 12 or more.",
            )

        def keep(values: Any) -> object:  # noqa: ANN401  what JSON made of the answer of `calibrate_views`
            document = self._keep(
                case, values["report"], values["plots"], made_by, controls=controls, device=device
            )
            # Nobody needs further views, and detecting the board in each image takes much of a processor.
            # Ended here, because the page that started the job may have been left or loaded again meanwhile.
            self._end(collection)
            return {"document_id": document.id, "version": document.version, **values["report"]}

        return self._jobs.start(
            "calibrating the camera",
            calibrate_views,
            {
                "views": tuple(one.view for one in taken),
                "names": tuple(one.name for one in taken),
                "size_wh_px": status.size_wh_px,
                "board": status.board,
            },
            conclude=keep,
        )

    def check_accuracy(self, board: Board, *, made_by: str) -> Document:
        """Measure known displacements on a board in the newest image, and store the result.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
            OutOfDateError: DOCUMENT_MISSING or DOCUMENT_OUT_OF_DATE, the camera has to be calibrated first.
            CaptureError: NO_PICTURE.
            InvalidInput: BOARD_NOT_FOUND, or as `accuracy_of_grid`.
            CalibrationError: ACCURACY_PLANE_UNKNOWN, CAMERA_SIZE_MISMATCH.
        """
        case = require_open_case(self._store)
        document = self._store.current(case.id, DocumentKind.CAMERA, MAIN_CAMERA)
        calibrated = camera_from_document(document, source=self._source).model
        newest = self._hub.newest
        if newest is None or newest.image is None:
            raise CaptureError(
                "NO_PICTURE",
                "there is no image for the measurement",
                "Wait until the video shows the board, and try again.",
            )
        height, width = newest.image.shape[:2]
        camera = camera_for_size(calibrated, (width, height), same_sensor_area=self._same_sensor_area)
        seen = find_board(newest.image, board)
        if isinstance(seen, BoardNotFound):
            raise InvalidInput(
                "BOARD_NOT_FOUND",
                f"the board was not found in the image: {seen.sentence}",
                "Hold the whole board still and in focus, and try again.",
                {"reason": seen.reason.value, "board_problem": seen.sentence},
            )
        report = accuracy_of_grid(camera, seen.object_points_mm[:, :2], seen.image_points_px)
        return self._store.put(
            case.id,
            DocumentKind.CHECK,
            ACCURACY,
            accuracy_values(report, limit_mm=self._gate.max_error_mm),
            made_by=made_by,
            depends_on=[document.id],
        )

    def calibration(self) -> Document:
        """Return the calibration of the open case.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
            OutOfDateError: DOCUMENT_MISSING or DOCUMENT_OUT_OF_DATE.
        """
        return self._store.current(require_open_case(self._store).id, DocumentKind.CAMERA, MAIN_CAMERA)

    def newest(self, kind: DocumentKind, name: str) -> tuple[Document, Validity] | None:
        """Return a document of the open case with its validity; None if there is none."""
        case = self._store.get_open_case()
        document = None if case is None else self._store.latest(case.id, kind, name)
        return None if document is None else (document, self._store.validity(document))

    def _keep(
        self,
        case: Case,
        report: Mapping[str, Any],
        plots: Mapping[str, str],
        made_by: str,
        *,
        controls: Mapping[CameraControl, int],
        device: str,
    ) -> Document:
        """Store an accepted calibration with its plots.

        Raises:
            CalibrationError: CALIBRATION_ABOVE_GATE.
            InvalidInput: CAMERA_MODEL_INVALID, the model that fits the views is not a possible lens.
        """
        rms_px = float(report["rms_px"])
        if not rms_px <= self._gate.max_rms_px:
            raise CalibrationError(
                "CALIBRATION_ABOVE_GATE",
                f"the reprojection error is {rms_px} px RMS, limit {self._gate.max_rms_px:g} px; the "
                "calibration was not stored",
                "Take sharp views of a flat, stiff board, or check the report for views that do not fit.",
                {"rms_px": rms_px, "max_rms_px": self._gate.max_rms_px},
            )
        CameraModel.from_mapping(report)
        files = {}
        for name, picture in plots.items():
            with self._store.new_file(case.id, ".svg") as new:
                new.path.write_text(picture, encoding="utf-8")
            files[name] = new.stored.id
        camera = {key: report[key] for key in ("matrix", "distortion", "size_wh_px")}
        if controls:
            camera["controls"] = controls_values(controls)
        if device:
            camera["device"] = device
        camera.update(self._readout_so_far(case, report["size_wh_px"]))
        return self._store.put(
            case.id,
            DocumentKind.CAMERA,
            MAIN_CAMERA,
            {"camera": {**camera, "source": self._source}, "report": dict(report), "plots": files},
            made_by=made_by,
            files=list(files.values()),
        )

    def _readout_so_far(self, case: Case, size_wh_px: Sequence[int]) -> dict[str, object]:
        """Return the readout time of the previous calibration: it depends on the mode, not on the lens."""
        before = self._store.latest(case.id, DocumentKind.CAMERA, MAIN_CAMERA)
        camera = None if before is None else before.content.get("camera")
        if not isinstance(camera, Mapping) or camera.get("source") != self._source:
            return {}
        if list(camera.get("size_wh_px", ())) != list(size_wh_px):
            return {}
        return {key: camera[key] for key in READOUT_KEYS if key in camera}


def camera_from_document(document: Document, *, source: str) -> CameraFile:
    """Parse the camera in a case document, with its controls at the calibration if they were stored.

    Raises:
        CalibrationError: CAMERA_DIFFERS, it was calibrated from another source than this one.
        InvalidInput: CAMERA_FILE_INCOMPLETE, CAMERA_FILE_INVALID or CAMERA_MODEL_INVALID.
    """
    camera = document.content.get("camera")
    values = camera if isinstance(camera, Mapping) else {}
    made_for = values.get("source")
    if made_for != source:
        raise CalibrationError(
            "CAMERA_DIFFERS",
            f"{document.title} was calibrated for '{made_for}', but images come from '{source}'",
            "Calibrate this camera, or start with the calibrated one.",
            {"calibrated": made_for, "source": source, "title": document.title_text},
        )
    report = document.content.get("report")
    return CameraFile(
        model=CameraModel.from_mapping(values),
        report=report if isinstance(report, Mapping) else {},
        camera_source=source,
        controls=controls_in(values),
        device=str(values.get("device", "")),
        readout_ms=readout_in(values),
    )

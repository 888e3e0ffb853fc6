"""The step in which the camera is calibrated: views collected, the camera fitted, the result kept."""

import threading
from collections.abc import Mapping

from server.calibration_report import report_values, view_values
from server.errors import SetupOrderError
from server.jobs import Job, Jobs, Report
from server.live import LiveHub
from server.procedure.board_collection import BoardCollection, TakenView
from server.procedure.opened import opened_case
from server.store import CaseStore, Document, DocumentKind
from tracker.camera import Board, CameraModel
from tracker.camera.calibration import calibrate
from tracker.errors import CalibrationError

# There is one camera yet; its document has the name that it has in addresses.
MAIN_CAMERA = "main"


class CameraStep:
    """Calibrates the camera from live views; one collection at a time. Safe to use from any thread.

    Args:
        hub: the live images.
        store: where the result is kept.
        jobs: where it is computed.
        most_rms_px: the gate.
        source: the camera's source in words, kept with the result.
    """

    def __init__(
        self, *, hub: LiveHub, store: CaseStore, jobs: Jobs, most_rms_px: float, source: str
    ) -> None:
        self._hub = hub
        self._store = store
        self._jobs = jobs
        self._most_rms_px = most_rms_px
        self._source = source
        self._lock = threading.Lock()
        self._collection: BoardCollection | None = None

    def begin(self, board: Board) -> BoardCollection:
        """Collect views of this board; a collection that was there is thrown away."""
        with self._lock:
            if self._collection is not None:
                self._collection.stop()
            self._collection = BoardCollection(self._hub, board)
            return self._collection

    @property
    def collection(self) -> BoardCollection:
        """The views so far.

        Raises:
            SetupOrderError: COLLECTION_MISSING.
        """
        with self._lock:
            if self._collection is None:
                raise SetupOrderError(
                    "COLLECTION_MISSING",
                    "no views of a calibration board are being collected",
                    "Start with POST /api/camera/collection, which says what board it is.",
                )
            return self._collection

    def end(self) -> None:
        """Collect no more, and throw away what was collected."""
        with self._lock:
            if self._collection is not None:
                self._collection.stop()
            self._collection = None

    def calibrate(self, *, made_by: str) -> Job:
        """Fit the camera to the collected views, and keep it in the open case if it passes the gate.

        Raises:
            SetupOrderError: NO_CASE_OPEN, COLLECTION_MISSING, COLLECTION_EMPTY.
        """
        case = opened_case(self._store)
        collection = self.collection
        taken, status = collection.taken, collection.status
        if not taken:
            raise SetupOrderError(
                "COLLECTION_EMPTY",
                "no view of the board has been taken yet",
                "Hold the board before the camera until views are taken: at least 3, better 12 or more.",
            )

        def keep(values: object) -> object:
            if not isinstance(values, Mapping):
                raise TypeError(f"a calibration gave {type(values).__name__}")
            self._refuse_above_gate(values)
            camera = {key: values[key] for key in ("matrix", "distortion", "size_wh_px")}
            document = self._store.put(
                case.id,
                DocumentKind.CAMERA,
                MAIN_CAMERA,
                {"camera": {**camera, "source": self._source}, "report": dict(values)},
                made_by=made_by,
            )
            return {"document_id": document.id, "version": document.version, **values}

        return self._jobs.start(
            "calibrating the camera",
            calibrate_views,
            {"taken": taken, "size_wh_px": status.size_wh_px},
            conclude=keep,
        )

    def _refuse_above_gate(self, values: Mapping[str, object]) -> None:
        rms_px = values["rms_px"]
        if not (isinstance(rms_px, float) and rms_px <= self._most_rms_px):
            raise CalibrationError(
                "CALIBRATION_ABOVE_GATE",
                f"points lie off by {rms_px} px RMS, allowed {self._most_rms_px:g} px; nothing was kept",
                "Take sharp views of a flat, stiff board, or look at the report for views that do not fit.",
                {"rms_px": rms_px, "most_rms_px": self._most_rms_px},
            )


def calibrate_views(
    report: Report, *, taken: tuple[TakenView, ...], size_wh_px: tuple[int, int]
) -> dict[str, object]:
    """The work itself, in a process of its own: the camera's values with its report."""
    report(0.1, f"fitting the camera to {len(taken)} views")
    found = calibrate([one.view for one in taken], size_wh_px=size_wh_px, names=[one.name for one in taken])
    return {**report_values(found), "views": [view_values(view) for view in found.views]}


def kept_camera(document: Document, *, source: str) -> CameraModel:
    """The camera in a document of a case.

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
            f"{document.title} was calibrated for '{made_for}', and images come from '{source}'",
            "Calibrate this camera, or start with the one that was calibrated.",
            {"calibrated": made_for, "source": source},
        )
    return CameraModel.from_mapping(values)

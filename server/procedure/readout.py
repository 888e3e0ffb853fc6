"""The readout time of the camera's rows: measured or stated, and kept with its calibration."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from enum import StrEnum
from typing import Any

from server.camera_file import readout_in
from server.errors import SetupOrderError
from server.jobs import Job, Jobs, Report
from server.live import LiveHub
from server.procedure.camera import MAIN_CAMERA, READOUT_KEYS, kept_camera
from server.procedure.held import Held
from server.procedure.opened import opened_case
from server.procedure.readout_collection import BurstStage, ReadoutCollection
from server.store import Case, CaseStore, Document, DocumentKind
from tracker.camera import Board, CameraModel
from tracker.camera.readout import TimedView, estimate_readout


class FoundBy(StrEnum):
    """Where a readout time comes from."""

    MEASURED = "measured"  # with a moving board
    STATED = "stated"  # by a person, out of the data sheet


@dataclass(frozen=True, slots=True, kw_only=True)
class KeptReadout:
    """A readout time as it is kept.

    Attributes:
        readout_ms: what is tracked with; 0 of a global shutter.
        sd_ms: of the measurement; None where it was stated.
        found_by: where it comes from.
    """

    readout_ms: float
    sd_ms: float | None
    found_by: FoundBy


class ReadoutStep:
    """Measures or takes the readout time; one burst at a time. Safe to use from any thread.

    It is kept as a new version of the calibration: what stands on the one before is out of date, because
    poses of what moves change with it.

    Args:
        hub: the live images.
        store: where the result is kept.
        jobs: where it is computed.
        source: the camera's source in words, as its calibration names it.
    """

    def __init__(self, *, hub: LiveHub, store: CaseStore, jobs: Jobs, source: str) -> None:
        self._hub = hub
        self._store = store
        self._jobs = jobs
        self._source = source
        self._held: Held[ReadoutCollection] = Held(
            "images of a moving board are", remedy="Begin a measurement of the readout."
        )

    def begin(self, board: Board) -> ReadoutCollection:
        """Wait for this board to move, and take a burst; what was taken before is thrown away.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
            OutOfDateError: DOCUMENT_MISSING or DOCUMENT_OUT_OF_DATE, the camera has to be calibrated first.
        """
        self._calibration(opened_case(self._store))
        return self._held.begin(lambda: ReadoutCollection(self._hub, board))

    @property
    def collection(self) -> ReadoutCollection:
        """The burst so far.

        Raises:
            SetupOrderError: COLLECTION_MISSING.
        """
        return self._held.get()

    @property
    def is_collecting(self) -> bool:
        """Whether a burst is held."""
        return self._held.is_there

    def end(self) -> None:
        """Take no more, and throw away what was taken."""
        self._held.end()

    def kept(self) -> KeptReadout | None:
        """What the newest calibration of the open case has; None where it is not known."""
        case = self._store.opened()
        document = None if case is None else self._store.latest(case.id, DocumentKind.CAMERA, MAIN_CAMERA)
        camera = {} if document is None else _camera_in(document)
        readout_ms = readout_in(camera)
        if readout_ms is None:
            return None
        sd_ms = camera.get("readout_sd_ms")
        return KeptReadout(
            readout_ms=readout_ms,
            sd_ms=float(sd_ms) if isinstance(sd_ms, int | float) else None,
            found_by=FoundBy(str(camera.get("readout_found_by", FoundBy.STATED))),
        )

    def measure(self, *, made_by: str) -> Job:
        """Fit the readout to the burst, and keep it with the calibration.

        Raises:
            SetupOrderError: NO_CASE_OPEN, COLLECTION_MISSING, COLLECTION_UNREADY.
            OutOfDateError: DOCUMENT_MISSING or DOCUMENT_OUT_OF_DATE.
            CalibrationError: CAMERA_DIFFERS.
        """
        case = opened_case(self._store)
        collection = self.collection
        status, views = collection.status, collection.views
        if status.stage is not BurstStage.READY:
            raise SetupOrderError(
                "COLLECTION_UNREADY",
                f"{status.read_images} of the burst's images are read yet",
                "Move the board until all images are taken and read.",
            )
        camera = kept_camera(self._calibration(case), source=self._source).model

        def keep(values: Any) -> object:  # noqa: ANN401  what JSON made of the answer of `fit_readout`
            self._keep(case, _values(values["used_ms"], values["sd_ms"], FoundBy.MEASURED), made_by=made_by)
            self.end()
            return values

        return self._jobs.start(
            "measuring the readout", fit_readout, {"views": views, "camera": camera}, conclude=keep
        )

    def state(self, readout_ms: float | None, *, made_by: str) -> Document:
        """Keep what a person says: out of the data sheet, 0 for a global shutter, None for not known.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
            OutOfDateError: DOCUMENT_MISSING or DOCUMENT_OUT_OF_DATE.
        """
        values = {} if readout_ms is None else _values(readout_ms, None, FoundBy.STATED)
        return self._keep(opened_case(self._store), values, made_by=made_by)

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


def fit_readout(report: Report, *, views: tuple[TimedView, ...], camera: CameraModel) -> dict[str, object]:
    """The work itself, in a process of its own."""
    report(0.1, f"fitting the readout to {len(views)} images")
    found = estimate_readout(views, camera)
    return {**asdict(found), "used_ms": found.used_ms}


def _values(readout_ms: float, sd_ms: float | None, found_by: FoundBy) -> dict[str, object]:
    values: dict[str, object] = {"readout_ms": round(readout_ms, 2), "readout_found_by": found_by.value}
    return values if sd_ms is None else {**values, "readout_sd_ms": round(sd_ms, 2)}


def _camera_in(document: Document) -> Mapping[str, object]:
    camera = document.content.get("camera")
    return camera if isinstance(camera, Mapping) else {}

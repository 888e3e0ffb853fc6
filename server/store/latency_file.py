"""File of measured latencies in the home folder; they refer to a camera and a screen, not to a case."""

from dataclasses import asdict
from pathlib import Path

import structlog
from pydantic import TypeAdapter

from server.latency import LatencyResult
from server.store.errors import translate_errors
from server.store.private_file import PrivateJsonFile

FORM = 1
LATENCY_FILE = "latency.json"
# Maximum number of cameras, each with one result.
MAX_CAMERAS = 20

_RESULTS = TypeAdapter(tuple[LatencyResult, ...])
_log = structlog.get_logger(__name__)


class LatencyFile:
    """The newest result of each camera.

    Args:
        folder: The home folder.
    """

    def __init__(self, folder: Path) -> None:
        self._file = PrivateJsonFile(folder / LATENCY_FILE, form=FORM)

    def results(self) -> tuple[LatencyResult, ...]:
        """Return one result per camera, newest first; empty if the file is damaged, which is logged.

        Raises:
            StoreError: the file cannot be read.
        """
        try:
            with translate_errors(self._file.path.parent):
                stored = self._file.read()
            return () if stored is None else _RESULTS.validate_python(stored["results"])
        except (ValueError, KeyError) as error:
            _log.error(
                "the file of latencies is damaged; measure again", file=str(self._file.path), why=str(error)
            )
            return ()

    def of(self, camera: str) -> LatencyResult | None:
        """Return the newest result of this camera; None if there is none.

        Raises:
            StoreError: the file cannot be read.
        """
        return next((one for one in self.results() if one.camera == camera), None)

    def put(self, result: LatencyResult) -> None:
        """Replace the result of the same camera; the new one is on the disk on return.

        Raises:
            StoreError: STORE_FULL and others; the stored results are kept.
        """
        others = [one for one in self.results() if one.camera != result.camera]
        results = [asdict(one) for one in [result, *others][:MAX_CAMERAS]]
        with translate_errors(self._file.path.parent):
            self._file.write({"results": results})

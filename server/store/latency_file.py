"""File of measured latencies in the home folder; they refer to a camera and a screen, not to a case."""

import json
import os
import secrets
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path

import structlog
from pydantic import TypeAdapter, ValidationError

from server.latency import LatencyResult
from server.store.errors import translate_errors
from server.store.home import sync_file, sync_folder

FORM = 1
LATENCY_FILE = "latency.json"
# Maximum number of cameras, each with one result.
MAX_CAMERAS = 20
OWNER_ONLY = 0o600

_RESULTS = TypeAdapter(tuple[LatencyResult, ...])
_log = structlog.get_logger(__name__)


class LatencyFile:
    """The newest result of each camera.

    Args:
        folder: The home folder.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._file = folder / LATENCY_FILE

    def results(self) -> tuple[LatencyResult, ...]:
        """Return one result per camera, newest first; empty if the file is damaged, which is logged.

        Raises:
            StoreError: the file cannot be read.
        """
        with translate_errors(self._folder):
            if not self._file.exists():
                return ()
            content = self._file.read_bytes()
        try:
            stored = json.loads(content)
            if stored["form"] != FORM:
                raise ValueError(f"its format is {stored['form']!r}")  # noqa: TRY301  logged below with all others
            return _RESULTS.validate_python(stored["results"])
        except (ValueError, KeyError, TypeError, ValidationError) as error:
            _log.error(
                "the file of latencies is damaged; measure again", file=str(self._file), why=str(error)
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
        self._write([result, *others][:MAX_CAMERAS])

    def _write(self, results: Iterable[LatencyResult]) -> None:
        content = json.dumps({"form": FORM, "results": [asdict(one) for one in results]}, indent=1)
        part = self._file.with_name(f".{LATENCY_FILE}.{secrets.token_hex(4)}")
        with translate_errors(self._folder):
            descriptor = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, OWNER_ONLY)
            try:
                with os.fdopen(descriptor, "wb") as file:
                    file.write(content.encode())
                    file.flush()
                    sync_file(file.fileno())
                part.replace(self._file)
                sync_folder(self._folder)
            finally:
                part.unlink(missing_ok=True)

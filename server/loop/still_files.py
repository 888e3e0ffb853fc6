"""Cache files of the rehearsal's static background, so that the next start need not render it.

The next start shows its first image a second sooner. At most 8 files of up to 32 MB are stored.
"""

import contextlib
import hashlib
import os
import threading
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import cv2
import numpy as np
import structlog

import tracker
from server.disk import DiskFull, reject_without_space
from server.numpy_file import BAD_NUMPY_FILE

if TYPE_CHECKING:
    from tracker.rehearsal.backdrop import Still

FOLDER, MAX_FILES, MAX_BYTES = "rehearsal_scenery", 8, 32 * 2**20
DTYPES = {"picture": np.uint8, "depth_mm": np.float32, "points_mm": np.float32}

log = structlog.get_logger(__name__)


class StillFiles:
    """Cache files in a folder of the home. On any error the background is rendered instead.

    The key is hashed together with the tracker's source and its libraries' versions: a changed program never
    uses files of another version.

    Args:
        home: Parent folder; if it is missing, nothing is stored.
    """

    def __init__(self, home: Path) -> None:
        self._home = home

    def load(self, key: bytes) -> "Still | None":
        """Return what was saved under this key; None without a readable file."""
        from tracker.rehearsal.backdrop import Still  # noqa: PLC0415  only the rehearsal needs it

        try:
            with self._path(key).open("rb") as file, np.load(file, allow_pickle=False) as saved:
                arrays = {name: saved[name] for name in DTYPES}
        except BAD_NUMPY_FILE:
            return None
        picture, depth_mm, points_mm = arrays.values()
        if any(arrays[name].dtype != dtype for name, dtype in DTYPES.items()):
            return None
        if picture.shape != (*depth_mm.shape, 3) or points_mm.ndim != 3:
            return None
        return Still(picture=picture, depth_mm=depth_mm, points_mm=points_mm)

    def save(self, key: bytes, still: "Still") -> None:
        """Write in a separate thread: the first image does not wait for the disk."""
        arrays = {name: getattr(still, name) for name in DTYPES}
        if sum(array.nbytes for array in arrays.values()) <= MAX_BYTES:
            threading.Thread(
                target=self._write, args=(self._path(key), arrays), name="scenery", daemon=True
            ).start()

    def _write(
        self, path: Path, arrays: dict[str, "np.ndarray[tuple[int, ...], np.dtype[np.generic]]"]
    ) -> None:
        part = path.with_suffix(f".{os.getpid()}.part")
        try:
            reject_without_space(self._home, MAX_BYTES)
            path.parent.mkdir(mode=0o700, exist_ok=True)
            with part.open("wb") as file:
                np.savez(file, **arrays)  # pyrefly: ignore[bad-argument-type]  # its stub takes the last one for allow_pickle
            part.replace(path)
            for old in sorted(path.parent.glob("*.npz"), key=_written_at_s)[:-MAX_FILES]:
                old.unlink(missing_ok=True)
        except (OSError, DiskFull) as error:
            log.debug("the rehearsal's background could not be stored", reason=str(error))
            with contextlib.suppress(OSError):
                part.unlink(missing_ok=True)

    def _path(self, key: bytes) -> Path:
        name = hashlib.sha256(_program() + key).hexdigest()
        return self._home / FOLDER / f"{name[:32]}.npz"


def _written_at_s(path: Path) -> float:
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0


@lru_cache(maxsize=1)
def _program() -> bytes:
    """Return a hash of all sources that determine the rendering."""
    found = hashlib.sha256(f"{np.__version__} {cv2.__version__}".encode())
    for path in sorted(Path(tracker.__file__).parent.rglob("*.py")):
        found.update(path.read_bytes())
    return found.digest()

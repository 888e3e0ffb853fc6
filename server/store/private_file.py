"""Small files that only their owner can read, each rewritten as a whole and durable when written."""

import errno
import json
import os
import secrets
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from server.disk import sync_file, sync_path

OWNER_ONLY = 0o600


class PrivateJsonFile:
    """A JSON object in a file, with the number of its form.

    Args:
        file: the file, in a folder that exists.
        form: number of the form that this version reads and writes.
    """

    def __init__(self, file: Path, *, form: int) -> None:
        self.path = file
        self._form = form

    def read(self) -> Mapping[str, Any] | None:
        """Return the stored object; None without a file.

        Raises:
            OSError: the file cannot be read.
            ValueError: it is damaged, or of another form.
        """
        if not self.path.exists():
            return None
        try:
            stored = json.loads(self.path.read_bytes())
        except RecursionError:
            raise ValueError("it is nested too deeply") from None
        if not isinstance(stored, dict) or stored.get("form") != self._form:
            raise ValueError(f"it is not a JSON object of form {self._form}")
        return stored

    def write(self, members: Mapping[str, object]) -> None:
        """Replace the stored object; the new one is on the disk on return.

        Raises:
            OSError: it cannot be written; the stored object stays.
        """
        write_private(self.path, json.dumps({"form": self._form, **members}, indent=1).encode())
        sync_path(self.path.parent)


def write_private(file: Path, content: bytes) -> None:
    """Write a file that only its owner can read, atomically, and on the disk on return.

    Raises:
        OSError: it cannot be written.
    """
    part = file.with_name(f".{file.name}.{secrets.token_hex(4)}")
    descriptor = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, OWNER_ONLY)
    try:
        try:
            write_all(descriptor, content)
            sync_file(descriptor)
        finally:
            os.close(descriptor)
        part.replace(file)
    except OSError:
        part.unlink(missing_ok=True)
        raise


def write_all(descriptor: int, content: bytes) -> None:
    """Write every byte: on a nearly full disk one call writes only a part.

    Raises:
        OSError: not all can be written; a part may be.
    """
    left = memoryview(content)
    while left:
        written = os.write(descriptor, left)
        if written <= 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        left = left[written:]

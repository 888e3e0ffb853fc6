"""Where a command's lines go: a file that is whole or is not there, a device, or standard output."""

import contextlib
import os
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import IO

from tracker.errors import InvalidInput

PART = ".part"


class Lines:
    """Writes lines, and says in one sentence when they cannot be written."""

    def __init__(self, file: IO[str], *, name: str, on_disk: bool) -> None:
        self._file = file
        self._name = name
        self._on_disk = on_disk

    def write(self, line: str) -> None:
        """Write one line.

        Raises:
            InvalidInput: OUTPUT_NOT_WRITTEN, the disk is full or gone.
            BrokenPipeError: nobody reads standard output any more.
        """
        with self._told():
            self._file.write(line + "\n")

    def finish(self) -> None:
        """See that all lines have arrived. Raises as `write`."""
        with self._told():
            self._file.flush()
            if self._on_disk:
                os.fsync(self._file.fileno())

    @contextlib.contextmanager
    def _told(self) -> Iterator[None]:
        try:
            yield
        except BrokenPipeError:
            raise
        except OSError as error:
            raise InvalidInput(
                "OUTPUT_NOT_WRITTEN",
                f"{self._name} cannot be written to its end: {(error.strerror or str(error)).lower()}",
                "Make room, or name a file on another disk; what was written so far is no whole result.",
                {"file": self._name},
            ) from error


@contextlib.contextmanager
def lines_to(json_file: str | None, *, inputs: Iterable[Path], replace: bool) -> Iterator[Lines | None]:
    """Where lines go; None where none are wanted.

    A file has its name only once it is complete, until then it ends in .part. What is no ordinary file (a
    device, a pipe) is written into and never replaced.

    Args:
        json_file: a path, "-" for standard output, or None.
        inputs: what is read meanwhile, and must not be written over.
        replace: whether a file of that name may be written over. An empty one always may.

    Raises:
        InvalidInput: OUTPUT_IS_INPUT, OUTPUT_EXISTS, OUTPUT_NOT_WRITABLE, or OUTPUT_NOT_WRITTEN.
    """
    if json_file is None:
        yield None
        return
    if json_file == "-":
        lines = Lines(sys.stdout, name="standard output", on_disk=False)
        yield lines
        lines.finish()
        return
    # A link stays a link: what it names is written.
    path = Path(json_file).resolve()
    replaced = path.is_file() or not path.exists()
    written = path.with_name(path.name + PART) if replaced else path
    _reject_input(json_file, (path, written), inputs)
    if replaced and not replace:
        _reject_older(json_file, path)
    file = _opened(written)
    lines = Lines(file, name=str(written), on_disk=replaced)
    try:
        yield lines
        lines.finish()
    finally:
        # What could not be written cannot be written now either, and is told already.
        with contextlib.suppress(OSError):
            file.close()
    if replaced:
        written.replace(path)


def write_whole(path: Path, content: bytes) -> None:
    """Write a file that is whole or is not there; its folder is made where it is missing.

    Raises:
        InvalidInput: OUTPUT_NOT_WRITABLE.
    """
    part = path.with_name(path.name + PART)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part.write_bytes(content)
        part.replace(path)
    except OSError as error:
        raise InvalidInput(
            "OUTPUT_NOT_WRITABLE",
            f"{path} cannot be written: {(error.strerror or str(error)).lower()}",
            "Give a folder that may be written, on a disk with room, with --output.",
            {"file": str(path)},
        ) from error


def reject_unwritable(path: Path) -> None:
    """See that a file can be written before the work for it; its folder is made where it is missing.

    Raises:
        InvalidInput: OUTPUT_NOT_WRITABLE.
    """
    part = path.with_name(path.name + PART)
    write_whole(part, b"")
    part.unlink()


def _opened(path: Path) -> IO[str]:
    try:
        return path.open("w", encoding="utf-8", buffering=1)
    except OSError as error:
        raise InvalidInput(
            "OUTPUT_NOT_WRITABLE",
            f"{path} cannot be written: {(error.strerror or '').lower()}",
            "Give a file in a folder that exists and may be written, or - for standard output.",
            {"file": str(path)},
        ) from error


def _reject_older(json_file: str, path: Path) -> None:
    size = path.stat().st_size if path.exists() else 0
    if size:
        raise InvalidInput(
            "OUTPUT_EXISTS",
            f"there is a file {json_file} already, of {size} bytes",
            "Give another one with --json, or --replace if it is not used any more.",
            {"file": json_file, "bytes": size},
        )


def _reject_input(json_file: str, outputs: Iterable[Path], inputs: Iterable[Path]) -> None:
    for output in outputs:
        for source in inputs:
            with contextlib.suppress(OSError):
                if output.samefile(source):
                    raise InvalidInput(
                        "OUTPUT_IS_INPUT",
                        f"--json {json_file} would write over {source}, which is read",
                        "Give the lines a file of their own.",
                        {"file": json_file, "input": str(source)},
                    )

"""Output of commands: files that are replaced atomically, devices, and standard output."""

import contextlib
import os
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import IO

from tracker.errors import InvalidInput, NavigationError, Remark

PART = ".part"


class LineWriter:
    """Write lines to a stream; I/O errors become `InvalidInput`."""

    def __init__(self, file: IO[str], *, name: str, on_disk: bool) -> None:
        self._file = file
        self._name = name
        self._on_disk = on_disk

    def write(self, line: str) -> None:
        """Write one line.

        Raises:
            InvalidInput: OUTPUT_NOT_WRITTEN, the disk is full or gone.
            BrokenPipeError: the reader of standard output has closed it.
        """
        with self._converted_errors():
            self._file.write(line + "\n")

    def finish(self) -> None:
        """Flush all lines to the disk. Raises the same errors as `write`."""
        with self._converted_errors():
            self._file.flush()
            if self._on_disk:
                os.fsync(self._file.fileno())

    @contextlib.contextmanager
    def _converted_errors(self) -> Iterator[None]:
        try:
            yield
        except BrokenPipeError:
            raise
        except OSError as error:
            raise InvalidInput(
                "OUTPUT_NOT_WRITTEN",
                f"{self._name} was not written completely: {(error.strerror or str(error)).lower()}",
                "Free space, or give a file on another disk. The output so far is incomplete.",
                {"file": self._name},
            ) from error


@contextlib.contextmanager
def line_writer(
    json_file: str | None, *, inputs: Iterable[Path], replace: bool
) -> Iterator[LineWriter | None]:
    """Yield the writer for the output; None if no output is requested.

    A file is written under a name ending in .part and renamed when it is complete. Devices and pipes are
    written to directly.

    Args:
        json_file: A path, "-" for standard output, or None.
        inputs: Files that are being read and must not be overwritten.
        replace: Whether an existing file may be overwritten. An empty file always may.

    Raises:
        InvalidInput: OUTPUT_IS_INPUT, OUTPUT_EXISTS, OUTPUT_NOT_WRITABLE, or OUTPUT_NOT_WRITTEN.
    """
    if json_file is None:
        yield None
        return
    if json_file == "-":
        lines = LineWriter(sys.stdout, name="standard output", on_disk=False)
        yield lines
        lines.finish()
        return
    # A symbolic link is kept; its target is written.
    path = Path(json_file).resolve()
    replaced = path.is_file() or not path.exists()
    written = path.with_name(path.name + PART) if replaced else path
    _reject_input(json_file, (path, written), inputs)
    if replaced and not replace:
        _reject_older(json_file, path)
    file = _opened(written)
    lines = LineWriter(file, name=str(written), on_disk=replaced)
    try:
        yield lines
        lines.finish()
    finally:
        # A failed write was already reported; closing the file fails for the same reason.
        with contextlib.suppress(OSError):
            file.close()
    if replaced:
        written.replace(path)


def write_atomically(path: Path, content: bytes) -> None:
    """Write a file atomically; create its folder if it is missing.

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
            "Give a writable folder on a disk with free space with --output.",
            {"file": str(path)},
        ) from error


def reject_unwritable(path: Path) -> None:
    """Check that a file can be written; create its folder if it is missing.

    Raises:
        InvalidInput: OUTPUT_NOT_WRITABLE.
    """
    part = path.with_name(path.name + PART)
    write_atomically(part, b"")
    part.unlink()


def _opened(path: Path) -> IO[str]:
    try:
        return path.open("w", encoding="utf-8", buffering=1)
    except OSError as error:
        raise InvalidInput(
            "OUTPUT_NOT_WRITABLE",
            f"{path} cannot be written: {(error.strerror or '').lower()}",
            "Give a file in an existing writable folder, or - for standard output.",
            {"file": str(path)},
        ) from error


def _reject_older(json_file: str, path: Path) -> None:
    size = path.stat().st_size if path.exists() else 0
    if size:
        raise InvalidInput(
            "OUTPUT_EXISTS",
            f"the file {json_file} exists already ({size} bytes)",
            "Give another file with --json, or overwrite this one with --replace.",
            {"file": json_file, "bytes": size},
        )


def _reject_input(json_file: str, outputs: Iterable[Path], inputs: Iterable[Path]) -> None:
    for output in outputs:
        for source in inputs:
            with contextlib.suppress(OSError):
                if output.samefile(source):
                    raise InvalidInput(
                        "OUTPUT_IS_INPUT",
                        f"--json {json_file} would overwrite the input {source}",
                        "Give another output file with --json.",
                        {"file": json_file, "input": str(source)},
                    )


def remark_text(remark: Remark) -> str:
    """Return a remark in sentences, on one line."""
    return f"{remark.message}. {remark.remedy}".rstrip()


def problem_values(one: NavigationError | Remark) -> dict[str, str]:
    """Return the JSON fields of a problem or remark."""
    return {"code": one.code, "message": one.message, "remedy": one.remedy}

"""Uploads: request bodies streamed to a temporary file."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

from anyio import to_thread
from fastapi import Request
from starlette.requests import ClientDisconnect

from server.store import Home, translate_errors
from tracker.errors import InvalidInput

# Size of the writes to the disk.
PIECE_BYTES = 2**20


@asynccontextmanager
async def received(request: Request, home: Home, *, max_bytes: int) -> AsyncIterator[Path]:
    """Yield the request body as a file, which is deleted at the end of the block unless it was moved.

    Raises:
        InvalidInput: UPLOAD_TOO_LARGE (HTTP 413), UPLOAD_EMPTY, UPLOAD_CUT.
        StoreError: STORE_FULL, STORE_READ_ONLY or STORE_FAILED.
    """
    announced_bytes = _announced_bytes(request)
    _reject_above(announced_bytes, max_bytes)
    home.reject_without_space(announced_bytes)
    path = home.new_temporary()
    try:
        await _write(request, path, home, max_bytes=max_bytes)
        yield path
    finally:
        await to_thread.run_sync(lambda: path.unlink(missing_ok=True))


async def _write(request: Request, path: Path, home: Home, *, max_bytes: int) -> None:
    taken_bytes, waiting = 0, bytearray()
    with translate_errors(home.folder, known_only=True):
        stream = await to_thread.run_sync(lambda: path.open("xb"))
        try:
            async for chunk in request.stream():
                taken_bytes += len(chunk)
                _reject_above(taken_bytes, max_bytes)
                waiting += chunk
                if len(waiting) >= PIECE_BYTES:
                    await to_thread.run_sync(stream.write, waiting)
                    waiting = bytearray()
            await to_thread.run_sync(stream.write, waiting)
        except ClientDisconnect:
            raise InvalidInput(
                "UPLOAD_CUT",
                f"the connection ended after {taken_bytes / 2**20:.1f} MB",
                "Send it again; the received part was discarded.",
                {"taken_bytes": taken_bytes, "taken_mb": taken_bytes / 2**20},
            ) from None
        finally:
            await to_thread.run_sync(stream.close)
    if not taken_bytes:
        raise InvalidInput(
            "UPLOAD_EMPTY", "the request body is empty", "Send the file as the body of the request."
        )


def _announced_bytes(request: Request) -> int:
    announced = request.headers.get("content-length", "")
    return int(announced) if announced.isdecimal() else 0


def _reject_above(size_bytes: int, max_bytes: int) -> None:
    if size_bytes > max_bytes:
        raise InvalidInput(
            "UPLOAD_TOO_LARGE",
            f"the file has {size_bytes / 2**20:.1f} MB or more, the maximum is {max_bytes / 2**20:g} MB",
            "Send a smaller file.",
            {
                "size_bytes": size_bytes,
                "allowed_bytes": max_bytes,
                "size_mb": size_bytes / 2**20,
                "max_mb": max_bytes / 2**20,
            },
        )

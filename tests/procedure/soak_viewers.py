"""Viewers that come and go: each takes video, figures, plain video or the room for a while, and leaves.

    PYTHONPATH=. python -m tests.procedure.soak_viewers --port 8000 --viewers 10 --seconds 60

Prints one line for each message with a result: the monotonic time of its arrival, and its age in ms.
"""

import argparse
import asyncio
import json
import random
import sys
import time
from collections.abc import Awaitable, Callable

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import WebSocketException

from server.stream.view_socket import HEADER_LENGTH

MIN_STAY_S, MAX_STAY_S = 3.0, 30.0
BLOCK_BYTES = 65_536


def _note(message: dict[str, object]) -> None:
    snapshot = message.get("snapshot")
    if isinstance(snapshot, dict):
        now_s = time.monotonic()
        sys.stdout.write(f"{now_s:.3f} {1e3 * (now_s - snapshot['captured_at_s']):.1f}\n")


async def _figures(socket: ClientConnection) -> None:
    _note(json.loads(await socket.recv()))


async def _video(socket: ClientConnection) -> None:
    await socket.send('{"next": true}')
    content = await socket.recv(decode=False)
    (length,) = HEADER_LENGTH.unpack_from(content)
    _note(json.loads(content[HEADER_LENGTH.size : HEADER_LENGTH.size + length]))


async def _room(socket: ClientConnection) -> None:
    await socket.send('{"next": true}')
    await socket.recv()


SOCKETS: tuple[tuple[str, Callable[[ClientConnection], Awaitable[None]]], ...] = (
    ("/ws/live", _figures),
    ("/ws/view?size=half", _video),
    ("/ws/room?view=theatre", _room),
)


async def _plain_video(port: int) -> None:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        writer.write(f"GET /video/main.mjpg HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
        while await reader.read(BLOCK_BYTES):
            pass
    finally:
        writer.close()


async def _sit(port: int, rng: random.Random) -> None:
    """Stay with one kind of view for a while."""
    choice = rng.randrange(len(SOCKETS) + 1)
    if choice == len(SOCKETS):
        await _plain_video(port)
        return
    path, take = SOCKETS[choice]
    async with connect(f"ws://127.0.0.1:{port}{path}", proxy=None, compression=None, max_size=None) as socket:
        while True:
            await take(socket)


async def _come_and_go(port: int, rng: random.Random, until_s: float) -> None:
    while (left_s := until_s - time.monotonic()) > 0.0:
        stay_s = min(left_s, rng.uniform(MIN_STAY_S, MAX_STAY_S))
        try:
            async with asyncio.timeout(stay_s):
                await _sit(port, rng)
        except (TimeoutError, OSError, WebSocketException, EOFError):
            # Its time is over, or it was disconnected; the next one comes in a moment.
            await asyncio.sleep(0.2)


async def _all(port: int, viewers: int, seconds: float) -> None:
    until_s = time.monotonic() + seconds
    await asyncio.gather(*(_come_and_go(port, random.Random(number), until_s) for number in range(viewers)))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--port", type=int, required=True)
    parser.add_argument("--viewers", type=int, required=True)
    parser.add_argument("--seconds", type=float, required=True)
    given = parser.parse_args()
    asyncio.run(_all(given.port, given.viewers, given.seconds))

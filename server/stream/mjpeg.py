"""Video as MJPEG over plain HTTP."""

import asyncio
import contextlib
import json
import time
from collections.abc import AsyncIterator, Mapping
from datetime import datetime

from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from server.live import Instant, LiveHub
from server.security import person_of
from server.stream.connection import Connection, connection_of
from server.stream.no_video import NoVideoCard
from server.stream.scaling.picture_cache import PictureCache
from server.stream.scaling.sizes import PictureSize, SizeChoice
from server.stream.tasks import run_until_first_ends
from server.stream.viewers import Viewer, ViewerKind, Viewers

BOUNDARY = "coaxial"
MEDIA_TYPE = f"multipart/x-mixed-replace; boundary={BOUNDARY}"
PART_HEAD = f"--{BOUNDARY}\r\nContent-Type: image/jpeg\r\n\r\n".encode()
# Chrome displays a part when the next one's head has arrived. So that head follows each image at once, and
# cannot contain the length or number of the next image. Those are inside the JPEG.
PART_END = b"\r\n" + PART_HEAD
CARD_AGAIN_S = 1.0

START_OF_JFIF = b"\xff\xd8\xff\xe0"
COMMENT = b"\xff\xfe"


def with_comment(jpeg: bytes, facts: Mapping[str, object]) -> bytes:
    """Return the JPEG with these facts as a JSON comment; the image data is unchanged."""
    content = json.dumps(dict(facts), separators=(",", ":")).encode()
    segment = COMMENT + (len(content) + 2).to_bytes(2, "big") + content
    # JFIF requires its own segment first.
    at = 4 + int.from_bytes(jpeg[4:6], "big") if jpeg.startswith(START_OF_JFIF) else 2
    return b"".join((jpeg[:at], segment, jpeg[at:]))


class Video:
    """Pictures of the one camera, for any number of MJPEG viewers."""

    def __init__(
        self, *, hub: LiveHub, viewers: Viewers, pictures: PictureCache, stale_after_ms: float
    ) -> None:
        self._hub = hub
        self._viewers = viewers
        self._pictures = pictures
        self._stale_after_s = stale_after_ms / 1000.0
        self._card = NoVideoCard()

    def response(self, choice: SizeChoice = SizeChoice.AUTO) -> Response:
        """Return the endless response of a viewer."""
        return MjpegResponse(self, self._viewers, choice)

    def missed(self, viewer: Viewer) -> int:
        """Return how many images the viewer has missed, beside the newest."""
        newest = self._hub.newest
        return 0 if newest is None else max(0, newest.sequence - viewer.sequence - 1)

    async def pictures(self, viewer: Viewer) -> AsyncIterator[bytes]:
        """Yield the newest picture, and again whenever there is a newer one; a card without one.

        The picture is always the newest at the moment at which the viewer can receive it.
        """
        # Before the first instant there is nothing to wait for: send the card at once.
        timeout_s = self._stale_after_s if self._hub.newest is not None else 0.0
        while True:
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(timeout_s):
                    viewer.mark_taken((await self._hub.next_after(viewer.sequence)).sequence)
            instant, now_s = self._hub.newest, time.monotonic()
            if instant is not None:
                viewer.mark_taken(instant.sequence)
            if instant is not None and self._is_live(instant, now_s=now_s):
                timeout_s = self._stale_after_s
                size = viewer.adaptive_size.size
                jpeg = await self._pictures.of(instant, size)
                yield _with_facts(instant, jpeg, size)
            else:
                timeout_s = CARD_AGAIN_S
                clock = datetime.now().astimezone()
                card = self._card.jpeg(instant, now_s=now_s, clock=clock)
                yield with_comment(card, {"image_number": None})

    def _is_live(self, instant: Instant, *, now_s: float) -> bool:
        snapshot = instant.snapshot
        return (
            snapshot is not None
            and instant.has_picture
            and now_s - snapshot.captured_at_s <= self._stale_after_s
        )


def _with_facts(instant: Instant, jpeg: bytes, size: PictureSize) -> bytes:
    if instant.snapshot is None or not jpeg:
        return jpeg
    number, captured_at_s = instant.snapshot.image_number, instant.snapshot.captured_at_s
    facts = {
        "image_number": number,
        "captured_at_s": round(captured_at_s, 6),
        "age_ms": round((time.monotonic() - captured_at_s) * 1000.0, 1),
        "shown_scale_ratio": size.scale_ratio,
    }
    return with_comment(jpeg, facts)


class MjpegResponse(Response):
    """An endless multipart response; a viewer that stalls or disconnects ends it."""

    media_type = MEDIA_TYPE

    def __init__(self, video: Video, viewers: Viewers, choice: SizeChoice) -> None:
        self.status_code = 200
        self.background = None
        self.body = b""
        self.init_headers(
            {"Cache-Control": "no-store, no-transform", "X-Accel-Buffering": "no", "Pragma": "no-cache"}
        )
        del self.headers["content-length"]
        self._video = video
        self._viewers = viewers
        self._choice = choice

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send until the viewer disconnects or stalls.

        Raises:
            TooManyViewers: the maximum is reached; the response has not started then.
        """
        connection = connection_of(scope)
        with self._viewers.register(ViewerKind.MJPEG, self._choice, person=person_of(scope)) as viewer:
            if connection is not None:
                connection.is_endless = True
            try:
                await run_until_first_ends(self._feed(send, connection, viewer), _until_gone(receive))
            finally:
                if connection is not None:
                    connection.abort()

    async def _feed(self, send: Send, connection: Connection | None, viewer: Viewer) -> None:
        start = {"type": "http.response.start", "status": 200, "headers": self.raw_headers}
        await self._viewers.send(send(start), connection)
        await self._viewers.send(send(_body(PART_HEAD)), connection)
        async for picture in self._video.pictures(viewer):
            began_s = time.monotonic()
            await self._viewers.send(send(_body(picture + PART_END)), connection)
            viewer.adaptive_size.sent(
                began_s=began_s, ended_s=time.monotonic(), missed=self._video.missed(viewer)
            )


def _body(content: bytes) -> dict[str, object]:
    return {"type": "http.response.body", "body": content, "more_body": True}


async def _until_gone(receive: Receive) -> None:
    while (await receive())["type"] != "http.disconnect":
        pass

"""The addresses of the streams."""

from fastapi import APIRouter, WebSocket
from starlette.responses import Response

from server.api.errors import rejections
from server.stream.errors import CameraUnknown
from server.stream.fitting.sizes import Choice, choice_from_text
from server.stream.live_socket import watch_live
from server.stream.mjpeg import Video
from server.stream.phone.socket import PhoneDoor, receive_phone
from server.stream.socket import LONGEST_REASON, REJECTED
from server.stream.view_socket import View, watch_view
from tracker.errors import NavigationError

SOCKETS_IN_WORDS = """
`WS /ws/live`: one `LiveMessage` as JSON text for each instant, the newest at once. A slow client skips
instants (gaps in `sequence`); one that takes nothing for 2 s is cut off. The client sends nothing.

`WS /ws/view?camera=main&size=auto`: the client sends `{"next": true}` and gets one binary message: 4 bytes
length of the header (unsigned, little endian), the header (a `LiveMessage` as JSON), and the JPEG of that
same instant, empty when there is no image. Then it may ask again: one image is on the way at a time. The
size is full, half or quarter, or auto for the one that the line carries; `{"size": "half"}` changes it while
the line stands, and `shown_scale_ratio` in the header says in which one the picture came. A client may say
how long it needed to show an image, `{"next": true, "showing_ms": 12}`, so that this does not count against
its line, and that it cannot show a larger one, `{"largest": "half"}`.

`WS /ws/camera`: the page `/camera` sends the images of its device's camera, where `camera.source` is `phone`.
Text messages are JSON with one key. The page says `hello` with a key of its own, and is told `welcome` (size,
rate, quality, largest part) or `refused` (an error). `note` comes for each image and twice a second: the page
answers its `ping` at once with `pong` and its clock in ms, and may send as many images as its `credit` says,
from the beginning. Each is an `image` message (bytes, capture time, whose clock) and the JPEG in binary
parts; `camera` before it says what the browser granted. One page sends at a time; one that is silent for 3 s
is gone.

The first two are open to pages of this server and to programs that send no Origin. A client that sends
anything else is closed with code 1008 or 1009 and the reason in words; one that is too many
(`video.max_viewers`, eight of one person, and an eighth of all is kept for operators and screens), with
1013. The 3-D scene at `/scene/` has as many places of its own, given in the same way.
"""


def streams_router(*, camera_name: str, video: Video, view: View, phone: PhoneDoor) -> APIRouter:
    """`GET /video/{camera}.mjpg`, `WS /ws/live`, `WS /ws/view` and `WS /ws/camera`."""
    router = APIRouter(tags=["streams"])

    @router.get(
        "/video/{camera}.mjpg",
        response_class=Response,
        responses={
            200: {
                "content": {"multipart/x-mixed-replace": {}},
                "description": "JPEG after JPEG, without end.",
            },
            **rejections(404, 422, 503),
        },
    )
    async def video_of(camera: str, size: Choice = Choice.AUTO) -> Response:
        """The camera's picture with the overlay burned in, as MJPEG.

        Always the newest image; a slow viewer gets fewer, and with `size=auto` smaller ones. When
        there is none, or it is too old, a picture
        that says NO VIDEO with the reason and the time, once a second. Each JPEG has a comment with
        `image_number` (null for that picture), `captured_at_s` (monotonic clock of the server), `age_ms`
        (at sending) and `shown_scale_ratio` (1, 0.5 or 0.25) as JSON.
        """
        if camera != camera_name:
            raise CameraUnknown(camera, [camera_name])
        return video.response(size)

    @router.websocket("/ws/live")
    async def live(websocket: WebSocket) -> None:
        await watch_live(websocket, hub=view.hub, viewers=view.viewers, texts=view.texts)

    @router.websocket("/ws/view")
    async def watched(websocket: WebSocket) -> None:
        asked = websocket.query_params.get("camera", camera_name)
        try:
            if asked != camera_name:
                raise CameraUnknown(asked, [camera_name])
            choice = choice_from_text(websocket.query_params.get("size", Choice.AUTO))
        except NavigationError as error:
            await _reject(websocket, error)
            return
        await watch_view(websocket, view, choice=choice)

    @router.websocket("/ws/camera")
    async def sent(websocket: WebSocket) -> None:
        await receive_phone(websocket, phone)

    return router


async def _reject(websocket: WebSocket, error: NavigationError) -> None:
    """Say why, which a browser shows to no page before the socket is accepted."""
    await websocket.accept()
    await websocket.close(REJECTED, error.message[:LONGEST_REASON])

"""Routes of the video and data streams."""

from fastapi import APIRouter, WebSocket
from starlette.responses import Response

from server.api.errors import rejections
from server.overlay import OverlayContent
from server.stream.errors import CameraUnknown
from server.stream.live_socket import watch_live
from server.stream.mjpeg import Video
from server.stream.phone.socket import PhoneEndpoint, receive_phone
from server.stream.scaling.sizes import SizeChoice, choice_from_text
from server.stream.socket import MAX_REASON_BYTES, REJECTED
from server.stream.view_socket import ViewContext, watch_view
from tracker.errors import NavigationError

SOCKETS_DESCRIPTION = """
`WS /ws/live`: one `LiveMessage` as JSON text for each instant, starting with the newest. A slow client skips
instants (gaps in `sequence`); a client that reads nothing for 2 s is disconnected. The client sends nothing.

`WS /ws/view?camera=main&size=auto&overlay=full`: the client sends `{"next": true}` and receives one binary
message: the length of the header (4 bytes, unsigned, little endian), the header (a `LiveMessage` as JSON),
and the JPEG of the same instant, empty if there is no image. One image is in flight at a time. The size is
full, half or quarter, or auto to match the bandwidth; `{"size": "half"}` changes it, and `shown_scale_ratio`
in the header is the size of the image. With `overlay=geometry` only markers, drills and channel are drawn
into it, for clients that display figures and alarms themselves. A client may report its display time,
`{"next": true, "showing_ms": 12}`, so that it is not counted as network delay, and its largest displayable
size, `{"largest": "half"}`. With `{"interval_ms": 50}` (0 to 1000) images are at least that far apart on
average; a state without image and an alarm that changes are sent at once.

`WS /ws/camera`: the page `/camera` sends the images of its device's camera, where `camera.source` is `phone`.
Text messages are JSON with one key. The page sends `hello` with its key and receives `welcome`
(size, rate, quality, largest part) or `rejected` (error). `note` is sent for each image and twice a second:
the page answers its `ping` with `pong` and its clock in ms. `credit` is the total number of images that the
page may send. Each image is an `image` message (bytes, capture time, clock) and the JPEG in binary parts,
preceded by `camera` with the settings of the browser. One page sends at a time; after 3 s of silence it
counts as disconnected.

The first two accept pages of this server and programs without an Origin header. Invalid messages close the
connection with code 1008 or 1009 and a reason; too many viewers with 1013 (`video.max_viewers`, eight per
person; an eighth is reserved for operators and screens). `/ws/live` and the 3-D scene at `/scene/` each have
the same limits beside those of the video.
"""


def streams_router(*, camera_name: str, video: Video, view: ViewContext, phone: PhoneEndpoint) -> APIRouter:
    """Return the router of `GET /video/{camera}.mjpg`, `WS /ws/live`, `WS /ws/view` and `WS /ws/camera`."""
    router = APIRouter(tags=["streams"])

    @router.get(
        "/video/{camera}.mjpg",
        response_class=Response,
        responses={
            200: {
                "content": {"multipart/x-mixed-replace": {}},
                "description": "An endless sequence of JPEG images.",
            },
            **rejections(404, 422, 503),
        },
    )
    async def video_of(camera: str, size: SizeChoice = SizeChoice.AUTO) -> Response:
        """Return the video with overlay as MJPEG.

        Each frame is the newest image; a slow viewer receives fewer and, with `size=auto`, smaller ones.
        Without a recent image, a card NO VIDEO with reason and time is sent once a second. Each JPEG has a
        comment with `image_number` (null for the card), `captured_at_s` (monotonic clock of the server),
        `age_ms` (at sending) and `shown_scale_ratio` (1, 0.5 or 0.25) as JSON.
        """
        if camera != camera_name:
            raise CameraUnknown(camera, [camera_name])
        return video.response(size)

    @router.websocket("/ws/live")
    async def live(websocket: WebSocket) -> None:
        await watch_live(websocket, hub=view.hub, viewers=view.viewers, texts=view.texts)

    @router.websocket("/ws/view")
    async def watched(websocket: WebSocket) -> None:
        requested = websocket.query_params.get("camera", camera_name)
        try:
            if requested != camera_name:
                raise CameraUnknown(requested, [camera_name])
            query = websocket.query_params
            choice = choice_from_text("size", query.get("size", SizeChoice.AUTO), SizeChoice)
            overlay = choice_from_text("overlay", query.get("overlay", OverlayContent.FULL), OverlayContent)
        except NavigationError as error:
            await _reject(websocket, error)
            return
        await watch_view(websocket, view, choice=choice, overlay=overlay)

    @router.websocket("/ws/camera")
    async def sent(websocket: WebSocket) -> None:
        await receive_phone(websocket, phone)

    return router


async def _reject(websocket: WebSocket, error: NavigationError) -> None:
    """Accept and close with a reason, because browsers hide the reason of a rejected handshake."""
    await websocket.accept()
    await websocket.close(REJECTED, error.message[:MAX_REASON_BYTES])

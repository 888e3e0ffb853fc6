"""A synthetic theatre for the scene: a block as bone, a channel, a drill, and instants on demand."""

import asyncio
import socket
import threading
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager
from dataclasses import dataclass, replace

import numpy as np
import uvicorn
from starlette.applications import Starlette
from starlette.responses import HTMLResponse
from starlette.routing import Route

from server.live import Instant, LiveHub, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.scene import mount_scene
from server.stream.viewers import ViewerKind, Viewers
from tests.tracker.scenes import perfectly_seen
from tracker.camera import CameraModel
from tracker.geometry import Camera, Rigid, Tool, Vertebra, rotation_between
from tracker.navigation import Absent, AbsentReason, Setup, navigate
from tracker.plan import Channel, Surface
from tracker.pose import Seen, Sighting, ToolModel, Unseen, UnseenReason
from tracker.registration import Registration

PARENT = """<!doctype html><title>parent</title><body style="margin:0;background:#222">
<script>
window.received = [];
addEventListener("message", (e) => { if (e.origin === location.origin) received.push(e.data); });
</script>
<iframe id="scene" src="/scene/" style="border:0;width:100vw;height:100vh"></iframe>"""


def block(centre: tuple[float, float, float], half: tuple[float, float, float]) -> Surface:
    """A box, wound counter-clockwise seen from outside."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float64)
    faces = [
        (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
        (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
    ]  # fmt: skip
    return Surface(vertices_mm=corners * half + centre, faces=np.array(faces, dtype=np.int64))


@dataclass(frozen=True, kw_only=True)
class Theatre:
    """Made-up truth: the camera looks at the patient's back from 400 mm."""

    setup: Setup
    surface: Surface

    def instant(
        self, sequence: int, *, image_number: int | None, seen: bool = True, tip_z_mm: float = 0.0
    ) -> Instant:
        """An instant with the drill on the channel's axis, `tip_z_mm` before the entry."""
        source = SourceStatus(name="made up", state=SourceState.RUNNING)
        process = ProcessStatus(state=ProcessState.RUNNING)
        if image_number is None:
            return Instant(sequence=sequence, source=source, process=process)
        sighting: Sighting = Unseen(reason=UnseenReason.NO_CANDIDATE)
        if seen:
            sighting = self.sighting(tip_z_mm)
        snapshot = navigate(
            setup=self.setup,
            sightings={"drill": sighting},
            image_number=image_number,
            captured_at_s=0.0,
            size_wh_px=(1280, 720),
            stage_ms={},
            skipped_images=0,
        )
        return Instant(sequence=sequence, source=source, process=process, snapshot=snapshot)

    def sighting(self, tip_z_mm: float) -> Seen:
        """Pose of the marker for this position of the drill."""
        channel, registration = self.setup.channel, self.setup.registration
        assert isinstance(channel, Channel)
        assert isinstance(registration, Registration)
        anchor = registration.anchor_from_vertebra
        camera_from_vertebra: Rigid[Camera, Vertebra] = Rigid(
            rotation=anchor.rotation, translation_mm=anchor.translation_mm
        )
        vertebra_from_tool: Rigid[Vertebra, Tool] = Rigid(
            rotation=rotation_between([0, 0, 1], channel.axis_in_vertebra),
            translation_mm=channel.entry_in_vertebra_mm - channel.axis_in_vertebra * tip_z_mm,
        )
        marker = (
            camera_from_vertebra @ vertebra_from_tool @ self.setup.tools["drill"].marker_from_tool.inverse
        )
        return perfectly_seen(marker, covariance=np.eye(6) * 1e-4)

    def unregistered(self) -> "Theatre":
        """The same before registration."""
        return replace(
            self, setup=replace(self.setup, registration=Absent(reason=AbsentReason.NOT_REGISTERED))
        )


def make_theatre() -> Theatre:
    """A drill approaching the left pedicle."""
    tool = ToolModel.from_tip_and_axis(
        name="drill",
        marker="drill",
        tip_in_marker_mm=[0.0, -120.0, 0.0],
        axis_in_marker=[0.0, -1.0, 0.0],
        radius_mm=2.0,
        length_mm=110.0,
    )
    # Posterior is +y, and the camera looks along -y from behind the patient; its image is upright (z up).
    rotation = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]])
    setup = Setup(
        camera=CameraModel(
            matrix=np.array([[1100.0, 0, 640], [0, 1100, 360], [0, 0, 1]]),
            distortion=np.zeros(5),
            size_wh_px=(1280, 720),
        ),
        camera_calibrated=True,
        tools={"drill": tool},
        channel=Channel(
            name="L3 left",
            entry_in_vertebra_mm=np.array([14.0, 18.0, 4.0]),
            target_in_vertebra_mm=np.array([6.0, -20.0, 2.0]),
            radius_mm=3.5,
        ),
        registration=Registration.known_to_camera(
            Rigid(rotation=rotation, translation_mm=np.array([0.0, 0.0, 400.0]))
        ),
    )
    return Theatre(setup=setup, surface=block((0.0, -6.0, 0.0), (24.0, 24.0, 14.0)))


@dataclass(kw_only=True)
class Running:
    """A server in a thread of this process, and its hub."""

    port: int
    hub: LiveHub
    app: Starlette
    stop: Callable[[], None]

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.port}"


@contextmanager
def running(
    theatre: Theatre, *, port: int = 0, stale_after_ms: float = 500.0, max_viewers: int = 32
) -> Iterator[Running]:
    """The scene on a real socket on 127.0.0.1, embedded in a page at `/`."""
    hub, viewers = LiveHub(), Viewers(maximum=max_viewers)

    @asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        await app.state.scene.start()
        yield
        await app.state.scene.stop()

    app = Starlette(routes=[Route("/", lambda _: HTMLResponse(PARENT))], lifespan=lifespan)
    mount_scene(
        app,
        hub=hub,
        setup=theatre.setup,
        surface=theatre.surface,
        stale_after_ms=stale_after_ms,
        admit=lambda person: viewers.register(ViewerKind.SCENE, person=person),
    )
    listener = socket.socket()
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.bind(("127.0.0.1", port))
    listener.listen()
    config = uvicorn.Config(app, log_config=None, timeout_graceful_shutdown=1, ws_per_message_deflate=False)
    server = uvicorn.Server(config)
    thread = threading.Thread(target=lambda: asyncio.run(server.serve(sockets=[listener])))
    thread.start()

    def stop() -> None:
        server.should_exit = True
        thread.join(timeout=20)
        listener.close()

    while not server.started and thread.is_alive():
        thread.join(timeout=0.01)
    try:
        yield Running(port=listener.getsockname()[1], hub=hub, app=app, stop=stop)
    finally:
        stop()

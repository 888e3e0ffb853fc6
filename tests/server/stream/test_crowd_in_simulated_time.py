"""Viewers in simulated time: the server's work does not grow with them, and none slows another."""

import asyncio
import dataclasses
from collections.abc import Callable
from typing import Any, cast

import pytest
from starlette.websockets import WebSocket

from server.live import Instant, LiveHub
from server.overlay import OverlayContent
from server.stream import live_socket, view_socket
from server.stream.live_socket import watch_live
from server.stream.scaling.message_cache import MessageCache
from server.stream.scaling.picture_cache import PictureCache
from server.stream.scaling.sizes import PictureSize, SizeChoice
from server.stream.view_socket import ViewContext, watch_view
from server.stream.viewers import ViewerKind, Viewers
from tests.server.stream.simulated_time import LoopTime, Page, run_in_made_time
from tracker.navigation import NavigationSnapshot

RATE_HZ = 30.0
SECONDS = 7.0
IMAGES = round(RATE_HZ * SECONDS)
THIN_BYTES_PER_S = 125_000.0
BYTES = {PictureSize.FULL: 130_000, PictureSize.HALF: 43_000, PictureSize.QUARTER: 14_000}


class MadePictures(PictureCache):
    """Pictures of the usual sizes without a thread; counts requests."""

    def __init__(self) -> None:
        super().__init__(quality=80)
        self.made: set[tuple[int, PictureSize]] = set()

    async def of(
        self,
        instant: Instant,
        size: PictureSize,
        content: OverlayContent = OverlayContent.FULL,  # noqa: ARG002  no part of the size
    ) -> bytes:
        self.made.add((instant.sequence, size))
        return b"\xff" * BYTES[size]


@dataclasses.dataclass
class Crowd:
    """The hub and its viewers."""

    view: ViewContext
    good: list[Page]
    thin: Page
    stalled: Page
    numbers: Page

    @property
    def pages(self) -> list[Page]:
        return [*self.good, self.thin, self.stalled]

    async def watch(self, template: Instant) -> None:
        tasks = [asyncio.create_task(watch_view(_socket(page), self.view)) for page in self.pages]
        view = self.view
        tasks.append(
            asyncio.create_task(
                watch_live(_socket(self.numbers), hub=view.hub, viewers=view.viewers, texts=view.texts)
            )
        )
        assert template.snapshot is not None
        for sequence in range(IMAGES):
            now_s = asyncio.get_running_loop().time()
            snapshot = dataclasses.replace(
                template.snapshot, image_number=sequence, captured_at_s=now_s, sightings={}, tools={}
            )
            view.hub.publish(dataclasses.replace(template, sequence=sequence, snapshot=snapshot))
            await asyncio.sleep(1.0 / RATE_HZ)
        self.watching = [view.viewers.count(kind) for kind in (ViewerKind.VIEW, ViewerKind.LIVE)]
        for task in tasks:
            task.cancel()
        await asyncio.wait(tasks)


def _socket(page: Page) -> WebSocket:
    return cast("WebSocket", cast("Any", page))


@pytest.fixture(scope="module")
def crowd(snapshot_of: Callable[..., NavigationSnapshot], instant_of: Callable[..., Instant]) -> Crowd:
    """Three pages on fast connections, one on 1 Mbit/s, one that reads nothing, one that reads numbers."""
    view = ViewContext(hub=LiveHub(), viewers=Viewers(), pictures=MadePictures(), texts=MessageCache())
    made: list[Crowd] = []

    async def run() -> None:
        crowd = Crowd(view, [Page() for _ in range(3)], Page(THIN_BYTES_PER_S), Page(0.0), Page(asks=False))
        await crowd.watch(instant_of(0, snapshot=snapshot_of(size_wh_px=(1280, 720))))
        made.append(crowd)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(view_socket, "time", LoopTime)
        patch.setattr(live_socket, "time", LoopTime)
        run_in_made_time(run())
    return made[0]


def numbers_of(page: Page) -> list[int]:
    return [message["snapshot"]["image_number"] for _, message in page.came]


def test_each_good_viewer_has_every_image_while_others_are_thin_or_stalled(crowd: Crowd) -> None:
    for page in (*crowd.good, crowd.numbers):
        assert numbers_of(page) == list(range(IMAGES))
        assert max(message["image_age_ms"] for _, message in page.came) < 1000.0 / RATE_HZ


def test_each_text_and_picture_is_made_once_for_all(crowd: Crowd) -> None:
    assert crowd.view.texts.serialised == IMAGES
    pictures = crowd.view.pictures
    assert isinstance(pictures, MadePictures)
    in_full = sum(size is PictureSize.FULL for _, size in pictures.made)
    smaller = [message for _, message in crowd.thin.came if message["shown_scale_ratio"] < 1.0]
    assert in_full == IMAGES
    # Only the requests of the slow connection.
    assert len(pictures.made) - in_full == len(smaller)


def test_only_the_stalled_viewer_is_disconnected_after_2_s(crowd: Crowd) -> None:
    viewers = crowd.view.viewers
    assert numbers_of(crowd.stalled) == [0]
    assert crowd.stalled.wire.cut_at_s == pytest.approx(2.0, abs=0.01)
    assert viewers.disconnected(ViewerKind.VIEW) == 1
    assert crowd.watching == [4, 1]
    assert all(page.wire.cut_at_s is None for page in (*crowd.good, crowd.thin, crowd.numbers))


def test_the_slow_connection_gets_small_pictures_that_are_young(crowd: Crowd) -> None:
    ratios = [message["shown_scale_ratio"] for _, message in crowd.thin.came]
    assert ratios == sorted(ratios, reverse=True)
    assert ratios[0] == 1.0
    settled = [came for came in crowd.thin.came if came[0] > 4.0]
    assert {message["shown_scale_ratio"] for _, message in settled} == {0.25}
    # Some 8 a second, each the newest when its transmission begins.
    assert len(settled) > (SECONDS - 4.0) * 6
    assert max(message["image_age_ms"] for _, message in settled) < 1000.0 / RATE_HZ


def test_a_viewer_on_a_slow_connection_who_insists_gets_full_pictures_rarely(
    live_instant: Callable[..., Instant], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(view_socket, "time", LoopTime)
    view = ViewContext(hub=LiveHub(), viewers=Viewers(), pictures=MadePictures(), texts=MessageCache())
    came: list[float] = []

    async def run() -> None:
        page = Page(THIN_BYTES_PER_S)
        watching = asyncio.create_task(watch_view(_socket(page), view, choice=SizeChoice.FULL))
        for sequence in range(IMAGES):
            view.hub.publish(live_instant(sequence))
            await asyncio.sleep(1.0 / RATE_HZ)
        watching.cancel()
        await asyncio.wait([watching])
        came.extend(message["shown_scale_ratio"] for _, message in page.came)

    run_in_made_time(run())
    # 130 kB over 1 Mbit/s take 1.04 s: slow but not stalled.
    assert came == [1.0] * 7
    assert view.viewers.disconnected(ViewerKind.VIEW) == 0

"""Each picture and each message is made once for all viewers, and only on demand."""

import asyncio
import dataclasses
import json
import time
from collections.abc import Callable

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from server.live import Instant
from server.overlay import OverlayContent, draw_overlay, encode_jpeg
from server.stream.messages import live_message
from server.stream.scaling.message_cache import MessageCache
from server.stream.scaling.picture_cache import PictureCache
from server.stream.scaling.sizes import PictureSize
from tracker.navigation import NavigationSnapshot

LiveInstant = Callable[..., Instant]
Image = npt.NDArray[np.uint8]


@pytest.fixture
def drawn(live_instant: LiveInstant, monkeypatch: pytest.MonkeyPatch) -> Instant:
    """An instant whose picture, even and grey, nobody has encoded."""
    picture = np.full((90, 160, 3), 77, np.uint8)
    monkeypatch.setattr("server.stream.scaling.picture_cache.draw_overlay", lambda *_, **_named: picture)
    return dataclasses.replace(live_instant(5), jpeg=b"", image=picture)


@pytest.fixture
def imaged(live_instant: LiveInstant) -> Instant:
    """An instant with its image, into which nothing has been drawn."""
    instant = live_instant(5)
    assert instant.snapshot is not None
    width, height = instant.snapshot.size_wh_px
    return dataclasses.replace(instant, jpeg=b"", image=np.full((height, width, 3), 77, np.uint8))


def size_px(jpeg: bytes) -> tuple[int, int]:
    decoded = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
    assert decoded is not None
    assert abs(float(decoded.mean()) - 77.0) < 1.0
    height, width = decoded.shape[:2]
    return width, height


async def all_of(pictures: PictureCache, instant: Instant, *sizes: PictureSize) -> list[bytes]:
    return await asyncio.gather(*(pictures.of(instant, size) for size in sizes))


def test_all_viewers_of_a_size_share_one_encoding(drawn: Instant) -> None:
    pictures = PictureCache(quality=80)
    got = asyncio.run(
        all_of(pictures, drawn, PictureSize.HALF, PictureSize.HALF, PictureSize.QUARTER, PictureSize.HALF)
    )
    assert [size_px(jpeg) for jpeg in got] == [(80, 45), (80, 45), (40, 22), (80, 45)]
    assert got[0] is got[1] is got[3]
    assert pictures.encoded == {PictureSize.FULL: 0, PictureSize.HALF: 1, PictureSize.QUARTER: 1}


def test_a_picture_that_is_there_already_is_not_encoded_again(live_instant: LiveInstant) -> None:
    pictures, instant = PictureCache(quality=80), live_instant(77)
    assert asyncio.run(all_of(pictures, instant, PictureSize.FULL))[0] is instant.jpeg
    assert size_px(asyncio.run(all_of(pictures, instant, PictureSize.HALF))[0]) == (80, 45)
    assert pictures.encoded[PictureSize.FULL] == 0


def test_a_late_viewer_gets_a_picture_that_was_not_encoded_before(drawn: Instant) -> None:
    assert size_px(asyncio.run(all_of(PictureCache(quality=80), drawn, PictureSize.FULL))[0]) == (160, 90)


def test_an_older_instant_does_not_throw_out_the_newest(drawn: Instant) -> None:
    pictures = PictureCache(quality=80)
    newer = dataclasses.replace(drawn, sequence=6)

    async def three() -> None:
        for instant in (newer, drawn, newer):
            await pictures.of(instant, PictureSize.HALF)

    asyncio.run(three())
    assert pictures.encoded[PictureSize.HALF] == 2


def test_an_image_is_drawn_once_for_all_sizes_and_its_stages_are_reported(
    imaged: Instant, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawings: list[int] = []

    def draw(image: Image, snapshot: NavigationSnapshot, *_: object, **_named: object) -> Image:
        drawings.append(snapshot.image_number)
        return image

    monkeypatch.setattr("server.stream.scaling.picture_cache.draw_overlay", draw)
    pictures, stages = PictureCache(quality=80), list[str]()
    pictures.observe_stage = lambda stage, _spent_s: stages.append(stage)
    asyncio.run(all_of(pictures, imaged, PictureSize.FULL, PictureSize.HALF, PictureSize.QUARTER))
    assert len(drawings) == 1
    assert (stages.count("overlay"), stages.count("encode")) == (1, 3)
    asyncio.run(all_of(pictures, dataclasses.replace(imaged, sequence=6), PictureSize.FULL))
    assert len(drawings) == 2, "an alarm between two images is drawn into the same image again"


def test_a_failing_overlay_is_reported_until_a_picture_can_be_drawn_again(
    imaged: Instant, monkeypatch: pytest.MonkeyPatch
) -> None:
    def draw(*_: object, **_named: object) -> Image:
        raise ZeroDivisionError("a bug")

    pictures = PictureCache(quality=80)
    with monkeypatch.context() as patch:
        patch.setattr("server.stream.scaling.picture_cache.draw_overlay", draw)
        assert asyncio.run(all_of(pictures, imaged, PictureSize.FULL)) == [b""]
        assert pictures.problem is not None
        assert pictures.problem.code == "OVERLAY_FAILED"
    assert asyncio.run(all_of(pictures, dataclasses.replace(imaged, sequence=6), PictureSize.FULL)) != [b""]
    assert pictures.problem is None


def test_a_viewer_gets_the_image_with_its_overlay(imaged: Instant) -> None:
    image = imaged.image
    full = asyncio.run(all_of(PictureCache(quality=80), imaged, PictureSize.FULL))[0]
    assert image is not None
    assert imaged.snapshot is not None
    expected = draw_overlay(image, imaged.snapshot, imaged.alarms)
    assert not np.array_equal(expected, image), "an overlay that draws nothing shows nothing here"
    assert full == encode_jpeg(expected, 80)
    assert np.array_equal(image, np.full_like(image, 77)), "the camera's image is never drawn into"


def test_each_overlay_content_has_its_own_picture(imaged: Instant) -> None:
    pictures = PictureCache(quality=80)

    async def both() -> list[bytes]:
        contents = (OverlayContent.FULL, OverlayContent.GEOMETRY, OverlayContent.FULL)
        return [await pictures.of(imaged, PictureSize.FULL, content) for content in contents]

    full, geometry, again = asyncio.run(both())
    assert full == again != geometry
    assert pictures.encoded[PictureSize.FULL] == 2
    assert imaged.image is not None
    assert imaged.snapshot is not None
    lines = draw_overlay(imaged.image, imaged.snapshot, imaged.alarms, content=OverlayContent.GEOMETRY)
    assert geometry == encode_jpeg(lines, 80)


def test_an_instant_without_picture_has_none_in_any_size(instant_of: LiveInstant) -> None:
    pictures = PictureCache(quality=80)
    assert asyncio.run(all_of(pictures, instant_of(1), *PictureSize)) == [b"", b"", b""]
    assert sum(pictures.encoded.values()) == 0


def test_a_text_is_written_once_and_is_true_at_each_sending(live_instant: LiveInstant) -> None:
    texts, instant = MessageCache(), live_instant(3)
    made_s = time.monotonic()
    texts.of(instant, now_s=made_s)
    for later_s, size in ((0.0, PictureSize.FULL), (0.7, PictureSize.QUARTER)):
        now_s = made_s + later_s
        said = json.loads(texts.of(instant, size=size, now_s=now_s))
        whole = json.loads(live_message(instant, now_s=now_s).model_dump_json())
        assert said == whole | {"shown_scale_ratio": size.scale_ratio}
    assert texts.serialised == 1


def test_a_text_without_image_is_whole_too(instant_of: LiveInstant) -> None:
    texts, instant = MessageCache(), instant_of(9)
    texts.of(instant, now_s=1.0)
    said = json.loads(texts.of(instant, now_s=4.5))
    assert said == json.loads(live_message(instant, now_s=4.5).model_dump_json())

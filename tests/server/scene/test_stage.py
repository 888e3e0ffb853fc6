"""What is drawn for an instant, decoded from the messages to a viewer."""

import asyncio
import pickle
from collections.abc import Callable, Coroutine
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from server.live import Instant
from server.scene.door import Door
from server.scene.stage import NUMBER_NODE, Stage
from tests.server.scene.packets import viser_messages
from tests.server.scene.scene_theatre import Theatre
from tracker.navigation import Absent, PlacedScrew, ScrewSize
from tracker.plan import Channel

Batch = list[dict[str, Any]]


class Viewer:
    """Collects sent messages, decoded as by the client."""

    def __init__(self) -> None:
        self.batches: asyncio.Queue[Batch] = asyncio.Queue()

    async def send(self, packet: bytes) -> None:
        self.batches.put_nowait(viser_messages(packet))


def on_stage(theatre: Theatre, play: Callable[[Stage, Viewer], Coroutine[Any, Any, None]]) -> None:
    """Play instants with one viewer watching from the start."""

    async def run() -> None:
        door = Door()
        stage = Stage(door, setup=theatre.setup, surface=theatre.surface)
        viewer = Viewer()
        serving = asyncio.create_task(door.serve(viewer.send))
        try:
            async with asyncio.timeout(20):
                await play(stage, viewer)
        finally:
            door.stop()
            await serving

    asyncio.run(run())


def of_kind(batch: Batch, kind: str, name: str) -> dict[str, Any] | None:
    found = [m for m in batch if m["type"] == kind and m["name"] == name]
    assert len(found) <= 1
    return found[0] if found else None


def number(batch: Batch) -> list[float]:
    moved = of_kind(batch, "SetPositionMessage", NUMBER_NODE)
    assert moved is not None
    return list(moved["position"][:2])


def test_pose_visibility_and_number_of_an_image_come_in_one_batch(theatre: Theatre) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        await viewer.batches.get()
        stage.show(theatre.instant(1, image_number=123456, tip_z_mm=20.0))
        batch = await viewer.batches.get()
        assert number(batch) == [124.0, 456.0]
        shown = of_kind(batch, "SetSceneNodeVisibilityMessage", "/setup_1/tool_0")
        assert shown is not None
        assert shown["visible"] is True
        moved = of_kind(batch, "SetPositionMessage", "/setup_1/tool_0")
        assert moved is not None
        channel = theatre.setup.channel
        assert isinstance(channel, Channel)
        expected = channel.entry_in_vertebra_mm - 20.0 * channel.axis_in_vertebra
        np.testing.assert_allclose(moved["position"], expected, atol=1e-6)

    on_stage(theatre, play)


@pytest.mark.parametrize(
    "last",
    [
        pytest.param(lambda t: t.instant(2, image_number=8, seen=False), id="the marker is not seen"),
        pytest.param(lambda t: t.instant(2, image_number=None), id="there is no image"),
    ],
)
def test_a_drill_is_hidden_in_the_batch_that_lacks_it(
    theatre: Theatre, last: Callable[[Theatre], Instant]
) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        stage.show(theatre.instant(1, image_number=7))
        await viewer.batches.get()
        instant = last(theatre)
        stage.show(instant)
        batch = await viewer.batches.get()
        hidden = of_kind(batch, "SetSceneNodeVisibilityMessage", "/setup_1/tool_0")
        assert hidden is not None
        assert hidden["visible"] is False
        assert number(batch) == ([0.0, 0.0] if instant.snapshot is None else [1.0, 8.0])

    on_stage(theatre, play)


def test_each_image_is_reported_however_high_its_number(theatre: Theatre) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        for sequence, image in enumerate((999, 1000, 99_999, 100_000, 100_001, 5_000_000, 5_000_001)):
            stage.show(theatre.instant(sequence, image_number=image, seen=False))
            batch = await viewer.batches.get()
            assert (number(batch)[0] - 1) * 1000 + number(batch)[1] == image

    on_stage(theatre, play)


def test_only_what_changed_is_sent(theatre: Theatre) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        stage.show(theatre.instant(1, image_number=1, tip_z_mm=20.0))
        await viewer.batches.get()
        stage.show(theatre.instant(2, image_number=2, tip_z_mm=20.0))
        batch = await viewer.batches.get()
        assert [(m["type"], m["name"]) for m in batch] == [("SetPositionMessage", NUMBER_NODE)]

    on_stage(theatre, play)


def test_silence_is_still_heard(theatre: Theatre) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        await viewer.batches.get()
        for _ in range(3):
            stage.show_nothing()
            assert len(await viewer.batches.get()) == 1

    on_stage(theatre, play)


def test_a_copy_of_the_same_setup_rebuilds_nothing(theatre: Theatre) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        await viewer.batches.get()
        stage.show(pickle.loads(pickle.dumps(theatre.instant(1, image_number=1))))  # noqa: S301 our own object
        batch = await viewer.batches.get()
        assert not [
            m for m in batch if m["type"] in ("MeshMessage", "CylinderMessage", "RemoveSceneNodeMessage")
        ]

    on_stage(theatre, play)


def test_before_registration_neither_bone_nor_channel_is_drawn(theatre: Theatre) -> None:
    before = theatre.unregistered()

    async def play(_: Stage, viewer: Viewer) -> None:
        batch = await viewer.batches.get()
        nodes = {m.get("name") for m in batch if m["type"].endswith(("MeshMessage", "CylinderMessage"))}
        assert "/setup_1/vertebra" not in nodes
        assert "/setup_1/channel" not in nodes
        assert "/setup_1/tool_0/shaft" in nodes
        assert of_kind(batch, "CameraFrustumMessage", "/setup_1/camera") is not None

    on_stage(before, play)


def test_registration_brings_bone_and_channel_and_moves_to_the_vertebras_frame(theatre: Theatre) -> None:
    before = theatre.unregistered()
    assert isinstance(before.setup.registration, Absent)

    async def play(stage: Stage, viewer: Viewer) -> None:
        await viewer.batches.get()
        stage.show(theatre.instant(1, image_number=3))
        batch = await viewer.batches.get()
        assert of_kind(batch, "MeshMessage", "/setup_2/vertebra") is not None
        assert of_kind(batch, "CylinderMessage", "/setup_2/channel") is not None
        assert number(batch) == [1.0, 3.0]
        assert of_kind(batch, "RemoveSceneNodeMessage", "/setup_1") is not None
        camera = of_kind(batch, "SetPositionMessage", "/setup_2/camera")
        assert camera is not None
        np.testing.assert_allclose(camera["position"], [0.0, 400.0, 0.0], atol=1e-6)

    on_stage(before, play)


def test_the_planned_screw_lies_in_its_channel_from_the_entry_on(theatre: Theatre) -> None:
    screwed = replace(theatre, setup=replace(theatre.setup, screw=ScrewSize(radius_mm=2.5, length_mm=30.0)))

    async def play(stage: Stage, viewer: Viewer) -> None:
        batch = await viewer.batches.get()
        assert of_kind(batch, "CylinderMessage", "/setup_1/screw") is None
        stage.show(screwed.instant(1, image_number=3))
        batch = await viewer.batches.get()
        screw = of_kind(batch, "CylinderMessage", "/setup_2/screw")
        assert screw is not None
        assert (screw["props"]["radius"], screw["props"]["height"]) == (2.5, 30.0)
        place = of_kind(batch, "SetPositionMessage", "/setup_2/screw")
        assert place is not None
        channel = theatre.setup.channel
        assert isinstance(channel, Channel)
        middle = channel.entry_in_vertebra_mm + 15.0 * channel.axis_in_vertebra
        np.testing.assert_allclose(place["position"], middle, atol=1e-4)

    on_stage(theatre, play)


def test_a_placed_screw_lies_where_it_was_placed(theatre: Theatre) -> None:
    head, tip = np.array([10.0, 12.0, 1.0]), np.array([4.0, -20.0, 3.0])
    placed = PlacedScrew(name="L3 right", head_in_vertebra_mm=head, tip_in_vertebra_mm=tip, radius_mm=2.75)
    later = replace(theatre, setup=replace(theatre.setup, placed_screws=(placed,)))

    async def play(stage: Stage, viewer: Viewer) -> None:
        await viewer.batches.get()
        stage.show(later.instant(1, image_number=3))
        batch = await viewer.batches.get()
        screw = of_kind(batch, "CylinderMessage", "/setup_2/placed_0")
        assert screw is not None
        assert screw["props"]["radius"] == 2.75
        assert screw["props"]["height"] == pytest.approx(np.linalg.norm(tip - head))
        place = of_kind(batch, "SetPositionMessage", "/setup_2/placed_0")
        turn = of_kind(batch, "SetOrientationMessage", "/setup_2/placed_0")
        assert place is not None
        assert turn is not None
        np.testing.assert_allclose(place["position"], (head + tip) / 2, atol=1e-4)
        w, x, y, z = turn["wxyz"]
        along = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
        np.testing.assert_allclose(along, (tip - head) / np.linalg.norm(tip - head), atol=1e-4)

    on_stage(theatre, play)


def test_a_setup_that_returns_is_at_its_first_place(theatre: Theatre) -> None:
    """A reused name would keep its old pose in a viewer, so names are unique."""
    before = theatre.unregistered()

    async def play(stage: Stage, viewer: Viewer) -> None:
        batches = [await viewer.batches.get()]
        for sequence, now in enumerate((theatre, before, theatre)):
            stage.show(now.instant(sequence, image_number=sequence, seen=False))
            batches.append(await viewer.batches.get())
        made = [m["name"] for batch in batches for m in batch if m["type"] == "CameraFrustumMessage"]
        assert made == [f"/setup_{generation}/camera" for generation in (1, 2, 3, 4)]

    on_stage(before, play)


def test_who_comes_late_gets_the_whole_scene_as_it_is_now(theatre: Theatre) -> None:
    async def run() -> None:
        door = Door()
        stage = Stage(door, setup=theatre.setup, surface=theatre.surface)
        for sequence in range(200):
            stage.show(theatre.instant(sequence, image_number=sequence, tip_z_mm=sequence * 0.1))
        viewer = Viewer()
        serving = asyncio.create_task(door.serve(viewer.send))
        async with asyncio.timeout(20):
            batch = await viewer.batches.get()
        assert number(batch) == [1.0, 199.0]
        assert of_kind(batch, "MeshMessage", "/setup_1/vertebra") is not None
        assert batch[-1]["type"] == "ReplayDoneMessage"
        door.stop()
        await serving

    asyncio.run(run())


def test_no_handler_of_viser_can_be_reached(theatre: Theatre) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        await viewer.batches.get()
        door = stage._door
        assert door._websock_server._incoming_handlers == {}
        with pytest.raises(PermissionError):
            door.request_share_url()

    on_stage(theatre, play)

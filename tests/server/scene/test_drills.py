"""Ellipsoid, cone and trace follow their drill, and disappear in the first image without them."""

import dataclasses

import numpy as np

from server.live import Instant
from server.scene.drills import MIN_MM
from server.scene.stage import Stage
from tests.server.scene.scene_theatre import Theatre, block
from tests.server.scene.test_stage import Viewer, of_kind, on_stage
from tracker.navigation import Absent, AbsentReason, DrillReference, VertebraPose, navigate
from tracker.navigation.uncertainty import DrillAnalysis
from tracker.plan import Channel
from tracker.pose import Unseen, UnseenReason

PARTS = ("/setup_1/tool_0", "/setup_1/tool_0/cone", "/setup_1/tool_0_at/tip", "/setup_1/tool_0_trace")


def judged(
    theatre: Theatre, number: int, *, at_s: float, tip_z_mm: float = 0.0, seen: bool = True
) -> Instant:
    channel = theatre.setup.channel
    assert isinstance(channel, Channel)
    snapshot = navigate(
        setup=theatre.setup,
        sightings={"drill": theatre.sighting(tip_z_mm) if seen else Unseen(reason=UnseenReason.NO_CANDIDATE)},
        image_number=number,
        captured_at_s=at_s,
        size_wh_px=(1280, 720),
        stage_ms={},
        skipped_images=0,
        drill_reference=DrillReference.of_channel(channel),
    )
    return dataclasses.replace(theatre.instant(number, image_number=number), snapshot=snapshot)


async def seen_in(viewer: Viewer, shown: dict[str, bool]) -> dict[str, bool]:
    for message in await viewer.batches.get():
        if message["type"] == "SetSceneNodeVisibilityMessage":
            shown[message["name"]] = message["visible"]
    return shown


def test_all_of_a_drill_is_there_and_goes_in_one_image(theatre: Theatre) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        await viewer.batches.get()
        shown: dict[str, bool] = {}
        for number in range(3):
            stage.show(judged(theatre, number, at_s=0.2 * number, tip_z_mm=10.0 - number))
            await seen_in(viewer, shown)
        assert all(shown[part] for part in PARTS)
        stage.show(judged(theatre, 3, at_s=0.6, seen=False))
        await seen_in(viewer, shown)
        assert not any(shown[part] for part in PARTS)

    on_stage(theatre, play)


def test_nothing_is_left_when_the_patient_is_not_seen(theatre: Theatre) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        await viewer.batches.get()
        shown: dict[str, bool] = {}
        for number in range(2):
            stage.show(judged(theatre, number, at_s=0.2 * number))
            await seen_in(viewer, shown)
        instant = judged(theatre, 2, at_s=0.4)
        assert instant.snapshot is not None
        gone = Absent(reason=AbsentReason.REFERENCE_UNSEEN)
        snapshot = dataclasses.replace(
            instant.snapshot, vertebra=gone, deviations={"drill": gone}, analyses={"drill": gone}
        )
        stage.show(dataclasses.replace(instant, snapshot=snapshot))
        await seen_in(viewer, shown)
        assert not any(shown[part] for part in PARTS)

    on_stage(theatre, play)


def test_the_ellipsoid_has_the_size_and_the_place_of_the_tips_spread(theatre: Theatre) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        await viewer.batches.get()
        instant = judged(theatre, 0, at_s=0.0, tip_z_mm=5.0)
        stage.show(instant)
        batch = await viewer.batches.get()
        assert instant.snapshot is not None
        reported = instant.snapshot.analyses["drill"]
        assert isinstance(reported, DrillAnalysis)
        moved = of_kind(batch, "SetPositionMessage", PARTS[2])
        frame = of_kind(batch, "SetPositionMessage", PARTS[0])
        assert moved is not None
        assert frame is not None
        assert moved["position"] == frame["position"]
        scaled = [m for m in batch if m["type"] == "SceneNodeUpdateMessage" and m["name"] == PARTS[2]]
        np.testing.assert_allclose(
            scaled[0]["updates"]["scale"],
            np.maximum(np.linalg.norm(reported.spread.tip_ellipsoid_mm, axis=1), MIN_MM),
            rtol=1e-6,
        )

    on_stage(theatre, play)


def test_another_bone_takes_the_place_of_the_first(theatre: Theatre) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        await viewer.batches.get()
        stage.show(judged(theatre, 0, at_s=0.0))
        await viewer.batches.get()
        stage.show_surface(block((0.0, 0.0, 0.0), (5.0, 5.0, 5.0)))
        batch = await viewer.batches.get()
        assert [
            m["name"] for m in batch if m["type"] == "MeshMessage" and m["name"].endswith("/vertebra")
        ] == ["/setup_2/vertebra"]
        stage.show(judged(theatre, 1, at_s=0.1))
        shown = await seen_in(viewer, {})
        assert shown["/setup_2/tool_0"]

    on_stage(theatre, play)


def test_views_are_reported_for_the_channel_and_the_camera(theatre: Theatre) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        batch = await viewer.batches.get()
        channel = theatre.setup.channel
        assert isinstance(channel, Channel)
        eye, look = (
            of_kind(batch, "SetPositionMessage", f"/views/channel_{part}") for part in ("eye", "look")
        )
        assert eye is not None
        assert look is not None
        way = np.array(look["position"]) - eye["position"]
        np.testing.assert_allclose(way / np.linalg.norm(way), channel.axis_in_vertebra, atol=1e-6)
        instant = judged(theatre, 0, at_s=0.0)
        stage.show(instant)
        batch = await viewer.batches.get()
        eye = of_kind(batch, "SetPositionMessage", "/views/camera_eye")
        assert eye is not None
        assert instant.snapshot is not None
        vertebra = instant.snapshot.vertebra
        assert isinstance(vertebra, VertebraPose)
        in_camera = vertebra.camera_from_vertebra.move_points(np.array(eye["position"]))
        np.testing.assert_allclose(in_camera[:2], 0.0, atol=1e-6)
        assert in_camera[2] > 0.0

    on_stage(theatre, play)

"""Marks on cuts in the scene: their places in the vertebra, and what is sent of them."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from server.live import Instant
from server.scene.marks import COLOURS, segments_in_vertebra_mm
from server.scene.stage import Stage
from server.security import Person, Role
from server.supervision.marks import CutPlane, Drawing, Moment, Pointer, Shape
from tests.server.scene.scene_theatre import Theatre
from tests.server.scene.test_stage import Batch, Viewer, of_kind, on_stage

SATO = Person(id="s1", name="Dr Sato", role=Role.SUPERVISOR)
MOMENT = Moment(image_number=1, captured_at_s=1.0)
# x is the patient's left, y the feet.
CORONAL = CutPlane(
    ct_id="ct-1",
    origin_in_vertebra_mm=(10.0, 20.0, 30.0),
    right_in_vertebra=(1.0, 0.0, 0.0),
    down_in_vertebra=(0.0, 0.0, -1.0),
)
NODE = "/setup_1/marks_3"


def drawing(shape: Shape, *points: tuple[float, float], plane: CutPlane | None = CORONAL) -> Drawing:
    return Drawing(
        key="3-1",
        session=3,
        person=SATO,
        shape=shape,
        moment=MOMENT,
        plane=plane,
        points=list(points),
    )


def pointer(at: tuple[float, float]) -> Pointer:
    return Pointer(session=3, person=SATO, at=at, plane=CORONAL, moment=MOMENT, moved_at_s=1.0)


def test_a_pen_line_is_in_the_patient_where_it_was_drawn() -> None:
    segments = segments_in_vertebra_mm(drawing(Shape.PEN, (0, 0), (5, 0), (5, 8)))
    np.testing.assert_allclose(segments, [[[10, 20, 30], [15, 20, 30]], [[15, 20, 30], [15, 20, 22]]])


@pytest.mark.parametrize("mark", [drawing(Shape.PEN, (5, 8)), pointer((5, 8))], ids=["point", "pointer"])
def test_a_point_is_a_cross(mark: Drawing | Pointer) -> None:
    segments = segments_in_vertebra_mm(mark)
    np.testing.assert_allclose(segments.mean(axis=1), [[15, 20, 22]] * 3)
    np.testing.assert_allclose(np.diff(segments, axis=1)[:, 0], 3.0 * np.eye(3))


def test_a_circle_is_in_its_plane_about_its_first_point() -> None:
    places = segments_in_vertebra_mm(drawing(Shape.CIRCLE, (1, 2), (4, 6))).reshape(-1, 3)
    np.testing.assert_allclose(np.linalg.norm(places - [11, 20, 28], axis=1), 5.0)
    np.testing.assert_allclose(places[:, 1], 20.0)


def test_an_arrow_has_a_head_at_its_second_point() -> None:
    shaft, *head = segments_in_vertebra_mm(drawing(Shape.ARROW, (0, 0), (20, 0)))
    np.testing.assert_allclose(shaft, [[10, 20, 30], [30, 20, 30]])
    np.testing.assert_allclose([head[0][1], head[1][0]], [[30, 20, 30]] * 2)
    np.testing.assert_allclose([np.linalg.norm(np.diff(side, axis=0)) for side in head], 3.0)


def test_colours_are_those_of_the_page() -> None:
    source = Path(__file__).parents[3] / "web" / "src" / "marks" / "colours.ts"
    page = re.findall(r"#([0-9a-f]{6})", source.read_text(encoding="utf-8"))
    assert [tuple(bytes.fromhex(one)) for one in page] == list(COLOURS)


def has_new_points(batch: Batch) -> bool:
    changed = of_kind(batch, "SceneNodeUpdateMessage", NODE)
    return changed is not None and "points" in changed["updates"]


def on_ct(theatre: Theatre, sequence: int, ct_id: str = "ct-1") -> Instant:
    instant = theatre.instant(sequence, image_number=sequence)
    assert instant.snapshot is not None
    shown = replace(instant.snapshot, setup=replace(instant.snapshot.setup, ct_id=ct_id))
    return replace(instant, snapshot=shown)


def is_visible(batch: Batch) -> bool | None:
    changed = of_kind(batch, "SetSceneNodeVisibilityMessage", NODE)
    return None if changed is None else bool(changed["visible"])


def test_marks_are_drawn_once_and_disappear(theatre: Theatre) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        await viewer.batches.get()
        line = drawing(Shape.PEN, (0, 0), (5, 0))
        stage.show(on_ct(theatre, 1), [line])
        first = await viewer.batches.get()
        assert (has_new_points(first), is_visible(first)) == (True, True)
        stage.show(on_ct(theatre, 2), [line])
        again = await viewer.batches.get()
        assert not [one for one in again if one.get("name") == NODE]
        line.points.append((5, 8))
        stage.show(on_ct(theatre, 3), [line])
        assert has_new_points(await viewer.batches.get())
        stage.show(on_ct(theatre, 4), [])
        assert is_visible(await viewer.batches.get()) is False

    on_stage(theatre, play)


@pytest.mark.parametrize("how", ["another-ct", "no-image"])
def test_marks_are_hidden_with_what_they_belong_to(theatre: Theatre, how: str) -> None:
    async def play(stage: Stage, viewer: Viewer) -> None:
        await viewer.batches.get()
        line = drawing(Shape.PEN, (0, 0), (5, 0))
        stage.show(on_ct(theatre, 1), [line])
        await viewer.batches.get()
        if how == "another-ct":
            stage.show(on_ct(theatre, 2, "ct-2"), [line])
        else:
            stage.show_nothing()
        assert is_visible(await viewer.batches.get()) is False

    on_stage(theatre, play)

"""The scene shows the bone of the case whose channel is drilled, and no other."""

import queue
from collections.abc import Iterator
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest

from server.imaging.meshes import ply_from_surface
from server.procedure.plan import ACTIVE_CHANNEL
from server.procedure.scene_bone import SceneBone
from server.procedure.surface import MAIN_SURFACE
from server.store import CaseStore, DocumentKind, Home
from tracker.plan import Surface

Shown: TypeAlias = "queue.Queue[Surface | None]"


def ball(radius_mm: float) -> Surface:
    """Eight faces."""
    corners = np.vstack([np.eye(3), -np.eye(3)]) * radius_mm
    faces = [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)]
    return Surface(vertices_mm=corners, faces=np.array(faces, dtype=np.int64))


OWN = ball(20.0)


@pytest.fixture
def store(tmp_path: Path) -> Iterator[CaseStore]:
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        yield store


@pytest.fixture
def shown(store: CaseStore) -> Shown:
    """What was shown, one after the other."""
    seen: Shown = queue.Queue()
    SceneBone(store, seen.put, own=OWN)
    assert seen.empty()
    return seen


def opened(store: CaseStore) -> str:
    case = store.create("one")
    store.open(case.id)
    return case.id


def plan(store: CaseStore, case_id: str) -> None:
    store.put(case_id, DocumentKind.PLAN, ACTIVE_CHANNEL, {}, made_by="ito")


def keep_surface(store: CaseStore, case_id: str, content: bytes) -> None:
    with store.new_file(case_id, ".ply") as new:
        new.path.write_bytes(content)
    files = [new.stored.id]
    store.put(case_id, DocumentKind.SURFACE, MAIN_SURFACE, {}, made_by="ito", files=files)


def test_the_bone_of_the_case_comes_with_its_channel_and_goes_with_its_case(
    store: CaseStore, shown: Shown
) -> None:
    case_id = opened(store)
    keep_surface(store, case_id, ply_from_surface(ball(33.0)))
    assert shown.empty(), "nothing of this case is drilled yet"
    plan(store, case_id)
    bone = shown.get(timeout=20)
    assert bone is not None
    np.testing.assert_allclose(np.abs(bone.vertices_mm).max(), 33.0)
    store.close()
    assert shown.get(timeout=20) is OWN


def test_a_channel_without_a_bone_is_not_shown_in_somebody_elses(store: CaseStore, shown: Shown) -> None:
    plan(store, opened(store))
    assert shown.get(timeout=20) is None


def test_a_bone_that_cannot_be_read_is_none(store: CaseStore, shown: Shown) -> None:
    case_id = opened(store)
    plan(store, case_id)
    assert shown.get(timeout=20) is None
    keep_surface(store, case_id, b"no surface at all")
    assert shown.get(timeout=20) is None


def test_unrelated_changes_read_nothing_again(store: CaseStore, shown: Shown) -> None:
    case_id = opened(store)
    keep_surface(store, case_id, ply_from_surface(ball(33.0)))
    plan(store, case_id)
    assert shown.get(timeout=20) is not None
    store.put(case_id, DocumentKind.TOOL, "drill", {}, made_by="ito")
    assert shown.empty()

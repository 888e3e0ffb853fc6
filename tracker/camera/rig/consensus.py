"""Relative camera poses by consensus over instants, and the outlier instants."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracker.camera.calibration.fit import board_pose
from tracker.camera.detection.view import BoardView, PlacementAmbiguity
from tracker.camera.model import CameraModel
from tracker.errors import CalibrationError
from tracker.geometry import Array, Camera, Pattern, Rigid

MIN_PAIRS = 3
# Maximum deviation of a pair's relative pose from the consensus: rotation, and translation as a ratio of the
# board's distance.
MAX_TURN_DEG, MAX_SHIFT_RATIO = 3.0, 0.04
MAX_OUT_RATIO = 0.34

Shot = Mapping[str, BoardView]


@dataclass(frozen=True, slots=True, kw_only=True)
class PosedView:
    """A board in one camera at one instant, and its pose."""

    view: BoardView
    camera_from_pattern: Rigid[Camera, Pattern]


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """Consensus of the instants.

    Attributes:
        camera_from_first: by camera.
        shots: for each instant, by camera, the inlier views, in their resolved orientation.
        reasons: for each instant why something is left out, or an empty string.
    """

    camera_from_first: dict[str, Rigid[Camera, Camera]]
    shots: tuple[dict[str, PosedView], ...]
    reasons: tuple[str, ...]


# Index of the instant, view of the far camera, its relative pose, and distance of the board.
Way = tuple[int, PosedView, Rigid[Camera, Camera], float]


def agreement(shots: Sequence[Shot], models: Mapping[str, CameraModel]) -> Agreement:
    """Return the poses of all cameras relative to the first, chained over pairs with most common instants.

    Raises:
        CalibrationError: RIG_UNCONNECTED or RIG_VIEWS_DISAGREE.
    """
    cameras = list(models)
    retained: list[dict[str, PosedView]] = []
    reasons = [""] * len(shots)
    for index, shot in enumerate(shots):
        posed = {name: _posed(view, models[name]) for name, view in shot.items()}
        retained.append({name: one for name, one in posed.items() if one is not None})
        unsure = [name for name, one in posed.items() if one is None]
        if unsure:
            reasons[index] = f"which part of the board {', '.join(unsure)} sees is ambiguous"
    places: dict[str, Rigid[Camera, Camera]] = {cameras[0]: Rigid.identity()}
    whole = _whole_board(retained)
    while len(places) < len(cameras):
        counts = {
            (near, far): sum(near in shot and far in shot for shot in retained)
            for near in places
            for far in cameras
            if far not in places
        }
        near, far = max(counts, key=lambda pair: counts[pair])
        if counts[near, far] < MIN_PAIRS:
            raise CalibrationError(
                "RIG_UNCONNECTED",
                f"{far} sees the board together with another camera in {counts[near, far]} views, at least "
                f"{MIN_PAIRS} are needed",
                "Take views in which both cameras see the board at the same time.",
                {"camera": far, "views": counts[near, far], "min_pairs": MIN_PAIRS},
            )
        far_from_near, odd = _place(retained, near, far, whole)
        _reject_disagreement(near, far, len(odd), counts[near, far])
        for index in odd:
            del retained[index][far]
            reasons[index] = (
                f"{far} does not see the board where {near} does (off the rest by more than "
                f"{MAX_TURN_DEG:g} deg or {100 * MAX_SHIFT_RATIO:g} %): wrong pair, or other order"
            )
        places[far] = far_from_near @ places[near]
    return Agreement(camera_from_first=places, shots=tuple(retained), reasons=tuple(reasons))


def _place(
    retained: list[dict[str, PosedView]], near: str, far: str, whole: tuple[Array, int]
) -> tuple[Rigid[Camera, Camera], list[int]]:
    """Return the pose of one camera relative to another by most votes, and the outlier instants."""
    ways: list[Way] = []
    for index, shot in enumerate(retained):
        if near not in shot or far not in shot:
            continue
        turnable = PlacementAmbiguity.HALF_TURN in (shot[near].view.ambiguity, shot[far].view.ambiguity)
        for other in (shot[far], *([_turned(shot[far], whole)] if turnable else [])):
            relation = other.camera_from_pattern @ shot[near].camera_from_pattern.inverse
            ways.append((index, other, relation, _distance_mm(shot[near])))
    agree = [[_is_near(one[2], two[2], one[3]) for two in ways] for one in ways]
    votes = [sum(row) for row in agree]
    # Among equal votes, the pose nearest to the others is selected.
    middle = [
        sum(float(np.linalg.norm(one[2].translation_mm - two[2].translation_mm)) for two in _of(ways, row))
        for one, row in zip(ways, agree, strict=True)
    ]
    best = min(range(len(ways)), key=lambda at: (-votes[at], middle[at]))
    fitting = {ways[at][0]: ways[at][1] for at in range(len(ways)) if agree[best][at]}
    for index, other in fitting.items():
        retained[index][far] = other
    return ways[best][2], sorted({way[0] for way in ways} - set(fitting))


def _of(ways: list[Way], row: list[bool]) -> list[Way]:
    return [way for way, agrees in zip(ways, row, strict=True) if agrees]


def _is_near(one: Rigid[Camera, Camera], two: Rigid[Camera, Camera], distance_mm: float) -> bool:
    off = one @ two.inverse
    cosine = np.clip((np.trace(off.rotation) - 1.0) / 2.0, -1.0, 1.0)
    shift = float(np.linalg.norm(one.translation_mm - two.translation_mm))
    return bool(np.degrees(np.arccos(cosine)) <= MAX_TURN_DEG and shift <= MAX_SHIFT_RATIO * distance_mm)


def _posed(view: BoardView, model: CameraModel) -> PosedView | None:
    if view.ambiguity is PlacementAmbiguity.PLACE:
        return None
    pose = board_pose(view, model.matrix, model.distortion)
    return None if pose is None else PosedView(view=view, camera_from_pattern=Rigid.from_vector(*pose))


def _whole_board(retained: Sequence[Mapping[str, PosedView]]) -> tuple[Array, int]:
    """Return the far corner of the board in mm and its last id, over all views."""
    views = [one.view for shot in retained for one in shot.values()]
    if not views:
        return np.zeros(3), 0
    corner = np.max([view.object_points_mm.max(axis=0) for view in views], axis=0)
    return np.asarray(corner), max(int(view.ids.max()) for view in views)


def _turned(seen: PosedView, whole: tuple[Array, int]) -> PosedView:
    """Return the view with the board rotated by half a turn."""
    corner, last = whole
    view = replace(seen.view, ids=last - seen.view.ids, object_points_mm=corner - seen.view.object_points_mm)
    half: Rigid[Pattern, Pattern] = Rigid(rotation=np.diag([-1.0, -1.0, 1.0]), translation_mm=corner)
    return PosedView(view=view, camera_from_pattern=seen.camera_from_pattern @ half)


def _distance_mm(seen: PosedView) -> float:
    middle = seen.view.object_points_mm.mean(axis=0)
    pose = seen.camera_from_pattern
    return float(np.linalg.norm(pose.rotation @ middle + pose.translation_mm))


def _reject_disagreement(near: str, far: str, odd: int, count: int) -> None:
    if count - odd >= MIN_PAIRS and odd <= MAX_OUT_RATIO * count:
        return
    raise CalibrationError(
        "RIG_VIEWS_DISAGREE",
        f"{odd} of {count} views place {far} elsewhere to {near} than the rest, allowed is a third of them",
        "Check that images of both cameras are of the same instant, that no camera was moved, and "
        "that the board has a unique orientation.",
        {"views": count, "disagree": odd, "cameras": [near, far]},
    )

"""Distractors are found at their position, and the design avoids them."""

import itertools

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from tests.tracker.scenes import Print, camera_of, code_image, code_model, facing_at_px, rendered
from tracker import MarkerModel
from tracker.design import (
    Background,
    MarkerAssessment,
    assess_marker,
    best_design,
    concatenated,
    places_in,
    precision_of,
    proposed_shapes,
    rendered_face,
)
from tracker.geometry import Camera, Marker, Rigid, rotation_from_vector
from tracker.marker import ScoreSettings

Picture = npt.NDArray[np.uint8]
SETTINGS = ScoreSettings()
CAMERA = camera_of((400, 300))


def background_of(*images: Picture) -> Background:
    places = concatenated([places_in(image, image_index=k) for k, image in enumerate(images)])
    return Background(images=images, places=places, camera_of=camera_of)


def scene(*pictures: Picture) -> Picture:
    """Printed squares side by side on a desk with a few other things."""
    service = np.full((300, 400), 150.0)
    cv2.rectangle(service, (20, 20), (120, 70), 60.0, -1)
    cv2.circle(service, (340, 60), 30, 230.0, -1)
    prints = [
        Print(picture=picture, pose=facing_at_px(CAMERA, (80 + 110 * k, 190), 60.0, tilt_deg=15.0))
        for k, picture in enumerate(pictures)
    ]
    return rendered(CAMERA, prints, background=service)


def judged(model: MarkerModel, background: Background | None) -> MarkerAssessment:
    return assess_marker(model, background, SETTINGS, advance=lambda: None)


def test_a_background_that_contains_the_marker_is_reported_with_its_position() -> None:
    found = judged(code_model(), background_of(scene(), scene(code_image())))
    assert not found.unique
    assert [claim.image_index for claim in found.search.claims] == [1]
    assert found.nearest[0].image_index == 1
    assert found.nearest[0].corners_px.mean(axis=0) == pytest.approx([80, 190], abs=3)
    # Its own top, and not that of a turn of it.
    assert found.nearest[0].corners_px == pytest.approx(found.search.claims[0].corners_px, abs=4)
    assert found.best_false_score_ratio > 0.9


def test_a_background_without_similar_squares_has_no_claims() -> None:
    found = judged(code_model(), background_of(scene()))
    assert found.images == 1
    assert not found.search.claims
    assert not any(place.score.accepted for place in found.nearest)


def test_every_image_is_searched_and_advances_the_progress() -> None:
    images: list[int] = []
    assess_marker(
        code_model(), background_of(scene(), scene(), scene()), SETTINGS, advance=lambda: images.append(1)
    )
    assert len(images) == 3


def test_a_marker_that_equals_its_mirror_image_is_not_unique() -> None:
    found = judged(code_model(((1, 0, 1), (1, 1, 1), (0, 1, 0))), None)
    assert found.mirrored.accepted
    assert found.mirrored.score_ratio > 0.95
    assert not found.rotated.accepted
    assert not found.unique
    assert found.own_correlation > 0.99
    assert (found.images, found.nearest) == (0, ())


def test_a_marker_is_not_compared_with_itself_as_it_is() -> None:
    found = judged(code_model(), None)
    assert found.own_correlation < 0.9
    assert max(found.rotated.score_ratio, found.mirrored.score_ratio) < 0.95


def test_a_marker_that_nearly_equals_its_half_turn_is_not_unique() -> None:
    picture = code_image(((1, 1, 0), (0, 1, 0), (0, 1, 1)))
    picture[30:42, 70:82] = 255  # of a field of 20 px, so that it is not an exact symmetry, which is rejected
    found = judged(MarkerModel.from_image(picture, side_mm=25.0, name="s"), None)
    assert found.rotated.accepted
    assert not found.unique


@pytest.mark.parametrize("scored", [1, 40], ids=["by-correlation", "by-score"])
def test_the_design_avoids_shapes_in_the_background(scored: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tracker.design.design.MAX_SCORED", scored)
    shapes = list(itertools.islice(proposed_shapes(7), 4))
    alone = best_design(shapes, None, SETTINGS, side_mm=25.0, name="m", advance=lambda: None)
    background = background_of(scene(rendered_face(alone.shape, 200)))
    other = best_design(shapes, background, SETTINGS, side_mm=25.0, name="m", advance=lambda: None)
    assert other.shape is not alone.shape
    shown = judged(alone.model, background)
    assert shown.search.claims
    assert other.assessment.best_false_score_ratio < shown.best_false_score_ratio
    assert not other.assessment.search.claims
    again = judged(other.model, background).search
    assert other.assessment.search.best_score_ratio == again.best_score_ratio > 0.0
    assert other.assessment.images == 1


def test_precision_equals_finite_differences_of_a_camera() -> None:
    model = code_model(side_mm=1.0)
    active = model.level_for(27.0)
    camera = camera_of(focal_px=27.0 * 20.0, distortion=(0.0,) * 5)
    flat = np.column_stack([active.points_mm, np.zeros(len(active.points_mm))])
    weight = active.length_mm * 27.0 * active.strength_ratio**2 / (4 / 160) ** 2 / np.sqrt(4 * np.pi)
    variances = []
    for about in np.radians(np.arange(0, 360, 30)):
        turn = rotation_from_vector(np.array([np.cos(about), np.sin(about), 0.0]) * np.radians(30.0))
        pose: Rigid[Camera, Marker] = Rigid(
            rotation=turn @ np.diag([1.0, -1.0, -1.0]), translation_mm=np.array([0.0, 0.0, 20.0])
        )
        along = np.column_stack([-active.normals[:, 1], active.normals[:, 0], np.zeros(len(flat))])
        at = camera.px_from_camera(pose.move_points(flat))
        tangent = camera.px_from_camera(pose.move_points(flat + 1e-4 * along)) - at
        inward = camera.px_from_camera(
            pose.move_points(flat + 1e-4 * np.column_stack([active.normals, np.zeros(len(flat))]))
        )
        normal = np.column_stack([-tangent[:, 1], tangent[:, 0]])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        normal *= np.sign(((inward - at) * normal).sum(axis=1, keepdims=True))
        columns = []
        for k in range(6):
            step = np.zeros(6)
            step[k] = 1e-5
            moved = pose.displaced(step)
            columns.append((camera.px_from_camera(moved.move_points(flat)) - at) / 1e-5)
        jacobian = np.column_stack(
            [*((column * normal).sum(axis=1) for column in columns), np.ones(len(flat))]
        )
        information = jacobian.T @ (jacobian * weight[:, None])
        information[6, 6] += 1 / 0.25**2
        covariance = np.linalg.inv(information)[3:6, 3:6]
        axis = pose.rotation[:, 2]
        variances.append(float(np.trace(covariance) - axis @ covariance @ axis))
    assert precision_of(model).tilt_sd_deg == pytest.approx(np.degrees(np.sqrt(np.mean(variances))), rel=0.01)


def test_edges_of_both_polarities_separate_distance_from_blooming() -> None:
    precision = precision_of(code_model())
    assert precision.distance_gain > 3.0
    assert precision.tilt_gain > 1.05

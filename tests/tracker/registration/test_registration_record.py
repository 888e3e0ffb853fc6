"""A registration relative to the camera or the patient marker, and its transfer to an image."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import perfectly_seen
from tracker import CameraModel, Seen, Unseen, UnseenReason
from tracker.errors import RegistrationError
from tracker.geometry import (
    Anchor,
    Array,
    Camera,
    Marker,
    Rigid,
    Vertebra,
    chained_covariance,
    inverse_covariance,
    skew,
    vector_from_rotation,
)
from tracker.navigation import Absent, AbsentReason, NavigationSnapshot, Setup, VertebraPose, navigate
from tracker.registration import AnchoredTo, Method, Registration

RANDOM = np.random.default_rng(5)
CAMERA_FROM_REFERENCE: Rigid[Camera, Marker] = Rigid.from_vector([0.4, -2.0, 0.3], [40, -30, 480])
REFERENCE_FROM_VERTEBRA: Rigid[Anchor, Vertebra] = Rigid.from_vector([1.0, 0.2, -0.4], [-30, 25, 60])


def covariance_of(sd_mm: float, sd_rad: float) -> Array:
    root = RANDOM.normal(size=(6, 6)) @ np.diag([sd_mm] * 3 + [sd_rad] * 3)
    scale = np.array([sd_mm] * 3 + [sd_rad] * 3)
    return np.asarray((root.T @ root) / 6.0 + np.diag(scale**2))


OF_REFERENCE, OF_REGISTRATION = covariance_of(0.1, 0.002), covariance_of(0.4, 0.004)
SETUP = Setup(
    camera=CameraModel(
        matrix=np.array([[1100.0, 0, 640], [0, 1100, 360], [0, 0, 1]]),
        distortion=np.zeros(5),
        size_wh_px=(1280, 720),
    ),
    camera_calibrated=True,
    tools={},
    channel=Absent(reason=AbsentReason.NO_PLAN),
    registration=Registration(
        method=Method.POINTS,
        anchored_to=AnchoredTo.REFERENCE,
        anchor_from_vertebra=REFERENCE_FROM_VERTEBRA,
        covariance=OF_REGISTRATION,
    ),
    reference="patient",
)
SEEN = perfectly_seen(CAMERA_FROM_REFERENCE, covariance=OF_REFERENCE)


def concluded(setup: Setup, sighting: Seen | Unseen) -> NavigationSnapshot:
    return navigate(
        setup=setup,
        sightings={"patient": sighting},
        image_number=0,
        captured_at_s=0.0,
        size_wh_px=(1280, 720),
        stage_ms={},
        skipped_images=0,
    )


def off(true: Rigid[Camera, Vertebra], found: Rigid[Camera, Vertebra]) -> Array:
    """Definition of the covariance: translation, then rotation as a small left-multiplied vector."""
    turn = vector_from_rotation(found.rotation @ true.rotation.T)
    return np.concatenate([found.translation_mm - true.translation_mm, turn])


def test_the_vertebra_is_placed_through_the_reference_as_it_is_seen_in_this_image() -> None:
    placed = concluded(SETUP, SEEN).vertebra
    assert isinstance(placed, VertebraPose)
    through = CAMERA_FROM_REFERENCE.matrix @ REFERENCE_FROM_VERTEBRA.matrix
    np.testing.assert_allclose(placed.camera_from_vertebra.matrix, through, atol=1e-12)


def test_without_the_reference_the_vertebra_has_no_pose() -> None:
    unseen = Unseen(reason=UnseenReason.NO_CANDIDATE)
    assert concluded(SETUP, unseen).vertebra == Absent(reason=AbsentReason.REFERENCE_UNSEEN)
    twice = Unseen(reason=UnseenReason.MARKER_TWICE)
    assert concluded(SETUP, twice).vertebra == Absent(reason=AbsentReason.MARKER_TWICE)
    # Not even if the settings name no reference: the registration is relative to one.
    nameless = replace(SETUP, reference="")
    assert concluded(nameless, SEEN).vertebra == Absent(reason=AbsentReason.REFERENCE_UNSEEN)


def test_in_an_uncalibrated_camera_a_reference_places_nothing() -> None:
    placed = concluded(replace(SETUP, camera_calibrated=False), SEEN).vertebra
    assert placed == Absent(reason=AbsentReason.CAMERA_NOT_CALIBRATED)


def test_the_uncertainty_is_that_of_reference_and_registration_together() -> None:
    runs = 4000
    near = np.random.default_rng(1).multivariate_normal(np.zeros(6), OF_REFERENCE, runs)
    far = np.random.default_rng(2).multivariate_normal(np.zeros(6), OF_REGISTRATION, runs)
    true = Rigid[Camera, Vertebra].from_matrix(CAMERA_FROM_REFERENCE.matrix @ REFERENCE_FROM_VERTEBRA.matrix)
    errors = []
    for one, other in zip(near, far, strict=True):
        anchor: Rigid[Anchor, Vertebra] = REFERENCE_FROM_VERTEBRA.displaced(other)
        seen = CAMERA_FROM_REFERENCE.displaced(one)
        found = Rigid[Camera, Vertebra].from_matrix(seen.matrix @ anchor.matrix)
        errors.append(off(true, found))
    placed = concluded(SETUP, SEEN).vertebra
    assert isinstance(placed, VertebraPose)
    whitened = np.linalg.solve(np.linalg.cholesky(placed.covariance), np.array(errors).T)
    # Of white noise each variance is 1 within four of its own standard deviations.
    np.testing.assert_allclose(whitened.var(axis=1), 1.0, atol=4.0 * np.sqrt(2.0 / runs))


def test_a_pose_and_its_inverse_err_by_the_same() -> None:
    back = CAMERA_FROM_REFERENCE.inverse
    there = inverse_covariance(CAMERA_FROM_REFERENCE, OF_REFERENCE)
    again = inverse_covariance(back, there)
    np.testing.assert_allclose(again, OF_REFERENCE, rtol=1e-9, atol=1e-12)
    both = chained_covariance(CAMERA_FROM_REFERENCE, OF_REFERENCE, back, there)
    # Back at the start, both rotations have moved the origin of the other frame, which is as far away.
    swing = np.eye(6)
    swing[:3, 3:] = skew(CAMERA_FROM_REFERENCE.translation_mm)
    np.testing.assert_allclose(both, 2.0 * swing @ OF_REFERENCE @ swing.T, rtol=1e-9, atol=1e-12)


def test_a_covariance_that_is_none_is_rejected() -> None:
    with pytest.raises(RegistrationError, match="not a finite covariance") as rejected:
        Registration(
            method=Method.POINTS,
            anchored_to=AnchoredTo.REFERENCE,
            anchor_from_vertebra=REFERENCE_FROM_VERTEBRA,
            covariance=-np.eye(6),
        )
    assert rejected.value.code == "REGISTRATION_COVARIANCE_INVALID"


def test_an_exact_tip_removes_its_part_of_the_covariance_and_no_more() -> None:
    jacobian = RANDOM.normal(size=(6, 3)) * 0.4
    tip = covariance_of(0.3, 0.003)[:3, :3]
    one = Registration(
        method=Method.POINTS,
        anchored_to=AnchoredTo.REFERENCE,
        anchor_from_vertebra=REFERENCE_FROM_VERTEBRA,
        covariance=OF_REGISTRATION + jacobian @ tip @ jacobian.T,
        tip_jacobian=jacobian,
        tool="drill",
    )
    np.testing.assert_allclose(one.without_tip_error(tip).covariance, OF_REGISTRATION, atol=1e-12)
    # A tip stated worse than the registration leaves no negative variance.
    left = one.without_tip_error(100.0 * tip).covariance
    assert np.linalg.eigvalsh(left).min() >= -1e-12

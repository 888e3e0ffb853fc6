"""One theatre from registration to navigation: displayed values are true, or absent."""

from collections.abc import Sequence

import numpy as np
import pytest

from tracker.registration import AnchoredTo
from tracker.verification import (
    Figures,
    ImageRow,
    RegistrationMethod,
    TheatreRows,
    VerificationSettings,
    drill_figures,
    theatre_seeds,
    verify_theatre,
)
from tracker.verification.figures import share_of

SETTINGS = VerificationSettings(observations=4)


@pytest.fixture(scope="module")
def theatre() -> TheatreRows:
    return verify_theatre(theatre_seeds(5, 1)[0], SETTINGS)


@pytest.fixture(scope="module")
def figures(theatre: TheatreRows) -> Figures:
    return drill_figures([theatre], noticed_within_s=SETTINGS.noticed_within_s)


def _shown(
    theatre: TheatreRows, method: RegistrationMethod, anchor: AnchoredTo, *, moves: bool
) -> Sequence[ImageRow]:
    return [
        row
        for row in theatre.images
        if (row.variant.method, row.variant.anchored_to, row.variant.camera_moves) == (method, anchor, moves)
    ]


@pytest.mark.parametrize(
    ("anchor", "moves"),
    [(AnchoredTo.CAMERA, False), (AnchoredTo.REFERENCE, False), (AnchoredTo.REFERENCE, True)],
)
def test_registration_by_points_displays_the_true_drill(
    theatre: TheatreRows, anchor: AnchoredTo, moves: bool
) -> None:
    observations = [
        row for row in _shown(theatre, RegistrationMethod.POINTS, anchor, moves=moves) if row.counts
    ]
    tool_errors = [row.tool_errors for row in observations if row.tool_errors is not None]
    assert len(tool_errors) >= 0.8 * len(observations) > 0
    # Seven landmarks, each wrong by half a millimetre: nobody can do much better either.
    assert 0.01 < np.median([one.entry.error for one in tool_errors]) < 0.6
    assert np.median([one.angle.error for one in tool_errors]) < 1.2
    assert np.median([one.tip.error for one in tool_errors]) < 0.7
    assert np.median([one.tip.stated_sd for one in tool_errors]) < 1.0
    assert np.mean([one.tip.mahalanobis_squared for one in tool_errors]) < 3.0 * 3.0


def test_registration_by_needles_states_a_large_covariance(theatre: TheatreRows) -> None:
    observations = _shown(theatre, RegistrationMethod.NEEDLES, AnchoredTo.CAMERA, moves=False)
    for row in observations:
        if row.tool_errors is not None:
            assert row.tool_errors.tip.stated_sd > 5.0
            assert row.tool_errors.tip.mahalanobis_squared < 20.0


def test_after_a_camera_move_values_stop_without_a_reference_and_stay_true_with_one(
    theatre: TheatreRows, figures: Figures
) -> None:
    alone = _shown(theatre, RegistrationMethod.POINTS, AnchoredTo.CAMERA, moves=True)
    late = [row for row in alone if row.since_move_s > SETTINGS.noticed_within_s]
    assert late
    assert {row.absent for row in late} == {"CAMERA_MOVED"}
    assert {one.shown_wrong for one in figures.variants} == {0}
    with_reference = _shown(theatre, RegistrationMethod.POINTS, AnchoredTo.REFERENCE, moves=True)
    absent = [row.absent for row in with_reference if row.since_move_s > 0.3 and row.absent]
    assert absent == []


def test_images_of_one_theatre_are_not_independent_samples() -> None:
    alone = share_of([True] * 95 + [False] * 5, list(range(100)))
    together = share_of([True] * 95 + [False] * 5, [number // 5 for number in range(100)])
    assert alone.ratio == together.ratio == 0.95
    assert together.high - together.low > 1.5 * (alone.high - alone.low)
    assert share_of([True] * 600, list(range(600))).is_outside
    assert share_of([True] * 60 + [False] * 40, list(range(100))).is_outside
    assert not alone.is_outside


def test_more_theatres_begin_with_the_same() -> None:
    assert theatre_seeds(5, 8)[:3] == theatre_seeds(5, 3)
    assert theatre_seeds(5, 3) != theatre_seeds(6, 3)

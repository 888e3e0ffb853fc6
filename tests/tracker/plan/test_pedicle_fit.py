"""Covariance of the pedicle's fit: residuals need not be independent."""

import numpy as np
import pytest
import scipy

from tracker.plan.pedicle.fit import _covariance

SPACING_MM, SHAPE = 0.75, (16, 16, 24)


@pytest.mark.parametrize(
    "correlated_mm", [pytest.param(0.0, id="noise"), pytest.param(0.4, id="texture of a millimetre")]
)
def test_the_stated_error_of_a_mean_is_its_true_one_however_residuals_are_correlated(
    correlated_mm: float,
) -> None:
    rng = np.random.default_rng(3)
    fields = scipy.ndimage.gaussian_filter(
        rng.normal(size=(60, *SHAPE)), (0.0, *([correlated_mm / SPACING_MM] * 3)), mode="wrap"
    ).reshape(60, -1)
    places_mm = SPACING_MM * np.moveaxis(np.indices(SHAPE), 0, -1).reshape(-1, 3).astype(np.float64)
    jacobian = np.ones((len(places_mm) + 1, 1))
    jacobian[-1] = 1e-3  # a prior that states nothing
    stated = [np.sqrt(_covariance(jacobian, one[:, None], places_mm)[0, 0]) for one in fields[:10]]
    assert np.mean(stated) == pytest.approx(np.std(fields.mean(axis=1)), rel=0.25)

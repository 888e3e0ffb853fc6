"""Camera response against gamma curves."""

import numpy as np
import pytest

from tracker.geometry import Array
from tracker.photometric.response_kernels import apply_response, response_derivative, response_slope

# What ink sends back, by what paper does.
INK = 0.1
VALUES = np.linspace(0.0, 1.0, 101)


def _shaped(response: float) -> Array:
    return np.array([apply_response(float(s), response) for s in VALUES])


@pytest.mark.parametrize("power", [1.0 / 2.2, 1.0 / 1.5, 1.4])
def test_one_parameter_describes_camera_gamma_curves(power: float) -> None:
    """A parabola alone is off by 0.04 of the contrast at 1 / 2.2, and the tip by half a millimetre."""
    illumination = INK + (1.0 - INK) * VALUES
    seen = (illumination**power - INK**power) / (1.0 - INK**power)
    minimum = min(float(np.abs(_shaped(float(r)) - seen).max()) for r in np.linspace(-0.9, 0.9, 181))
    assert minimum < 0.02


@pytest.mark.parametrize("response", [-0.6, -0.2, 0.3, 0.8])
def test_the_derivatives_match_finite_differences_of_the_curve(response: float) -> None:
    step = 1e-5
    by_value = [
        (apply_response(s + step, response) - apply_response(s - step, response)) / (2 * step) for s in VALUES
    ]
    by_bend = (_shaped(response + step) - _shaped(response - step)) / (2 * step)
    assert [response_slope(float(s), response) for s in VALUES] == pytest.approx(by_value, abs=1e-6)
    assert [response_derivative(float(s), response) for s in VALUES] == pytest.approx(by_bend, abs=1e-6)
    assert min(by_value) > 0.0

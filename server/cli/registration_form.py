"""JSON fields shared by both registration commands."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from server.cli.output import problem_values
from server.number_format import finite
from tracker.errors import RegistrationError, Remark
from tracker.geometry import Anchor, Array, Rigid, Vertebra

COVARIANCE_OF = (
    "(d, r) in x_fixed = exp([r]x) R x_moving + t + d, with fixed_from_moving = [R t]: d in mm and r in rad, "
    "both on the axes of the fixed frame; r rotates about the moved origin, which lies at t"
)
EXPECTED = "3-D RMS, from the residuals alone"
STATED = (
    "3-D RMS of the covariance: not below the floors, larger for few points, so that 95 % of its normal "
    "distribution contain the truth in 95 % of cases"
)

Error = Callable[[Array], float]


def registration_form(
    fixed_from_moving: Rigid[Vertebra, Anchor],
    covariance: Array,
    errors: Mapping[str, Error],
    targets: Sequence[Array],
    *,
    floors: Mapping[str, float],
    limits: Mapping[str, float],
    remarks: Sequence[Remark],
    failures: Sequence[RegistrationError],
) -> dict[str, Any]:
    """Return transform, covariance, errors at targets, floors, limits, warnings and gate.

    `errors`: by name of the field, the error at a target; has `tre_expected_mm`.
    """
    expected = [errors["tre_expected_mm"](target) for target in targets]
    return {
        "fixed_from_moving": fixed_from_moving.matrix.tolist(),
        # A number for one target, a list for several, null without a target.
        "tre_expected_mm": expected[0] if len(expected) == 1 else (expected or None),
        "targets": [
            {"target_mm": target.tolist(), **{name: error(target) for name, error in errors.items()}}
            for target in targets
        ],
        "tre_expected_is": EXPECTED,
        "tre_stated_is": STATED,
        "floors": dict(floors),
        "covariance": covariance.tolist(),
        "covariance_of": COVARIANCE_OF,
        "warnings": [problem_values(remark) for remark in remarks],
        "limits": {name: finite(limit) for name, limit in limits.items()},
        "gate": {"passed": not failures, "failures": [problem_values(failure) for failure in failures]},
    }

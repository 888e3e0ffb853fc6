"""Manual adjustment of a registration in small, bounded, undoable steps along the patient's axes.

A manual adjustment is not a measurement. Each one increases the covariance as if the true pose were uniformly
distributed between the original and the adjusted registration; undoing it removes that increase.
"""

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from tracker.errors import RegistrationError
from tracker.geometry import Array, Rigid, Vertebra, rotation_from_vector, skew, vector_from_rotation
from tracker.registration.record import Registration

STEPS_MM = (0.1, 0.5, 1.0)
STEPS_DEG = (0.1, 0.5, 1.0)
ROUNDING = 1e-9


class NudgeAxis(StrEnum):
    """The patient's axes, named by their positive direction."""

    LEFT = "left"
    BACK = "back"
    HEAD = "head"


class NudgeKind(StrEnum):
    """Translation along an axis in mm, or right-handed rotation about it in degrees."""

    SHIFT = "shift"
    TURN = "turn"


@dataclass(frozen=True, slots=True, kw_only=True)
class Nudge:
    """One step of the drawn vertebra on the patient.

    Attributes:
        kind: translation or rotation.
        axis: axis along or about which it moves.
        amount: in mm or degrees, with its sign; one of the steps.

    Raises:
        RegistrationError: NUDGE_STEP_INVALID.
    """

    kind: NudgeKind
    axis: NudgeAxis
    amount: float

    def __post_init__(self) -> None:
        steps = STEPS_MM if self.kind is NudgeKind.SHIFT else STEPS_DEG
        if not any(abs(abs(self.amount) - step) < ROUNDING for step in steps):
            unit = "mm" if self.kind is NudgeKind.SHIFT else "deg"
            allowed = ", ".join(f"{step:g}" for step in steps)
            raise RegistrationError(
                "NUDGE_STEP_INVALID",
                f"a nudge of {self.amount:g} {unit} is not allowed; the steps are {allowed} {unit}",
                "Nudge in small steps, and register again where many would be needed.",
                {"amount": self.amount, "unit": unit, "allowed": list(steps), "steps": allowed},
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class NudgeLimits:
    """Maximum total translation and rotation from the original registration."""

    max_mm: float = 5.0
    max_deg: float = 5.0


@dataclass(frozen=True, slots=True, kw_only=True)
class NudgedRegistration:
    """A registration and its nudges in order.

    Attributes:
        made: the registration without any nudge.
        pivot_mm: (3,), centre of rotation on the CT, such as the entry point.
        limits: maximum total translation and rotation.
        nudges: all nudges in effect, the oldest first; the caller logs who made them and when.
    """

    made: Registration
    pivot_mm: Array
    limits: NudgeLimits = NudgeLimits()
    nudges: tuple[Nudge, ...] = ()

    def __post_init__(self) -> None:
        pivot = np.array(self.pivot_mm, dtype=np.float64)
        if pivot.shape != (3,) or not np.isfinite(pivot).all():
            raise RegistrationError(
                "NUDGE_PIVOT_INVALID",
                "the centre of rotation is not three finite numbers",
                "Give a point of the plan in mm, such as the entry point.",
            )
        pivot.setflags(write=False)
        object.__setattr__(self, "pivot_mm", pivot)

    def nudged(self, nudge: Nudge) -> "NudgedRegistration":
        """Return the registration with one more adjustment.

        Raises:
            RegistrationError: NUDGE_TOO_FAR, the total would exceed its limit.
        """
        after = replace(self, nudges=(*self.nudges, nudge))
        shift_mm, rotation_deg = after.shift_mm, after.rotation_deg
        # A nudge towards the original is always accepted, even if the limits were reduced in the meantime.
        too_far = shift_mm > max(self.limits.max_mm, self.shift_mm) + ROUNDING
        too_turned = rotation_deg > max(self.limits.max_deg, self.rotation_deg) + ROUNDING
        if too_far or too_turned:
            raise RegistrationError(
                "NUDGE_TOO_FAR",
                f"with this nudge the registration would be {shift_mm:.1f} mm and {rotation_deg:.1f} deg "
                f"from where it was made, allowed {self.limits.max_mm:g} mm and "
                f"{self.limits.max_deg:g} deg",
                "Undo nudges, or register again: an error of this size needs a new registration.",
                {
                    "shift_mm": shift_mm,
                    "rotation_deg": rotation_deg,
                    "max_mm": self.limits.max_mm,
                    "max_deg": self.limits.max_deg,
                },
            )
        return after

    def undone(self) -> "NudgedRegistration":
        """Return the registration without the last adjustment.

        Raises:
            RegistrationError: NUDGE_NONE, there is none.
        """
        if not self.nudges:
            raise RegistrationError(
                "NUDGE_NONE", "there is no nudge to undo", "The registration is unchanged."
            )
        return replace(self, nudges=self.nudges[:-1])

    @property
    def shift_mm(self) -> float:
        """Return the total translation of the pivot."""
        return float(np.linalg.norm(self._moved().move_points(self.pivot_mm) - self.pivot_mm))

    @property
    def rotation_deg(self) -> float:
        """Return the total rotation angle."""
        return float(np.degrees(np.linalg.norm(vector_from_rotation(self._moved().rotation))))

    @property
    def registration(self) -> Registration:
        """Return the adjusted registration with an increased covariance."""
        if not self.nudges:
            return self.made
        moved = self._moved()
        anchor_from_vertebra = self.made.anchor_from_vertebra @ moved
        turn = self.made.anchor_from_vertebra.rotate_directions(vector_from_rotation(moved.rotation))
        was = self.made.anchor_from_vertebra.move_points(self.pivot_mm)
        shift = anchor_from_vertebra.move_points(self.pivot_mm) - was
        # The covariance is transformed about the pivot, because the CT's origin is far away and moves on an
        # arc: the pivot keeps its own uncertainty plus that of the shift.
        before = skew(self.made.anchor_from_vertebra.rotate_directions(self.pivot_mm))
        after = skew(anchor_from_vertebra.rotate_directions(self.pivot_mm))
        carried = np.eye(6)
        carried[:3, 3:] = after - before
        displacement = np.concatenate([shift + after @ turn, turn])
        return replace(
            self.made,
            anchor_from_vertebra=anchor_from_vertebra,
            # The second moment of a uniform distribution between both is a third of the square.
            covariance=carried @ self.made.covariance @ carried.T
            + np.outer(displacement, displacement) / 3.0,
        )

    def _moved(self) -> Rigid[Vertebra, Vertebra]:
        moved: Rigid[Vertebra, Vertebra] = Rigid.identity()
        for nudge in self.nudges:
            moved = moved @ _step(nudge, self.pivot_mm)
        return moved


def _step(nudge: Nudge, pivot_mm: Array) -> Rigid[Vertebra, Vertebra]:
    # LPS: left, back and head are x, y and z.
    axis = np.eye(3)[list(NudgeAxis).index(nudge.axis)]
    if nudge.kind is NudgeKind.SHIFT:
        return Rigid(rotation=np.eye(3), translation_mm=nudge.amount * axis)
    turn = rotation_from_vector(np.radians(nudge.amount) * axis)
    return Rigid(rotation=turn, translation_mm=pivot_mm - turn @ pivot_mm)

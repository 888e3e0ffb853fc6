"""The check of `coaxial register points` whether a registration is accurate enough for a planned screw."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from tracker.errors import InvalidInput
from tracker.navigation import RegistrationCheck, check_registration
from tracker.navigation.uncertainty import PedicleTolerance, UncertainPose
from tracker.plan import Channel
from tracker.registration.points import PointRegistration

# Numbers of additional landmarks that a person can still touch.
MORE_LANDMARKS = (2, 4, 8)


@dataclass(frozen=True, slots=True, kw_only=True)
class ChannelCheck:
    """The check of a registration on one channel, and the expected one with more landmarks.

    Attributes:
        now: With the stated covariance.
        with_more: By number of additional landmarks of the same spread and precision, without a gross error.
    """

    now: RegistrationCheck
    with_more: dict[int, RegistrationCheck]

    @property
    def mapping(self) -> dict[str, Any]:
        """The check as JSON."""
        return {
            "suffices": self.now.suffices,
            "entry_95_mm": self.now.entry_95_mm,
            "isthmus_95_mm": self.now.isthmus_95_mm,
            "tolerance_mm": self.now.tolerance_mm,
            "diameter_excess_mm": self.now.diameter_excess_mm,
            "with_more_landmarks_95_mm": {
                str(more): check.error_95_mm for more, check in self.with_more.items()
            },
        }

    @property
    def lines(self) -> list[str]:
        """The check as text."""
        now = self.now
        found = [
            f"On the channel: {now.entry_95_mm:.2f} mm at the entry, {now.isthmus_95_mm:.2f} mm at the "
            f"isthmus (95 %, registration only); tolerance of the screw {now.tolerance_mm:.2f} mm."
        ]
        if now.suffices:
            return found
        # The errors of marker and tool are added to each figure, so that "enough" holds at best.
        found.append(
            "This screw cannot be navigated with this registration: every image is SET-UP INSUFFICIENT."
        )
        found += [
            f"  {more} more landmarks of the same spread, all correct: {check.error_95_mm:.2f} mm, "
            f"{'enough at best' if check.suffices else 'not enough'}"
            for more, check in self.with_more.items()
        ]
        if now.diameter_excess_mm is None:
            found.append("  a thinner screw: the planned screw has no tolerance, plan it again first")
        else:
            found.append(f"  a screw on the same axis, thinner by at least {now.diameter_excess_mm:.1f} mm")
        return found


def check_channel(found: PointRegistration, channel_text: str, tolerance_text: str) -> ChannelCheck:
    """Check a registration on a channel `ex,ey,ez,tx,ty,tz` with a tolerance `mm,deg`.

    Raises:
        InvalidInput: CHANNEL_TEXT_INVALID, TOLERANCE_TEXT_INVALID.
        PlanError: CHANNEL_INVALID.
    """
    ends = _numbers(channel_text, 6, "CHANNEL_TEXT_INVALID", "--channel-mm", "entry and target, x,y,z,x,y,z")
    allowed = _numbers(tolerance_text, 2, "TOLERANCE_TEXT_INVALID", "--tolerance", "mm,deg")
    if not (allowed[0] >= 0.0 and 0.0 <= allowed[1] < 90.0):
        raise _invalid("TOLERANCE_TEXT_INVALID", "--tolerance", tolerance_text, "mm,deg")
    # The radius of the channel is not used: the tolerance already accounts for the screw.
    channel = Channel(name="", entry_in_vertebra_mm=ends[:3], target_in_vertebra_mm=ends[3:], radius_mm=1.0)
    tolerance = PedicleTolerance.of_limits(float(allowed[0]), float(allowed[1]))

    def check(covariance: np.ndarray[Any, Any]) -> RegistrationCheck:
        pose = UncertainPose(pose=found.fixed_from_moving, covariance=covariance)
        return check_registration(pose, channel, tolerance)

    with_more = {more: check(found.covariance_with_more(more)) for more in MORE_LANDMARKS}
    return ChannelCheck(now=check(found.covariance), with_more=with_more)


def _numbers(text: str, count: int, code: str, option: str, form: str) -> np.ndarray[Any, Any]:
    try:
        numbers = np.array([float(word) for word in text.replace(",", " ").split()])
    except ValueError:
        raise _invalid(code, option, text, form) from None
    if len(numbers) != count or not np.isfinite(numbers).all():
        raise _invalid(code, option, text, form)
    return numbers


def _invalid(code: str, option: str, text: str, form: str) -> InvalidInput:
    return InvalidInput(
        code,
        f"{option} is '{text}', expected {form}",
        "Copy the numbers from the output of 'coaxial plan measure --json'.",
    )

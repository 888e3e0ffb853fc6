"""Whether a registration suffices for one screw, known before navigation.

The drill is placed on the planned channel with an exact marker pose and an exact tip. What is left is the
registration's share of the error: if it exceeds what the pedicle leaves, so does that of every image with
the drill on the channel. This holds for a covariance that has no error in common with the drill
(`Registration.tip_jacobian` is 0, as on the command line); of a tip that registers and drills, part cancels.
"""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Anchor, Rigid, Tool, Vertebra
from tracker.navigation.directions import channel_directions
from tracker.navigation.figures import rounded_down, rounded_up
from tracker.navigation.uncertainty import PedicleTolerance, UncertainPose, check_tolerance
from tracker.plan import Channel


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationCheck:
    """The registration's error on a channel and what the screw leaves, rounded as navigation rounds them.

    Attributes:
        entry_95_mm: 95 % radius of the drill's axis at the entry, rounded up.
        isthmus_95_mm: the same at the isthmus.
        tolerance_mm: from the screw on the planned axis to the nearest wall, rounded down.
    """

    entry_95_mm: float
    isthmus_95_mm: float
    tolerance_mm: float

    @property
    def error_95_mm(self) -> float:
        """The larger of both errors, as the navigation's figure ERROR takes it."""
        return max(self.entry_95_mm, self.isthmus_95_mm)

    @property
    def suffices(self) -> bool:
        """False if every image of this set-up is UNCERTAIN; True does not promise that any is not."""
        return self.error_95_mm <= self.tolerance_mm

    @property
    def diameter_excess_mm(self) -> float | None:
        """By how much a screw on the same axis must be thinner to leave the error; 0 if it suffices.

        A thinner screw leaves half of the difference on each side. None if the planned screw leaves nothing:
        by how much it breaches is not part of its tolerance.
        """
        if self.suffices:
            return 0.0
        if self.tolerance_mm <= 0.0:
            return None
        return rounded_up(2.0 * (self.error_95_mm - self.tolerance_mm))


def check_registration(
    vertebra_from_anchor: UncertainPose[Vertebra, Anchor], channel: Channel, tolerance: PedicleTolerance
) -> RegistrationCheck:
    """Compare the registration's error on a channel with what the screw leaves.

    Args:
        vertebra_from_anchor: the registration with its covariance.
        channel: the planned channel.
        tolerance: of the planned screw in it.
    """
    across = channel_directions(channel)
    planned: Rigid[Vertebra, Tool] = Rigid(
        rotation=np.column_stack([np.cross(across.cranial, across.axis), across.cranial, across.axis]),
        translation_mm=channel.entry_in_vertebra_mm,
    )
    drill = UncertainPose(pose=vertebra_from_anchor.pose.inverse @ planned, covariance=np.zeros((6, 6)))
    check = check_tolerance(vertebra_from_anchor @ drill, channel, tolerance)
    return RegistrationCheck(
        entry_95_mm=rounded_up(check.entry_95_mm, decimals=2),
        isthmus_95_mm=rounded_up(check.isthmus_95_mm, decimals=2),
        tolerance_mm=rounded_down(check.tolerance_mm, decimals=2),
    )

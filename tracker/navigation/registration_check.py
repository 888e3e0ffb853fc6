"""Test, before navigation, whether a registration suffices for one screw.

The drill is placed on the planned channel, and its minimum error there is compared with the tolerance of the
pedicle: if it exceeds the tolerance, so does the error in every image with the drill on the channel.

`check_registration` uses the covariance of the registration only, with an exact marker pose and an exact tip.
`check_setup` adds the calibration of the tool and the tracking error of the best capture. If the same tip
registers and drills, part of its error cancels (`Registration.tip_jacobian`), depending on the rotation of
the drill; the minimum over all rotations about its axis is taken.
"""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Anchor, Array, Camera, Marker, Rigid, Tool, Vertebra
from tracker.navigation.directions import channel_directions
from tracker.navigation.drill_reference import DrillReference, tool_in_vertebra
from tracker.navigation.figures import rounded_down, rounded_up
from tracker.navigation.snapshot import Absent, Setup
from tracker.navigation.uncertainty import (
    PedicleTolerance,
    ToleranceCheck,
    UncertainPose,
    check_tolerance,
)
from tracker.plan import Channel
from tracker.pose import ToolModel
from tracker.registration import Registration

# Steps of the rotation about the drill's axis; between two of them the error changes by less than 1 %.
ROTATIONS = 24
# Depths of the tip as ratios of the depth of the isthmus, because an error of the axis has no lever at the
# tip.
DEPTHS = (0.0, 0.5, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationCheck:
    """Registration error on a channel and tolerance of the screw, rounded as in navigation.

    Attributes:
        entry_95_mm: 95 % radius of the drill's axis at the entry, rounded up.
        isthmus_95_mm: the same at the isthmus.
        tolerance_mm: distance from the screw on the planned axis to the nearest wall, rounded down.
    """

    entry_95_mm: float
    isthmus_95_mm: float
    tolerance_mm: float

    @property
    def error_95_mm(self) -> float:
        """Return the larger of both errors, as in the navigation's figure ERROR."""
        return max(self.entry_95_mm, self.isthmus_95_mm)

    @property
    def suffices(self) -> bool:
        """Return False if the error exceeds its limit in every image; True guarantees nothing."""
        return self.error_95_mm <= self.tolerance_mm

    @property
    def diameter_excess_mm(self) -> float | None:
        """Return by how much the diameter of the screw exceeds the error's tolerance; 0 if it suffices.

        A thinner screw increases the tolerance by half of the difference of the diameters. None if the
        planned screw has no tolerance, because the amount of its breach is not known.
        """
        if self.suffices:
            return 0.0
        if self.tolerance_mm <= 0.0:
            return None
        return rounded_up(2.0 * (self.error_95_mm - self.tolerance_mm))


def check_registration(
    vertebra_from_anchor: UncertainPose[Vertebra, Anchor], channel: Channel, tolerance: PedicleTolerance
) -> RegistrationCheck:
    """Compare the registration error on a channel with the tolerance of the screw.

    Args:
        vertebra_from_anchor: the registration with its covariance.
        channel: the planned channel.
        tolerance: of the planned screw in it.
    """
    drill = UncertainPose(
        pose=vertebra_from_anchor.pose.inverse @ _planned(channel), covariance=np.zeros((6, 6))
    )
    return _rounded(check_tolerance(vertebra_from_anchor @ drill, channel, tolerance))


def check_setup(
    registration: Registration, tool: ToolModel, channel: Channel, tolerance: PedicleTolerance
) -> RegistrationCheck:
    """Compare the minimum error of registration, tool and tracking with the tolerance of the screw.

    Returns the check for the rotation and depth of the drill on its planned axis with the minimum error.

    Args:
        registration: with its covariance, and the tip that it has in common with the drill.
        tool: the drill, with the covariance of its calibration.
        channel: the planned channel.
        tolerance: of the planned screw in it; of the drill if there is no screw.
    """
    checks = (
        check_tolerance(
            _placed(registration, tool, channel, share * tolerance.lever_mm, turn), channel, tolerance
        )
        for share in DEPTHS
        for turn in np.arange(ROTATIONS) * 2.0 * np.pi / ROTATIONS
    )
    return _rounded(min(checks, key=lambda one: max(one.entry_95_mm, one.isthmus_95_mm)))


def min_errors_95_mm(setup: Setup, drill_reference: DrillReference) -> dict[str, float]:
    """Return the minimum 95 % error on the channel by tool of a setup; empty without a registration."""
    registration, channel = setup.registration, setup.channel
    if isinstance(registration, Absent) or isinstance(channel, Absent):
        return {}
    return {
        name: check_setup(
            registration, tool, channel, drill_reference.tolerance_for(tool, channel)
        ).error_95_mm
        for name, tool in setup.tools.items()
    }


def _placed(
    registration: Registration, tool: ToolModel, channel: Channel, depth_mm: float, turn_rad: float
) -> UncertainPose[Vertebra, Tool]:
    """Return the tool on the channel, rotated about its axis, with the error that navigation would state."""
    anchor = registration.anchor_from_vertebra
    # The anchor is used as the camera, because the pose error of the patient's marker cancels.
    camera_from_vertebra: Rigid[Camera, Vertebra] = Rigid(
        rotation=anchor.rotation, translation_mm=anchor.translation_mm
    )
    marker: Rigid[Camera, Marker] = (
        camera_from_vertebra
        @ _planned(channel, depth_mm=depth_mm, turn_rad=turn_rad)
        @ tool.marker_from_tool.inverse
    )
    tracking = np.zeros((6, 6))
    tracking[:3, :3] = registration.tracking_covariance_mm2
    return tool_in_vertebra(
        UncertainPose(pose=camera_from_vertebra, covariance=registration.covariance),
        UncertainPose(pose=marker, covariance=tracking),
        tool,
        tip_jacobian=registration.tip_jacobian if registration.tool == tool.name else None,
    )


def _planned(channel: Channel, *, depth_mm: float = 0.0, turn_rad: float = 0.0) -> Rigid[Vertebra, Tool]:
    """Return the pose of a drill on the channel."""
    across = channel_directions(channel)
    sideways: Array = np.cross(across.cranial, across.axis)
    cos, sin = np.cos(turn_rad), np.sin(turn_rad)
    return Rigid(
        rotation=np.column_stack(
            [cos * sideways + sin * across.cranial, cos * across.cranial - sin * sideways, across.axis]
        ),
        translation_mm=channel.entry_in_vertebra_mm + depth_mm * across.axis,
    )


def _rounded(check: ToleranceCheck) -> RegistrationCheck:
    return RegistrationCheck(
        entry_95_mm=rounded_up(check.entry_95_mm, decimals=2),
        isthmus_95_mm=rounded_up(check.isthmus_95_mm, decimals=2),
        tolerance_mm=rounded_down(check.tolerance_mm, decimals=2),
    )

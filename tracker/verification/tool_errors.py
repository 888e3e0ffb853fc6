"""Errors of a displayed tool pose against the ground truth, and against its stated covariance."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.navigation.directions import channel_directions
from tracker.navigation.uncertainty import UncertainPose
from tracker.navigation.uncertainty.propagation import axis_covariance_rad2, crossing_covariance_mm2
from tracker.plan import Channel

# 95 % points of chi-square with one, two and three degrees of freedom.
WITHIN_95 = (3.841458820694124, 5.991464547107979, 7.814727903251179)


@dataclass(frozen=True, slots=True, kw_only=True)
class ErrorSample:
    """The error of one displayed quantity against the truth.

    Attributes:
        error: norm of the error in mm or degrees.
        stated_sd: root of the trace of its covariance, in the same unit.
        mahalanobis_squared: squared Mahalanobis distance; chi-square distributed if the covariance is
            correct.
        dof: number of components of the error.
    """

    error: float
    stated_sd: float
    mahalanobis_squared: float
    dof: int

    @property
    def is_within_95(self) -> bool:
        """Return whether the truth lies within the stated 95 % region (chi-square)."""
        return self.mahalanobis_squared <= WITHIN_95[self.dof - 1]


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolErrors:
    """The errors of one displayed tool pose.

    Attributes:
        entry: intersection of the drill axis with the entry plane, mm (two components).
        angle: direction of the drill axis, deg (two).
        depth: depth of the tip along the channel, mm (one).
        tip: tip in the vertebra's frame, mm (three).
    """

    entry: ErrorSample
    angle: ErrorSample
    depth: ErrorSample
    tip: ErrorSample


def tool_errors(
    shown: UncertainPose[Vertebra, Tool], true: Rigid[Vertebra, Tool], channel: Channel
) -> ToolErrors:
    """Return the errors of a displayed tool pose with its covariance against the true pose."""
    across = channel_directions(channel)
    tip_off = true.translation_mm - shown.pose.translation_mm
    covariance = shown.covariance[:3, :3]
    onto = np.stack([across.medial, across.cranial])
    entry_off = onto @ (_crossing(true, channel) - _crossing(shown.pose, channel))
    # In the displayed drill's x and y, to first order like the stated covariance.
    turn = shown.pose.rotation[:, :2].T @ true.rotation[:, 2]
    return ToolErrors(
        entry=_error_sample(entry_off, crossing_covariance_mm2(shown, channel, depth_mm=0.0)),
        angle=_error_sample(np.degrees(turn), np.degrees(np.degrees(axis_covariance_rad2(shown)))),
        depth=_error_sample(
            np.array([tip_off @ across.axis]), np.array([[across.axis @ covariance @ across.axis]])
        ),
        tip=_error_sample(tip_off, covariance),
    )


def _crossing(tool: Rigid[Vertebra, Tool], channel: Channel) -> Array:
    """Return the intersection (3,) of the drill axis with the entry plane, relative to the entry point."""
    axis, direction = channel.axis_in_vertebra, tool.rotation[:, 2]
    tip = tool.translation_mm - channel.entry_in_vertebra_mm
    return np.asarray(tip - direction * (tip @ axis) / (direction @ axis))


def _error_sample(off: Array, covariance: Array) -> ErrorSample:
    return ErrorSample(
        error=float(np.linalg.norm(off)),
        stated_sd=float(np.sqrt(np.trace(covariance))),
        mahalanobis_squared=float(off @ np.linalg.solve(covariance, off)),
        dof=len(off),
    )

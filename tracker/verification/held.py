"""What is shown held against what is true, and against the uncertainty that is stated for it."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.navigation.certainty import Placed
from tracker.navigation.certainty.spread import axis_covariance_rad2, crossing_covariance_mm2
from tracker.navigation.directions import directions_of
from tracker.plan import Channel

# 95 % points of chi-square with one, two and three degrees of freedom.
WITHIN_95 = (3.841458820694124, 5.991464547107979, 7.814727903251179)


@dataclass(frozen=True, slots=True, kw_only=True)
class Held:
    """One number that is shown, against the truth.

    Attributes:
        error: how far it is off: mm, or degrees.
        stated: the root of the trace of its covariance, in the same unit.
        surprise: the squared error in units of what is stated; of chi-square where that is true.
        numbers: of how many numbers it consists.
    """

    error: float
    stated: float
    surprise: float
    numbers: int

    @property
    def is_covered(self) -> bool:
        """Whether the truth lies within the 95 % that are stated."""
        return self.surprise <= WITHIN_95[self.numbers - 1]


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldTool:
    """The drill that is shown, against the true one.

    Attributes:
        entry: where its line meets the entry plane, mm (two numbers).
        angle: its direction, deg (two).
        depth: of its tip along the channel, mm (one).
        tip: in the vertebra's frame, mm (three).
    """

    entry: Held
    angle: Held
    depth: Held
    tip: Held


def held(shown: Placed[Vertebra, Tool], true: Rigid[Vertebra, Tool], channel: Channel) -> HeldTool:
    """Hold a drill that is shown with its covariance against the true one."""
    across = directions_of(channel)
    tip_off = true.translation_mm - shown.pose.translation_mm
    covariance = shown.covariance[:3, :3]
    onto = np.stack([across.medial, across.cranial])
    entry_off = onto @ (_crossing(true, channel) - _crossing(shown.pose, channel))
    # Along the shown drill's x and y; first order, as what is stated is.
    turn = shown.pose.rotation[:, :2].T @ true.rotation[:, 2]
    return HeldTool(
        entry=_held(entry_off, crossing_covariance_mm2(shown, channel, depth_mm=0.0)),
        angle=_held(np.degrees(turn), np.degrees(np.degrees(axis_covariance_rad2(shown)))),
        depth=_held(np.array([tip_off @ across.axis]), np.array([[across.axis @ covariance @ across.axis]])),
        tip=_held(tip_off, covariance),
    )


def _crossing(tool: Rigid[Vertebra, Tool], channel: Channel) -> Array:
    """Where a drill's line meets the plane through the entry point (3,), from there."""
    axis, way = channel.axis_in_vertebra, tool.rotation[:, 2]
    tip = tool.translation_mm - channel.entry_in_vertebra_mm
    return np.asarray(tip - way * (tip @ axis) / (way @ axis))


def _held(off: Array, covariance: Array) -> Held:
    return Held(
        error=float(np.linalg.norm(off)),
        stated=float(np.sqrt(np.trace(covariance))),
        surprise=float(off @ np.linalg.solve(covariance, off)),
        numbers=len(off),
    )

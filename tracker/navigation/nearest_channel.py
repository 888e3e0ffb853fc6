"""`NearestChannelMonitor`: which other planned channel the drill is nearer to than to the chosen one.

A proposal, never a choice: no figure and no limit depends on it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from tracker.geometry import Array
from tracker.plan import Channel

# A larger margin misses neighbouring levels of a small spine; a smaller one proposes where both pedicles of a
# vertebra are equally far, above the spinous process.
MIN_NEARER_MM: Final = 5.0
MIN_STILL_NEARER_MM: Final = 2.0
# From farther away, as beside the wound, nothing follows for a channel.
MAX_DISTANCE_MM: Final = 15.0
MAX_STILL_DISTANCE_MM: Final = 20.0
# A drill on its way to a channel passes others.
CONFIRMATION_S: Final = 1.0
# After a longer gap between two poses the confirmation begins again.
MAX_GAP_S: Final = 0.5


@dataclass(frozen=True, slots=True)
class _Candidate:
    name: str
    since_s: float


class NearestChannelMonitor:
    """Compares the distances of the drill's tip from the planned channels, with hysteresis."""

    def __init__(self) -> None:
        self._candidate: _Candidate | None = None
        self._proposed: str | None = None
        self._seen_s = -np.inf

    def step(
        self,
        tip_in_vertebra_mm: Array | None,
        at_s: float,
        *,
        active: Channel,
        others: Mapping[str, Channel],
    ) -> str | None:
        """Return the name of the channel to propose, or None.

        Args:
            tip_in_vertebra_mm: (3,), tip of the drill; None without a valid pose, which ends a proposal.
            at_s: capture time of its image.
            active: the chosen channel.
            others: the other planned channels by name, in the same frame.
        """
        if tip_in_vertebra_mm is None or not others:
            self._candidate = self._proposed = None
            return None
        if at_s - self._seen_s > MAX_GAP_S:
            self._candidate = self._proposed = None
        self._seen_s = at_s
        active_mm = distance_to_channel_mm(tip_in_vertebra_mm, active)
        distances = {name: distance_to_channel_mm(tip_in_vertebra_mm, one) for name, one in others.items()}
        nearest = min(distances, key=lambda name: distances[name])
        proposed_mm = distances.get(self._proposed or "", np.inf)
        if not (active_mm - proposed_mm >= MIN_STILL_NEARER_MM and proposed_mm <= MAX_STILL_DISTANCE_MM):
            self._proposed = None
        # Compared with what is proposed, if anything is, so that two others do not alternate.
        reference_mm = active_mm if self._proposed is None else min(active_mm, proposed_mm)
        nearer_mm = reference_mm - distances[nearest]
        if nearer_mm >= MIN_NEARER_MM and distances[nearest] <= MAX_DISTANCE_MM:
            if self._candidate is None or self._candidate.name != nearest:
                self._candidate = _Candidate(nearest, at_s)
            if at_s - self._candidate.since_s >= CONFIRMATION_S:
                self._proposed = nearest
        else:
            self._candidate = None
        return self._proposed


def distance_to_channel_mm(point_in_vertebra_mm: Array, channel: Channel) -> float:
    """Return the distance of a point from the axis of a channel between its entry and its target."""
    from_entry = point_in_vertebra_mm - channel.entry_in_vertebra_mm
    axis = channel.axis_in_vertebra
    along = float(np.clip(from_entry @ axis, 0.0, channel.length_mm))
    return float(np.linalg.norm(from_entry - along * axis))

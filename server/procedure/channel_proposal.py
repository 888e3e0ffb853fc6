"""`ChannelProposer`: proposes another planned channel while the drill is nearer to it than to the active one.

Nothing is switched: a person selects the channel (`POST /api/plan/active-channel`).
"""

import threading
from dataclasses import dataclass, field

import numpy as np

from server.live import ProposedChannel
from server.procedure.placement import ChannelState, PlacementStep
from server.procedure.plan import is_same_channel
from tracker.errors import NavigationError
from tracker.geometry import Array
from tracker.navigation import Absent, Assessment, NavigationSnapshot, NearestChannelMonitor
from tracker.plan import Channel
from tracker.plan.document.changes import channel_name


@dataclass(frozen=True, slots=True, kw_only=True)
class _Planned:
    """The active channel, and the others in which no screw was placed, by name."""

    active: Channel | None = None
    others: dict[str, ChannelState] = field(default_factory=dict)


class ChannelProposer:
    """Steps a `NearestChannelMonitor` with each image. Thread-safe.

    Args:
        placement: lists the planned channels.
    """

    def __init__(self, placement: PlacementStep) -> None:
        self._placement = placement
        self._lock = threading.Lock()
        self._monitor = NearestChannelMonitor()
        self._planned = _Planned()

    def refresh(self) -> None:
        """Read the planned channels of the open case again."""
        planned = self._read()
        with self._lock:
            self._planned = planned

    def _read(self) -> _Planned:
        try:
            channels = self._placement.channels()
        except NavigationError:
            # Without a case or a plan there is nothing to propose; its step reports an unreadable plan.
            return _Planned()
        return _Planned(
            active=next((one.channel for one in channels if one.is_active), None),
            others={
                channel_name(one.vertebra, one.side): one
                for one in channels
                if not one.is_active and one.placement is None
            },
        )

    def observe(self, snapshot: NavigationSnapshot) -> ProposedChannel | None:
        """Return the channel to propose with this image, or None."""
        with self._lock:
            active, others = self._planned.active, self._planned.others
            setup = snapshot.setup
            is_current = (
                active is not None
                and not isinstance(setup.channel, Absent)
                and is_same_channel(active, setup.channel)
            )
            if active is None:
                return None
            name = self._monitor.step(
                _tip_in_vertebra_mm(snapshot) if is_current else None,
                snapshot.captured_at_s,
                active=active,
                others={name: one.channel for name, one in others.items()},
            )
            if name is None:
                return None
            state = others[name]
            return ProposedChannel(
                vertebra=state.vertebra, side=state.side, is_registered=state.is_registered
            )


def _tip_in_vertebra_mm(snapshot: NavigationSnapshot) -> Array | None:
    """Return the tip of the displayed tool; None unless its figures are displayed."""
    tool = snapshot.displayed_tool
    if not isinstance(snapshot.assessments.get(tool), Assessment):
        return None
    pose = snapshot.vertebra_from_tool(tool)
    return None if isinstance(pose, Absent) else np.asarray(pose.translation_mm)

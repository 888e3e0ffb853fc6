"""What the drill is held against in the open case: the bone of its CT; until that is measured, the plan."""

import threading
from collections.abc import Callable
from dataclasses import dataclass, replace

import structlog

from server.jobs import Jobs
from server.planning.wall import wall_of
from server.procedure.plan import ActiveChannel, kept_channel
from server.procedure.surface import MAIN_SURFACE
from server.store import CaseStore, Current, Document, DocumentKind
from tracker.errors import NavigationError
from tracker.navigation import Guide, ScrewSize
from tracker.navigation.certainty import Room
from tracker.navigation.clearance import ChosenWall, choose_wall
from tracker.plan import PedicleMeasure, ScrewPlan, plan_from_mapping
from tracker.plan.document.changes import vertebra_named

# What a channel is drilled with, where the wall is judged by whether the plan itself stays within it.
USUAL_RADIUS_MM = 2.0
# How far a threshold puts the bone's surface from where it is: about a third of a usual voxel.
WALL_SD_MM = 0.3

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Planned:
    """What the plan says of the pedicle of the active channel."""

    active: ActiveChannel
    measure: PedicleMeasure | None
    screw: ScrewPlan | None


class Guiding:
    """Makes the guide of the channel that is drilled; safe to use from any thread.

    Args:
        store: where plan and surface are kept.
        jobs: where the distances to the bone are measured.
    """

    def __init__(self, *, store: CaseStore, jobs: Jobs) -> None:
        self._store = store
        self._jobs = jobs
        self._lock = threading.Lock()
        self._made: tuple[tuple[str, ...], Guide] | None = None
        # Called when a better guide is there than was handed out.
        self.tell: Callable[[], None] = lambda: None

    def guide_for(self, active: Document) -> Guide | None:
        """The guide for the channel of this document, the best that is there now; None if it cannot be read.

        Where the case has a surface of the bone, the distances to it are measured in a job, which calls
        `tell` at its end; until then the pedicle's outline is the wall, or the channel.
        """
        surface = self._surface(active.case_id)
        key = (active.id, "" if surface is None else surface.id)
        with self._lock:
            if self._made is not None and self._made[0] == key:
                return self._made[1]
        try:
            planned = self._planned(active)
        except NavigationError as error:
            log.warning(error.message, code=error.code, remedy=error.remedy, document=active.title)
            return None
        plain = choose_wall(planned.active.channel, None, planned.measure, radius_mm=USUAL_RADIUS_MM)
        guide = _guide(planned, plain)
        with self._lock:
            self._made = (key, guide)
        if surface is not None:
            self._measure(key, planned, guide, surface)
        return guide

    def _measure(self, key: tuple[str, ...], planned: _Planned, guide: Guide, surface: Document) -> None:
        def keep(chosen: object) -> object:
            if not isinstance(chosen, ChosenWall):
                raise TypeError(f"a wall gave {type(chosen).__name__}")
            with self._lock:
                if self._made is None or self._made[0] != key:
                    # Another channel is drilled by now, or the bone has another surface.
                    return {"in_use": False}
                self._made = (key, replace(guide, wall=chosen.wall))
            for remark in chosen.remarks:
                log.warning(remark.message, code=remark.code, remedy=remark.remedy)
            self.tell()
            codes = [remark.code for remark in chosen.remarks]
            return {"in_use": True, "against": chosen.wall.against, "remarks": codes}

        try:
            file = self._store.file(surface.case_id, surface.files[0])
        except NavigationError as error:
            log.warning(error.message, code=error.code, remedy=error.remedy, document=surface.title)
            return
        self._jobs.start(
            "measuring the distances to the bone",
            wall_of,
            {
                "path": str(file.path),
                "channel": planned.active.channel,
                "measure": planned.measure,
                "radius_mm": USUAL_RADIUS_MM,
            },
            conclude=keep,
        )

    def _planned(self, active: Document) -> _Planned:
        """What the plan that the choice stands on says of this pedicle."""
        chosen = kept_channel(active)
        plan = self._store.document(active.case_id, active.stands_on[0])
        vertebra = vertebra_named(plan_from_mapping(plan.content), chosen.vertebra)
        measures = [one.measured for one in vertebra.pedicles if one.measured.side == chosen.side]
        screws = [one.screws[0] for one in vertebra.channels if one.side == chosen.side and one.screws]
        return _Planned(
            active=chosen,
            measure=measures[0] if measures else None,
            screw=screws[0] if screws else None,
        )

    def _surface(self, case_id: str) -> Document | None:
        document = self._store.latest(case_id, DocumentKind.SURFACE, MAIN_SURFACE)
        if document is None or not document.files:
            return None
        return document if isinstance(self._store.standing(document), Current) else None


def _guide(planned: _Planned, chosen: ChosenWall) -> Guide:
    screw = planned.screw
    return Guide(
        wall=chosen.wall,
        room=None if screw is None else Room.of_tolerance(screw.tolerance),
        screw=None
        if screw is None
        else ScrewSize(radius_mm=0.5 * screw.diameter_mm, length_mm=screw.length_mm),
        side=planned.active.side,
        wall_sd_mm=WALL_SD_MM,
    )

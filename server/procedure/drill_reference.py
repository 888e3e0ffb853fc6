"""Reference with which the drill is compared: the bone surface, or the plan until the surface is measured."""

import threading
from collections.abc import Callable
from dataclasses import dataclass, replace

import structlog

from server.jobs import Jobs
from server.planning.surface import measure_wall
from server.procedure.plan import ActiveChannel, active_channel_from_document
from server.procedure.surface import MAIN_SURFACE
from server.store import CaseStore, Document, DocumentKind
from tracker.errors import NavigationError
from tracker.navigation import DrillReference, ScrewSize
from tracker.navigation.clearance import WallDistanceField, WallSelection, WallSource, select_wall
from tracker.navigation.uncertainty import PedicleTolerance
from tracker.plan import PedicleMeasure, ScrewPlan, plan_from_mapping
from tracker.plan.document.changes import vertebra_named

# Drill radius for testing whether the plan itself stays within the wall.
USUAL_RADIUS_MM = 2.0
# Standard deviation of a wall that states none, an imported mesh or the plan's outline: a third of a usual
# voxel.
WALL_SD_MM = 0.3

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedPedicle:
    """The planned pedicle and screw of the active channel; None if the plan has none."""

    active: ActiveChannel
    measure: PedicleMeasure | None
    screw: ScrewPlan | None


class DrillReferenceBuilder:
    """Builds the drill reference of the active channel. Thread-safe.

    Args:
        store: source of plan and surface.
        jobs: runs the measurement of the distances to the bone.
    """

    def __init__(self, *, store: CaseStore, jobs: Jobs) -> None:
        self._store = store
        self._jobs = jobs
        self._lock = threading.Lock()
        self._made: tuple[tuple[str, ...], DrillReference] | None = None
        # Called when a better reference is available than the one that was returned.
        self.on_change: Callable[[], None] = lambda: None

    def build(self, active: Document) -> DrillReference | None:
        """Return the best reference available for the channel of this document; None if it cannot be read.

        If the case has a bone surface, a job measures the distances to it and calls `on_change` at its end.
        Until then the wall is the outline of the pedicle, or the channel.
        """
        surface = self._surface(active.case_id)
        key = (active.id, "" if surface is None else surface.id)
        with self._lock:
            if self._made is not None and self._made[0] == key:
                return self._made[1]
        try:
            planned = planned_pedicle(self._store, active)
        except NavigationError as error:
            log.warning(error.message, code=error.code, remedy=error.remedy, document=active.title)
            return None
        plain = select_wall(planned.active.channel, None, planned.measure, radius_mm=USUAL_RADIUS_MM)
        drill_reference = _guide(planned, plain)
        with self._lock:
            self._made = (key, drill_reference)
        if surface is not None:
            self._measure(key, planned, drill_reference, surface)
        return drill_reference

    def bone_wall(self, active: Document) -> WallDistanceField | None:
        """Return the bone around the channel of this document; None if unknown or contradicting the plan."""
        with self._lock:
            made = self._made
        if made is None or made[0][0] != active.id or made[1].wall.against is not WallSource.BONE:
            return None
        return made[1].wall

    def _measure(
        self,
        key: tuple[str, ...],
        planned: PlannedPedicle,
        drill_reference: DrillReference,
        surface: Document,
    ) -> None:
        def keep(chosen: object) -> object:
            if not isinstance(chosen, WallSelection):
                raise TypeError(f"the wall job returned {type(chosen).__name__}")
            with self._lock:
                if self._made is None or self._made[0] != key:
                    # The active channel or the surface has changed since.
                    return {"in_use": False}
                wall_sd_mm = _surface_sd_mm(surface) if chosen.wall.against is WallSource.BONE else WALL_SD_MM
                self._made = (key, replace(drill_reference, wall=chosen.wall, wall_sd_mm=wall_sd_mm))
            for remark in chosen.remarks:
                log.warning(remark.message, code=remark.code, remedy=remark.remedy)
            self.on_change()
            codes = [remark.code for remark in chosen.remarks]
            return {"in_use": True, "against": chosen.wall.against, "remarks": codes}

        try:
            file = self._store.file(surface.case_id, surface.files[0])
        except NavigationError as error:
            log.warning(error.message, code=error.code, remedy=error.remedy, document=surface.title)
            return
        self._jobs.start(
            "measuring the distances to the bone",
            measure_wall,
            {
                "path": str(file.path),
                "channel": planned.active.channel,
                "measure": planned.measure,
                "radius_mm": USUAL_RADIUS_MM,
            },
            conclude=keep,
        )

    def _surface(self, case_id: str) -> Document | None:
        document = self._store.find_current(case_id, DocumentKind.SURFACE, MAIN_SURFACE)
        return document if document is not None and document.files else None


def planned_pedicle(store: CaseStore, active: Document) -> PlannedPedicle:
    """Return pedicle and screw of the active channel from the plan that it depends on.

    Raises:
        PlanError, InvalidInput: the plan or the channel cannot be read.
    """
    chosen = active_channel_from_document(active)
    plan = store.document(active.case_id, active.depends_on[0])
    vertebra = vertebra_named(plan_from_mapping(plan.content), chosen.vertebra)
    pedicle = vertebra.pedicle(chosen.side)
    screws = [one.screws[0] for one in vertebra.channels if one.side == chosen.side and one.screws]
    return PlannedPedicle(
        active=chosen,
        measure=None if pedicle is None else pedicle.used,
        screw=screws[0] if screws else None,
    )


def _surface_sd_mm(surface: Document) -> float:
    """Return the standard deviation of a surface's position; the usual one if its document states none."""
    stated = surface.content.get("sd_mm")
    return float(stated) if isinstance(stated, int | float) else WALL_SD_MM


def _guide(planned: PlannedPedicle, chosen: WallSelection) -> DrillReference:
    screw = planned.screw
    return DrillReference(
        wall=chosen.wall,
        tolerance=None if screw is None else PedicleTolerance.of_tolerance(screw.tolerance),
        screw=None
        if screw is None
        else ScrewSize.of(diameter_mm=screw.diameter_mm, length_mm=screw.length_mm),
        side=planned.active.side,
        wall_sd_mm=WALL_SD_MM,
    )

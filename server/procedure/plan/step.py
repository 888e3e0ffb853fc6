"""Planning step: measures pedicles, places channels and selects screws; each change is a new version."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from server.config import PlanConfig
from server.jobs import Job, Jobs
from server.planning.volume import measure_in_ct
from server.procedure.ct import CtProvider
from server.procedure.labels import LabelProvider
from server.procedure.plan.active_channel import active_channel_document
from server.procedure.plan.clearance import ActiveBone, PlannedClearance, planned_clearances
from server.procedure.plan.repository import PlanRepository, StoredPlan
from server.store import CaseStore, Document
from tracker.errors import PlanError
from tracker.navigation.clearance import WallDistanceField
from tracker.plan import (
    Channel,
    Landmark,
    PlanDocument,
    ScrewCatalogue,
    Volume,
    channel_from_points,
    propose_middle,
    propose_screw,
    propose_slice,
)
from tracker.plan.document import changes, measure_from_mapping, validate_plan
from tracker.plan.pedicle import Side
from tracker.plan.slices import reach_mm

Change: TypeAlias = Callable[[PlanDocument, Volume], PlanDocument]


@dataclass(frozen=True, slots=True, kw_only=True)
class Author:
    """Author of a change, and the version on which it is based; None for the newest."""

    made_by: str
    expected_version: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Proposal:
    """Proposed reference slice of a vertebra.

    Attributes:
        slice_index: Index of the slice, from 0.
        at_mm: Position of the nearest axial slice.
        middle_lps_mm: (3,) midpoint between the isthmuses; None until both are measured.
    """

    slice_index: int
    at_mm: float
    middle_lps_mm: tuple[float, float, float] | None


class PlanStep:
    """Plans on the CT of the open case. Thread-safe.

    Args:
        store: Where the plan is stored.
        jobs: Runs the measurement of pedicles.
        ct_provider: The CT.
        labels: Labels of vertebrae, which pedicles and channels are compared with.
        config: Screw catalogue and margins.
        bone_wall: Returns the bone around the active channel of this document; None while it is unknown.
    """

    def __init__(
        self,
        *,
        store: CaseStore,
        jobs: Jobs,
        ct_provider: CtProvider,
        labels: LabelProvider,
        config: PlanConfig,
        bone_wall: Callable[[Document], WallDistanceField | None],
    ) -> None:
        self.repository = PlanRepository(store, ct_provider, labels)
        self._store = store
        self._bone_wall = bone_wall
        self._jobs = jobs
        self._ct_provider = ct_provider
        self._front_margin_mm = config.front_margin_mm
        self.wall_margin_mm = config.wall_margin_mm
        self.screw_ranges = tuple(config.screw_ranges)
        self.catalogue = ScrewCatalogue(
            diameters_mm=tuple(config.screw_diameters_mm), lengths_mm=tuple(config.screw_lengths_mm)
        )

    def replace(self, plan: PlanDocument, by: Author) -> StoredPlan:
        """Store a complete plan on the present CT; derived values are recomputed.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CT_MISSING.
            StoreConflict: VERSION_CONFLICT.
            PlanError: The plan is invalid on this CT.
        """
        validate_plan(plan)
        ct = self._ct_provider.current()
        whole = changes.recomputed(plan, volume=ct.volume)
        return self.repository.put(whole, ct, made_by=by.made_by, expected_version=by.expected_version)

    def add_vertebra(self, name: str, by: Author) -> StoredPlan:
        """Add a vertebra; raises PlanError PLAN_INVALID if the name exists."""
        return self._change(by, lambda plan, _: _rejected_odd(changes.with_vertebra(plan, name)))

    def remove_vertebra(self, name: str, by: Author) -> StoredPlan:
        """Remove a vertebra; raises PlanError VERTEBRA_UNKNOWN."""
        return self._change(by, lambda plan, _: changes.without_vertebra(plan, name))

    def measure(self, name: str, side: Side, seed_lps_mm: Sequence[float], by: Author) -> Job:
        """Measure the pedicle at a seed point in a job, and add it to the plan.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CT_MISSING.
            OutOfDateError: PLAN_OUT_OF_DATE.
            PlanError: VERTEBRA_UNKNOWN.
        """
        plan, _, ct = self.repository.for_editing()
        changes.vertebra_named(plan, name)
        measured_on = ct.document.id

        def keep(values: object) -> object:
            measure = measure_from_mapping(values)

            def put(now: PlanDocument, volume: Volume) -> PlanDocument:
                if self._ct_provider.current().document.id != measured_on:
                    raise PlanError(
                        "CT_CHANGED",
                        "the CT was replaced during the measurement of the pedicle; nothing was stored",
                        "Click on the pedicle in the new CT.",
                    )
                return changes.with_measure(
                    now, name, measure, volume=volume, front_margin_mm=self._front_margin_mm
                )

            self.repository.check_measure(name, measure)
            stored = self._change(by, put)
            return {"version": stored.document.version, "vertebra": name, "side": side, "pedicle": values}

        return self._jobs.start(
            f"measuring the {side} pedicle",
            measure_in_ct,
            {
                "path": str(ct.file.path),
                "lps_from_ijk": ct.document.content["lps_from_ijk"],
                "seed_lps_mm": list(seed_lps_mm),
                "side": side,
            },
            conclude=keep,
        )

    def correct(self, name: str, side: Side, corrected: Mapping[str, float], by: Author) -> StoredPlan:
        """Store corrections of measured values; an empty mapping removes all corrections."""
        return self._change(
            by,
            lambda plan, volume: changes.with_corrections(
                plan, name, side, corrected, volume=volume, front_margin_mm=self._front_margin_mm
            ),
        )

    def lay_channel(
        self, name: str, side: Side, ends: tuple[Sequence[float], Sequence[float], float] | None, by: Author
    ) -> StoredPlan:
        """Place the channel of the measured pedicle, or set it by hand: ends in LPS mm, diameter in mm.

        A channel along the pedicle gets the proposed screw, unless it has one or none fits.
        """
        channel: Channel | None = None
        if ends is not None:
            channel = channel_from_points(
                changes.channel_name(name, side),
                entry_lps_mm=ends[0],
                target_lps_mm=ends[1],
                diameter_mm=ends[2],
            )

        def laid(plan: PlanDocument, volume: Volume) -> PlanDocument:
            changed = _rejected_odd(
                changes.with_channel(
                    plan, name, side, channel, volume=volume, front_margin_mm=self._front_margin_mm
                )
            )
            vertebra = changes.vertebra_named(changed, name)
            if ends is not None or changes.channel_of(vertebra, side).screws:
                return changed
            try:
                size_mm = self._proposed(changed, name, side)
            except PlanError as error:
                if error.code != "NO_SCREW_FITS":
                    raise
                return changed
            return changes.with_screw(changed, name, side, size_mm, volume=volume)

        return self._change(by, laid)

    def remove_channel(self, name: str, side: Side, by: Author) -> StoredPlan:
        """Remove the channel of this side; raises PlanError CHANNEL_MISSING."""
        return self._change(by, lambda plan, volume: changes.without_channel(plan, name, side, volume=volume))

    def propose_screw(self, name: str, side: Side) -> tuple[float, float]:
        """Return diameter and length of the largest screw of the catalogue that keeps the margins.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING.
            PlanError: CHANNEL_MISSING, PEDICLE_MISSING, NO_SCREW_FITS.
        """
        return self._proposed(self.repository.latest().plan, name, side)

    def choose_screw(
        self, name: str, side: Side, size_mm: tuple[float, float] | None, by: Author
    ) -> StoredPlan:
        """Select a screw of the catalogue for this channel; by default the proposed one.

        Raises:
            PlanError: SCREW_NOT_IN_CATALOGUE, NO_SCREW_FITS, CHANNEL_MISSING, PEDICLE_MISSING.
        """
        if size_mm is not None:
            self._reject_strange(size_mm)
        return self._change(
            by,
            lambda plan, volume: changes.with_screw(
                plan, name, side, size_mm or self._proposed(plan, name, side), volume=volume
            ),
        )

    def remove_screw(self, name: str, side: Side, by: Author) -> StoredPlan:
        """Remove the screw of this channel; raises PlanError CHANNEL_MISSING."""
        return self._change(
            by, lambda plan, volume: changes.with_screw(plan, name, side, None, volume=volume)
        )

    def clearances(self) -> tuple[StoredPlan, Sequence[PlannedClearance]]:
        """Return the newest plan and the clearance of each screw in it, by depth.

        Raises:
            SetupOrderError: NO_CASE_OPEN, PLAN_MISSING.
        """
        stored = self.repository.latest()
        return stored, tuple(planned_clearances(stored.plan, self._active_bone(stored)))

    def _active_bone(self, stored: StoredPlan) -> ActiveBone | None:
        document = active_channel_document(self._store, stored.document.case_id)
        wall = None if document is None else self._bone_wall(document)
        if stored.active is None or wall is None:
            return None
        return ActiveBone(active=stored.active, wall=wall)

    def propose_slice(self, name: str) -> Proposal:
        """Return the slice nearest to the isthmuses of a vertebra; raises PlanError NO_PEDICLE_MEASURED."""
        volume = self._ct_provider.current().volume
        vertebra = changes.vertebra_named(self.repository.latest().plan, name)
        measures = [record.used for record in vertebra.pedicles]
        index = propose_slice(volume, measures)
        centre = volume.lps_from_index((np.array(volume.shape_ijk) - 1.0) / 2.0 * [1, 1, 0] + [0, 0, index])
        low, high, _ = reach_mm(volume, "axial")
        middle = propose_middle(measures) if len(measures) > 1 else None
        return Proposal(
            slice_index=index,
            at_mm=float(np.clip(centre[2], low, high)),
            middle_lps_mm=None if middle is None else (float(middle[0]), float(middle[1]), float(middle[2])),
        )

    def choose_slice(
        self,
        name: str,
        *,
        slice_index: int | None,
        middle_lps_mm: Sequence[float] | None,
        apart_mm: float,
        by: Author,
    ) -> StoredPlan:
        """Set the reference slice of a vertebra with its lines; omitted values are those proposed.

        Raises:
            PlanError: NO_PEDICLE_MEASURED, MIDDLE_UNKNOWN, SLICE_OUTSIDE_CT, LINES_INVALID or
                MIDDLE_OUTSIDE_CT.
        """

        def change(plan: PlanDocument, volume: Volume) -> PlanDocument:
            measures = [record.used for record in changes.vertebra_named(plan, name).pedicles]
            return changes.with_reference(
                plan,
                name,
                volume=volume,
                slice_index=propose_slice(volume, measures) if slice_index is None else slice_index,
                middle_lps_mm=propose_middle(measures) if middle_lps_mm is None else middle_lps_mm,
                apart_mm=apart_mm,
            )

        return self._change(by, change)

    def set_landmarks(self, name: str, landmarks: Sequence[Landmark], by: Author) -> StoredPlan:
        """Replace all landmarks; raises PlanError LANDMARK_TWICE or LANDMARK_OUTSIDE_CT."""
        return self._change(
            by,
            lambda plan, volume: _rejected_odd(changes.with_landmarks(plan, name, landmarks, volume=volume)),
        )

    def _change(self, by: Author, change: Change) -> StoredPlan:
        return self.repository.change(
            by.made_by, by.expected_version, lambda plan, ct: change(plan, ct.volume)
        )

    def _proposed(self, plan: PlanDocument, name: str, side: Side) -> tuple[float, float]:
        vertebra = changes.vertebra_named(plan, name)
        return propose_screw(
            changes.channel_of(vertebra, side).channel,
            changes.pedicle_of(vertebra, side).used,
            self.catalogue,
            wall_margin_mm=self.wall_margin_mm,
            front_margin_mm=self._front_margin_mm,
        )

    def _reject_strange(self, size_mm: tuple[float, float]) -> None:
        catalogue = self.catalogue
        if size_mm[0] not in catalogue.diameters_mm or size_mm[1] not in catalogue.lengths_mm:
            raise PlanError(
                "SCREW_NOT_IN_CATALOGUE",
                f"the catalogue has no screw of {size_mm[0]:g} x {size_mm[1]:g} mm",
                f"Choose a diameter of {_reported(catalogue.diameters_mm)} and a length of "
                f"{_reported(catalogue.lengths_mm)} mm, or add this size under plan in the settings.",
                {
                    "diameter_mm": size_mm[0],
                    "length_mm": size_mm[1],
                    "diameters": _reported(catalogue.diameters_mm),
                    "lengths": _reported(catalogue.lengths_mm),
                },
            )


def _rejected_odd(plan: PlanDocument) -> PlanDocument:
    validate_plan(plan)
    return plan


def _reported(numbers: Sequence[float]) -> str:
    return ", ".join(f"{number:g}" for number in numbers)

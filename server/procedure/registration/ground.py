"""What a registration is made on: the plan's vertebra, the camera, the tool that touches, and the anchor."""

from collections.abc import Sequence
from dataclasses import dataclass

from server.live import LiveHub
from server.procedure.camera import MAIN_CAMERA
from server.procedure.opened import opened_case
from server.procedure.plan import PlanRepository
from server.procedure.state import Brought, Procedure, StepName
from server.store import CaseStore, Current, Document, DocumentKind, OutOfDateError
from tracker.errors import InvalidInput, PlanError
from tracker.geometry import Array
from tracker.plan import Landmark
from tracker.plan.document import VertebraPlan
from tracker.plan.document.changes import vertebra_named
from tracker.registration import AnchoredTo


@dataclass(frozen=True, slots=True, kw_only=True)
class Ground:
    """All that a registration stands on, as it was when it was begun.

    Attributes:
        case_id: the case.
        vertebra: that is registered, as planned.
        tool: that touches; empty where none does.
        reference: the marker on the patient; empty where there is none.
        documents: ids of plan, camera and tool, as far as the case has them.
    """

    case_id: str
    vertebra: VertebraPlan
    tool: str
    reference: str
    documents: tuple[str, ...]

    @property
    def anchored_to(self) -> AnchoredTo:
        """What the registration will be fixed to."""
        return AnchoredTo.REFERENCE if self.reference else AnchoredTo.CAMERA

    @property
    def entries_mm(self) -> tuple[Array, ...]:
        """Entry points of the vertebra's channels, LPS."""
        return tuple(one.channel.entry_in_vertebra_mm for one in self.vertebra.channels)

    def landmark(self, name: str) -> Landmark:
        """One of the vertebra's landmarks.

        Raises:
            PlanError: LANDMARK_UNKNOWN.
        """
        return landmark_named(self.vertebra.landmarks, name)


class GroundFinder:
    """Finds what a registration is made on in the open case. Safe to use from any thread.

    Args:
        store: where cases are kept.
        hub: the live images, which say what tools are in use.
        plans: the plan of the open case.
        procedure: what may follow what.
        brought: by the settings.
    """

    def __init__(
        self, store: CaseStore, *, hub: LiveHub, plans: PlanRepository, procedure: Procedure, brought: Brought
    ) -> None:
        self._store = store
        self._hub = hub
        self._plans = plans
        self._procedure = procedure
        self._brought = brought

    def find(self, *, vertebra: str | None, tool: str | None, step: StepName = StepName.REGISTER) -> Ground:
        """The ground to do a step on, if all earlier ones hold.

        Args:
            vertebra: its name in the plan; the one that is to be drilled if None.
            tool: that touches; None where none does.
            step: that is to be done.

        Raises:
            SetupOrderError: NO_CASE_OPEN, or what the step waits for.
            PlanError: VERTEBRA_UNKNOWN.
            InvalidInput: TOOL_UNKNOWN.
        """
        self._procedure.state().reject_before(step)
        case = opened_case(self._store)
        kept = self._plans.latest_that_holds()
        name = vertebra or self._procedure.active_vertebra(case.id) or ""
        planned = vertebra_named(kept.plan, name)
        if tool is not None:
            self._reject_unknown(tool)
        camera = self._current(case.id, DocumentKind.CAMERA, MAIN_CAMERA)
        of_tool = None if tool is None else self._current(case.id, DocumentKind.TOOL, tool)
        return Ground(
            case_id=case.id,
            vertebra=planned,
            tool=tool or "",
            reference=self._brought.reference,
            documents=tuple(one.id for one in (kept.document, camera, of_tool) if one is not None),
        )

    def reject_changed(self, ground: Ground) -> None:
        """Refuse to keep what was begun on something that was changed meanwhile.

        Raises:
            SetupOrderError: NO_CASE_OPEN, or what the registration waits for.
            OutOfDateError: REGISTRATION_GROUND_CHANGED.
        """
        now = self.find(vertebra=ground.vertebra.name, tool=ground.tool or None)
        if (now.case_id, now.documents) != (ground.case_id, ground.documents):
            raise OutOfDateError(
                "REGISTRATION_GROUND_CHANGED",
                "the case, its plan, its camera or its tool was changed since this registration was begun",
                "Begin the registration again, on what holds now.",
                {"began_on": list(ground.documents), "now": list(now.documents)},
            )

    def _reject_unknown(self, tool: str) -> None:
        newest = self._hub.newest
        known = {} if newest is None or newest.snapshot is None else newest.snapshot.setup.tools
        if newest is not None and newest.snapshot is not None and tool not in known:
            raise InvalidInput(
                "TOOL_UNKNOWN",
                f"there is no tool '{tool}' in use",
                f"Known are: {', '.join(sorted(known)) or 'none'}; calibrate its tip and axis first.",
                {"tool": tool},
            )

    def _current(self, case_id: str, kind: DocumentKind, name: str) -> Document | None:
        document = self._store.latest(case_id, kind, name)
        if document is None or not isinstance(self._store.standing(document), Current):
            return None
        return document


def landmark_named(landmarks: Sequence[Landmark], name: str) -> Landmark:
    """The landmark of this name.

    Raises:
        PlanError: LANDMARK_UNKNOWN.
    """
    for one in landmarks:
        if one.name == name:
            return one
    raise PlanError(
        "LANDMARK_UNKNOWN",
        f"the vertebra has no landmark '{name[:60]}'",
        f"Known are: {', '.join(one.name for one in landmarks) or 'none'}; landmarks are set in the plan.",
        {"landmark": name[:60]},
    )

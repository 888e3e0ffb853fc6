"""Context of a registration: the planned vertebra, camera, tool, and the anchor frame."""

from collections.abc import Sequence
from dataclasses import dataclass

from server.live import LiveHub
from server.procedure.camera import MAIN_CAMERA
from server.procedure.open_case import require_open_case
from server.procedure.plan import PlanRepository
from server.procedure.state import Procedure, SetupDefaults, StepName
from server.store import CaseStore, DocumentKind, OutOfDateError
from tracker.errors import InvalidInput, PlanError
from tracker.geometry import Array
from tracker.plan import Landmark
from tracker.plan.document import VertebraPlan
from tracker.plan.document.changes import vertebra_named
from tracker.registration import AnchoredTo


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationContext:
    """Everything that a registration depends on, as it was at its start.

    Attributes:
        case_id: the case.
        vertebra: the planned vertebra.
        tool: tool whose tip captures points; empty if none is used.
        reference: the reference marker on the patient; empty if there is none.
        documents: ids of plan, camera and tool, as far as the case has them.
    """

    case_id: str
    vertebra: VertebraPlan
    tool: str
    reference: str
    documents: tuple[str, ...]

    @property
    def anchored_to(self) -> AnchoredTo:
        """The frame that the registration is anchored to."""
        return AnchoredTo.REFERENCE if self.reference else AnchoredTo.CAMERA

    @property
    def entries_mm(self) -> tuple[Array, ...]:
        """Entry points (3,) of the vertebra's channels, LPS mm."""
        return tuple(one.channel.entry_in_vertebra_mm for one in self.vertebra.channels)

    def landmark(self, name: str) -> Landmark:
        """Return a landmark of the vertebra by name.

        Raises:
            PlanError: LANDMARK_UNKNOWN.
        """
        return landmark_named(self.vertebra.landmarks, name)


class RegistrationContextFinder:
    """Finds the context of a registration in the open case. Thread-safe.

    Args:
        store: the case store.
        hub: the live images, with the tools in use.
        plans: the plan of the open case.
        procedure: state of the procedure.
        defaults: setup from the settings.
    """

    def __init__(
        self,
        store: CaseStore,
        *,
        hub: LiveHub,
        plans: PlanRepository,
        procedure: Procedure,
        defaults: SetupDefaults,
    ) -> None:
        self._store = store
        self._hub = hub
        self._plans = plans
        self._procedure = procedure
        self._defaults = defaults

    def find(
        self, *, vertebra: str | None, tool: str | None, step: StepName = StepName.REGISTER
    ) -> RegistrationContext:
        """Return the context of a step, if all earlier steps are valid.

        Args:
            vertebra: Name of the vertebra in the plan; None for that of the active channel.
            tool: Tool whose tip captures points; None if none is used.
            step: The step to be done.

        Raises:
            SetupOrderError: NO_CASE_OPEN, or the code of a missing earlier step.
            PlanError: VERTEBRA_UNKNOWN.
            InvalidInput: TOOL_UNKNOWN.
        """
        self._procedure.state().require_earlier_steps(step)
        case = require_open_case(self._store)
        stored = self._plans.latest_valid()
        name = vertebra or self._procedure.active_vertebra(case.id) or ""
        planned = vertebra_named(stored.plan, name)
        if tool is not None:
            self._reject_unknown(tool)
        camera = self._store.find_current(case.id, DocumentKind.CAMERA, MAIN_CAMERA)
        of_tool = None if tool is None else self._store.find_current(case.id, DocumentKind.TOOL, tool)
        return RegistrationContext(
            case_id=case.id,
            vertebra=planned,
            tool=tool or "",
            reference=self._defaults.reference,
            documents=tuple(one.id for one in (stored.document, camera, of_tool) if one is not None),
        )

    def reject_changed(self, context: RegistrationContext) -> None:
        """Raise if the context has changed since the registration was started.

        Raises:
            SetupOrderError: NO_CASE_OPEN, or the code of a missing earlier step.
            OutOfDateError: REGISTRATION_CONTEXT_CHANGED.
        """
        now = self.find(vertebra=context.vertebra.name, tool=context.tool or None)
        if (now.case_id, now.documents) != (context.case_id, context.documents):
            raise OutOfDateError(
                "REGISTRATION_CONTEXT_CHANGED",
                "case, plan, camera or tool has changed since this registration was started",
                "Start the registration again with the current plan, camera and tool.",
                {"began_on": list(context.documents), "now": list(now.documents)},
            )

    def _reject_unknown(self, tool: str) -> None:
        newest = self._hub.newest
        known = {} if newest is None or newest.snapshot is None else newest.snapshot.setup.tools
        if newest is not None and newest.snapshot is not None and tool not in known:
            tools = ", ".join(sorted(known)) or "none"
            raise InvalidInput(
                "TOOL_UNKNOWN",
                f"there is no tool '{tool}' in use",
                f"Available tools: {tools}. Calibrate tip and axis first.",
                {"tool": tool, "tools": tools},
            )


def landmark_named(landmarks: Sequence[Landmark], name: str) -> Landmark:
    """Return the landmark of this name.

    Raises:
        PlanError: LANDMARK_UNKNOWN.
    """
    for one in landmarks:
        if one.name == name:
            return one
    names = ", ".join(one.name for one in landmarks) or "none"
    raise PlanError(
        "LANDMARK_UNKNOWN",
        f"the vertebra has no landmark '{name[:60]}'",
        f"Existing landmarks: {names}. Set them in the plan.",
        {"landmark": name[:60], "landmarks": names},
    )

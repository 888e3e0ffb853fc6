"""The state of the procedure as the open case has it now."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime

from server.clock import utc_now
from server.config import CosignConfig, RegistrationConfig
from server.procedure.camera import ACCURACY, MAIN_CAMERA, kept_camera
from server.procedure.confirmed import (
    ConfirmationNeeded,
    believed_from_s,
    confirmation_name,
    confirmation_needed,
    kept_confirmation,
)
from server.procedure.plan import ACTIVE_CHANNEL, kept_channel
from server.procedure.plan.kept import MAIN_PLAN
from server.procedure.registered import KeptRegistration, check_name, kept_check, kept_registration
from server.procedure.state.checked import CHECK, check_finding, minutes_since
from server.procedure.state.cosigned import lacking
from server.procedure.state.judged import ProcedureState, judged, no_case
from server.procedure.state.records import Finding, StepName, StepState
from server.procedure.tool import kept_tool
from server.store import CaseStore, Current, Document, DocumentKind
from tracker.errors import NavigationError
from tracker.plan import plan_from_mapping
from tracker.plan.document.changes import vertebra_named

NOT_DONE = {
    DocumentKind.CAMERA: "the camera is not calibrated",
    DocumentKind.TOOL: "the tool '{name}' is not calibrated",
    DocumentKind.PLAN: "nothing is planned",
    DocumentKind.REGISTRATION: "{name} is not registered",
}
CALIBRATE = "Calibrate the camera: collect views of the board."
PIVOT = "Calibrate the tool: pivot it, and gather its poses."
CHOOSE = "Choose in the plan the channel that is to be drilled."
REGISTER = "Register: touch the landmarks of the plan."


@dataclass(frozen=True, slots=True, kw_only=True)
class Brought:
    """What the settings bring, whatever the case has.

    Attributes:
        source: of the camera, in words.
        has_camera: whether they name a camera's calibration.
        tools: that they describe.
        reference: the marker that is fixed to the patient; empty where there is none.
    """

    source: str
    reference: str = ""
    has_camera: bool = False
    tools: frozenset[str] = frozenset()


class Procedure:
    """Reads the state of the procedure; safe to use from any thread.

    Args:
        store: where cases are kept.
        brought: what the settings bring.
        gate: the limits of registration and check.
        run: names this run of the server.
        tracked_from_s: since when the tracking process of now runs, by the images' clock.
        cosign: what a second person must have signed.
        clock: the wall clock, in UTC.
    """

    def __init__(
        self,
        store: CaseStore,
        *,
        brought: Brought,
        gate: RegistrationConfig,
        run: str,
        tracked_from_s: Callable[[], float] = lambda: -math.inf,
        cosign: CosignConfig | None = None,
        clock: Callable[[], datetime] = utc_now,
    ) -> None:
        self._store = store
        self._brought = brought
        self._gate = gate
        self.run = run
        self._tracked_from_s = tracked_from_s
        self.cosign = cosign or CosignConfig()
        self._clock = clock

    def state(self) -> ProcedureState:
        """How every step stands now."""
        case = self._store.opened()
        required = self._gate.check_required
        if case is None:
            return no_case(check_required=required)
        vertebra = self.active_vertebra(case.id)
        findings = {
            StepName.CAMERA: self._camera(case.id),
            StepName.TOOL: self._tool(case.id),
            StepName.PLAN: self._plan(case.id),
            StepName.REGISTER: self._registration(case.id, vertebra),
            StepName.CHECK: self._check(case.id, vertebra),
        }
        state = judged(
            case.id,
            findings,
            check_required=required,
            confirmation=self._confirmation(case.id, vertebra),
            lacks=lacking(self._store, case.id, findings, self.cosign),
        )
        return replace(state, case_name=case.name)

    def believed_from_s(self, registration: KeptRegistration, case_id: str) -> float | None:
        """When a person last touched, checked or confirmed what is registered; None before this run."""
        name = registration.vertebra
        check = self._current(case_id, DocumentKind.CHECK, check_name(name))
        confirmation = self._current(case_id, DocumentKind.CONFIRMATION, confirmation_name(name))
        try:
            return believed_from_s(
                registration,
                None if check is None else kept_check(check),
                None if confirmation is None else kept_confirmation(confirmation),
                run=self.run,
            )
        except NavigationError:
            # What cannot be read was said by nobody.
            return None

    def _confirmation(self, case_id: str, vertebra: str | None) -> ConfirmationNeeded | None:
        document = None if vertebra is None else self._current(case_id, DocumentKind.REGISTRATION, vertebra)
        if document is None:
            return None
        try:
            kept = kept_registration(document, reference=self._brought.reference)
        except NavigationError:
            return None
        return confirmation_needed(
            kept,
            document,
            believed_s=self.believed_from_s(kept, case_id),
            tracked_from_s=self._tracked_from_s(),
        )

    def active_vertebra(self, case_id: str) -> str | None:
        """The vertebra whose channel is to be drilled now."""
        document = self._store.latest(case_id, DocumentKind.PLAN, ACTIVE_CHANNEL)
        if document is None or not isinstance(self._store.standing(document), Current):
            return None
        try:
            return kept_channel(document).vertebra
        except NavigationError:
            return None

    def _camera(self, case_id: str) -> Finding:
        found = self._found(case_id, DocumentKind.CAMERA, MAIN_CAMERA, remedy=CALIBRATE)
        if isinstance(found, Finding):
            if found.state is StepState.MISSING and self._brought.has_camera:
                return Finding(state=StepState.DONE, said="the settings bring the camera's calibration")
            return found
        try:
            kept_camera(found, source=self._brought.source)
        except NavigationError as error:
            return _unusable(found, error)
        report = found.content.get("report")
        rms_px = report.get("rms_px") if isinstance(report, dict) else None
        accuracy = self._current(case_id, DocumentKind.CHECK, ACCURACY)
        numbers = {"rms_px": rms_px}
        if accuracy is None:
            return _done(found, "the camera is calibrated", numbers)
        most, error_mm = accuracy.content.get("limit_mm"), accuracy.content.get("maximum_error_mm")
        numbers = {**numbers, "maximum_error_mm": _number(error_mm), "limit_mm": _number(most)}
        if accuracy.content.get("passed") is True:
            return _done(found, "the camera is calibrated and its accuracy checked", numbers)
        return Finding(
            state=StepState.FAILED,
            said=f"the camera measures a known distance wrong by {error_mm} mm, allowed {most} mm",
            remedy="Check the accuracy again on a flat board, or calibrate the camera again.",
            numbers=numbers,
            document_id=accuracy.id,
        )

    def _tool(self, case_id: str) -> Finding:
        known = dict.fromkeys(self._brought.tools)
        lost: list[Finding] = []
        documents = self._store.all(case_id, DocumentKind.TOOL)
        numbers: dict[str, float | None] = {}
        for document in documents:
            found = self._found(case_id, DocumentKind.TOOL, document.name, remedy=PIVOT)
            if isinstance(found, Finding):
                lost.append(found)
                continue
            try:
                kept = kept_tool(found)
            except NavigationError as error:
                lost.append(_unusable(found, error))
                continue
            if kept.model(found.name) is None:
                lost.append(_axis_missing(found))
                continue
            known[found.name] = None
            numbers[f"{found.name}_rms_3d_mm"] = kept.pivot.rms_3d_mm
        if known:
            return Finding(
                state=StepState.DONE, said=f"calibrated: {', '.join(sorted(known))}", numbers=numbers
            )
        return (
            lost[0] if lost else Finding(state=StepState.MISSING, said="no tool is calibrated", remedy=PIVOT)
        )

    def _plan(self, case_id: str) -> Finding:
        found = self._found(
            case_id,
            DocumentKind.PLAN,
            MAIN_PLAN,
            remedy="Plan on the CT: send it, and name a vertebra.",
        )
        if isinstance(found, Finding):
            return found
        vertebra = self.active_vertebra(case_id)
        if vertebra is None:
            return Finding(
                state=StepState.MISSING,
                said="no channel is chosen to be drilled now",
                remedy=CHOOSE,
                document_id=found.id,
            )
        try:
            planned = vertebra_named(plan_from_mapping(found.content), vertebra)
        except NavigationError as error:
            return _unusable(found, error)
        return _done(
            found, f"a channel of {vertebra} is to be drilled", {"landmarks": len(planned.landmarks)}
        )

    def _registration(self, case_id: str, vertebra: str | None) -> Finding:
        if vertebra is None:
            return Finding(
                state=StepState.MISSING, said="it is not said which vertebra is to be drilled", remedy=CHOOSE
            )
        found = self._found(case_id, DocumentKind.REGISTRATION, vertebra, remedy=REGISTER)
        if isinstance(found, Finding):
            return found
        try:
            kept = kept_registration(found, reference=self._brought.reference)
        except NavigationError as error:
            return _unusable(found, error)
        numbers = {
            "method": kept.method.value,
            "anchored_to": kept.anchored_to.value,
            "age_min": minutes_since(found.made_at, self._clock()),
            **kept.numbers,
        }
        return _done(found, f"{vertebra} is registered by {kept.method.value}", numbers)

    def _check(self, case_id: str, vertebra: str | None) -> Finding:
        registration = (
            None if vertebra is None else self._current(case_id, DocumentKind.REGISTRATION, vertebra)
        )
        if vertebra is None or registration is None:
            return Finding(
                state=StepState.MISSING, said="there is no registration to be checked", remedy=REGISTER
            )
        try:
            kept = kept_registration(registration, reference=self._brought.reference)
        except NavigationError as error:
            return _unusable(registration, error)
        history = self._store.history(case_id, DocumentKind.CHECK, check_name(vertebra))
        withdrawn = history[-1].withdrawn if history else None
        if withdrawn is not None and registration.id in history[-1].stands_on:
            return Finding(
                state=StepState.OUT_OF_DATE,
                said=f"the check was withdrawn by {withdrawn.by}: {withdrawn.reason}",
                remedy=CHECK,
                document_id=history[-1].id,
            )
        return check_finding(
            registration=kept,
            title=registration.title,
            check=self._current(case_id, DocumentKind.CHECK, check_name(vertebra)),
            run=self.run,
            again_after_min=self._gate.check_again_after_min,
            now=self._clock(),
        )

    def _current(self, case_id: str, kind: DocumentKind, name: str) -> Document | None:
        document = self._store.latest(case_id, kind, name)
        if document is None or not isinstance(self._store.standing(document), Current):
            return None
        return document

    def _found(self, case_id: str, kind: DocumentKind, name: str, *, remedy: str) -> Document | Finding:
        """The newest document if it holds; else what keeps it from it."""
        history = self._store.history(case_id, kind, name)
        if not history:
            return Finding(state=StepState.MISSING, said=NOT_DONE[kind].format(name=name), remedy=remedy)
        standing = self._store.standing(history[-1])
        if isinstance(standing, Current):
            return history[-1]
        return Finding(
            state=StepState.OUT_OF_DATE, said=standing.reason, remedy=remedy, document_id=history[-1].id
        )


def _done(document: Document, said: str, numbers: dict[str, float | int | bool | str | None]) -> Finding:
    return Finding(state=StepState.DONE, said=said, numbers=numbers, document_id=document.id)


def _unusable(document: Document, error: NavigationError) -> Finding:
    return Finding(
        state=StepState.OUT_OF_DATE, said=error.message, remedy=error.remedy, document_id=document.id
    )


def _axis_missing(document: Document) -> Finding:
    return Finding(
        state=StepState.MISSING,
        said=f"nobody knows which way '{document.name}' points",
        remedy="Spin the tool about its axis.",
        document_id=document.id,
    )


def _number(value: object) -> float | None:
    return float(value) if isinstance(value, int | float) else None

"""The state of the procedure, read from the documents of the open case."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime

from server.clock import utc_now
from server.config import CalibrationConfig, CosignConfig, RegistrationConfig
from server.procedure.camera import ACCURACY, MAIN_CAMERA, camera_from_document
from server.procedure.confirmation import (
    ConfirmationPrompt,
    confirmation_from_document,
    confirmation_name,
    confirmation_prompt,
    confirmed_from_s,
)
from server.procedure.labels import LabelProvider
from server.procedure.plan import active_channel_document, active_channel_from_document
from server.procedure.plan.repository import MAIN_PLAN
from server.procedure.registration_record import (
    RegistrationRecord,
    check_from_document,
    check_name,
    registration_from_document,
)
from server.procedure.state.check_finding import age_min, check_finding
from server.procedure.state.cosignatures import missing_cosignatures
from server.procedure.state.procedure_state import ProcedureState, derive_state, no_case
from server.procedure.state.records import Finding, StepName, StepState
from server.procedure.tool import tool_from_document
from server.store import CaseStore, Current, Document, DocumentKind, Heading, OutOfDate, Validity
from server.texts import METHODS, Reason, reason, reason_of_error, withdrawal_text
from tracker.errors import NavigationError
from tracker.plan import plan_from_mapping
from tracker.plan.document.changes import vertebra_named
from tracker.plan.labels import check_channel


@dataclass(frozen=True, slots=True, kw_only=True)
class SetupDefaults:
    """The part of the setup that the settings provide, independent of the case.

    Attributes:
        source: name of the camera source.
        has_camera: whether they provide a camera calibration.
        has_images: whether the source is a camera; an external tracker needs no calibration.
        has_plan: whether a rehearsal provides its own plan and registration, used until a channel of the case
            is selected.
        tools: names of the configured tools.
        reference: the reference marker on the patient; empty if there is none.
        max_rms_px: RMS of a calibration above which a warning is shown.
    """

    source: str
    max_rms_px: float = CalibrationConfig().max_rms_px
    reference: str = ""
    has_camera: bool = False
    has_images: bool = True
    has_plan: bool = False
    tools: frozenset[str] = frozenset()

    def registration_from(self, document: Document) -> RegistrationRecord:
        """Parse a registration that is to be used with this setup; see `registration_from_document`."""
        return registration_from_document(document, reference=self.reference, has_images=self.has_images)


class Procedure:
    """Reads the state of the procedure. Thread-safe.

    Args:
        store: the case store.
        defaults: setup from the settings.
        gate: acceptance limits of registration and check.
        run: name of this run of the server.
        tracked_from_s: start of the current tracking process, on the image clock.
        cosign: which documents require a co-signature.
        clock: the wall clock, in UTC.
        seconds: the image clock, plus the computer's sleep.
    """

    def __init__(
        self,
        store: CaseStore,
        *,
        labels: LabelProvider,
        defaults: SetupDefaults,
        gate: RegistrationConfig,
        run: str,
        tracked_from_s: Callable[[], float] = lambda: -math.inf,
        cosign: CosignConfig | None = None,
        clock: Callable[[], datetime] = utc_now,
        seconds: Callable[[], float] = time.monotonic,
    ) -> None:
        self._store = store
        self._labels = labels
        self._defaults = defaults
        self._gate = gate
        self.run = run
        self._tracked_from_s = tracked_from_s
        self.cosign = cosign or CosignConfig()
        self._clock = clock
        self._seconds = seconds

    def state(self) -> ProcedureState:
        """Return the current state of all steps."""
        case = self._store.get_open_case()
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
        state = derive_state(
            case.id,
            findings,
            check_required=required,
            confirmation=self._confirmation(case.id, vertebra),
            missing_cosignature=missing_cosignatures(self._store, case.id, findings, self.cosign),
        )
        return replace(state, case_name=case.name)

    def confirmed_from_s(self, registration: RegistrationRecord, case_id: str) -> float | None:
        """Return when the registration was last captured, checked or confirmed; None before this run."""
        name = registration.vertebra
        check = self._store.find_current(case_id, DocumentKind.CHECK, check_name(name))
        confirmation = self._store.find_current(case_id, DocumentKind.CONFIRMATION, confirmation_name(name))
        try:
            return confirmed_from_s(
                registration,
                None if check is None else check_from_document(check),
                None if confirmation is None else confirmation_from_document(confirmation),
                run=self.run,
            )
        except NavigationError:
            # An unreadable check or confirmation does not count.
            return None

    def _confirmation(self, case_id: str, vertebra: str | None) -> ConfirmationPrompt | None:
        document = (
            None
            if vertebra is None
            else self._store.find_current(case_id, DocumentKind.REGISTRATION, vertebra)
        )
        if document is None:
            return None
        try:
            record = self._defaults.registration_from(document)
        except NavigationError:
            return None
        return confirmation_prompt(
            record,
            document,
            believed_s=self.confirmed_from_s(record, case_id),
            tracked_from_s=self._tracked_from_s(),
        )

    def active_vertebra(self, case_id: str) -> str | None:
        """Return the vertebra of the active channel."""
        document = active_channel_document(self._store, case_id)
        if document is None:
            return None
        try:
            return active_channel_from_document(document).vertebra
        except NavigationError:
            return None

    def _camera(self, case_id: str) -> Finding:
        if not self._defaults.has_images:
            return Finding(state=StepState.DONE, reason=reason("EXTERNAL_TRACKER"))
        found = self._found(
            case_id, DocumentKind.CAMERA, MAIN_CAMERA, missing=reason("CAMERA_NOT_CALIBRATED")
        )
        if isinstance(found, Finding):
            if found.state is StepState.MISSING and self._defaults.has_camera:
                return Finding(state=StepState.DONE, reason=reason("CAMERA_IN_SETTINGS"))
            return found
        try:
            camera_from_document(found, source=self._defaults.source)
        except NavigationError as error:
            return _unusable(found, error)
        report = found.content.get("report")
        rms_px = report.get("rms_px") if isinstance(report, dict) else None
        accuracy = self._store.find_current(case_id, DocumentKind.CHECK, ACCURACY)
        numbers = {"rms_px": rms_px}
        if accuracy is None:
            return _done(found, reason("CAMERA_CALIBRATED"), numbers)
        maximum = _number(accuracy.content.get("limit_mm"))
        error_mm = _number(accuracy.content.get("maximum_error_mm"))
        numbers = {**numbers, "maximum_error_mm": error_mm, "limit_mm": maximum}
        if accuracy.content.get("passed") is True:
            return _done(found, reason("CAMERA_CHECKED"), numbers)
        return Finding(
            state=StepState.FAILED,
            reason=reason("CAMERA_INACCURATE", {"error_mm": error_mm, "limit_mm": maximum}),
            numbers=numbers,
            document_id=accuracy.id,
        )

    def _tool(self, case_id: str) -> Finding:
        known = dict.fromkeys(self._defaults.tools)
        no_tool = reason("NO_TOOL_CALIBRATED")
        lost: list[Finding] = []
        for damaged in self._store.damaged(case_id, DocumentKind.TOOL):
            return _out_of_date(damaged, self._store.validity(damaged), missing=no_tool)
        documents = self._store.all(case_id, DocumentKind.TOOL)
        numbers: dict[str, float | None] = {}
        for document in documents:
            found = self._found(case_id, DocumentKind.TOOL, document.name, missing=no_tool)
            if isinstance(found, Finding):
                lost.append(found)
                continue
            try:
                record = tool_from_document(found)
            except NavigationError as error:
                lost.append(_unusable(found, error))
                continue
            if record.model(found.name) is None:
                lost.append(_axis_missing(found))
                continue
            known[found.name] = None
            numbers[f"{found.name}_rms_3d_mm"] = record.pivot.rms_3d_mm
        if known:
            tools = reason("TOOLS_CALIBRATED", {"tools": ", ".join(sorted(known))})
            return Finding(state=StepState.DONE, reason=tools, numbers=numbers)
        return lost[0] if lost else Finding(state=StepState.MISSING, reason=no_tool)

    def _plan(self, case_id: str) -> Finding:
        missing = self._without_channel("NOT_PLANNED")
        found = self._found(case_id, DocumentKind.PLAN, MAIN_PLAN, missing=missing)
        if isinstance(found, Finding):
            return found
        vertebra = self.active_vertebra(case_id)
        if vertebra is None:
            return Finding(
                state=StepState.MISSING,
                reason=self._without_channel("NO_CHANNEL_SELECTED"),
                document_id=found.id,
            )
        try:
            planned = vertebra_named(plan_from_mapping(found.content), vertebra)
            self._check_level(case_id)
        except NavigationError as error:
            return _unusable(found, error)
        selected = reason("CHANNEL_SELECTED", {"vertebra": vertebra})
        return _done(found, selected, {"landmarks": len(planned.landmarks)})

    def _without_channel(self, code: str) -> Reason:
        """Return the reason, with whose plan and registration the figures have meanwhile."""
        why = reason(code)
        if not self._defaults.has_plan:
            return why
        return reason("PLAN_OF_REHEARSAL", {"reason": why.message}, remedy=why.remedy)

    def _check_level(self, case_id: str) -> None:
        """Raise PlanError LEVEL_DOUBTFUL if the active channel lies in the label of another level."""
        labels = self._labels.current()
        active = None if labels is None else active_channel_document(self._store, case_id)
        if labels is not None and active is not None:
            chosen = active_channel_from_document(active)
            check_channel(labels.volume, chosen.vertebra, chosen.channel)

    def _registration(self, case_id: str, vertebra: str | None) -> Finding:
        if vertebra is None:
            return Finding(state=StepState.MISSING, reason=self._without_channel("VERTEBRA_UNKNOWN"))
        missing = reason("NOT_REGISTERED", {"vertebra": vertebra})
        found = self._found(case_id, DocumentKind.REGISTRATION, vertebra, missing=missing)
        if isinstance(found, Finding):
            return found
        try:
            record = self._defaults.registration_from(found)
        except NavigationError as error:
            return _unusable(found, error)
        numbers = {
            "method": record.method.value,
            "anchored_to": record.anchored_to.value,
            "age_min": age_min(
                found,
                from_s=record.from_s if record.run == self.run else None,
                now=self._clock(),
                now_s=self._seconds(),
            ),
            **record.numbers,
        }
        done = reason("REGISTERED", {"vertebra": vertebra, "method": METHODS[record.method.value]})
        return _done(found, done, numbers)

    def _check(self, case_id: str, vertebra: str | None) -> Finding:
        registration = (
            None
            if vertebra is None
            else self._store.find_current(case_id, DocumentKind.REGISTRATION, vertebra)
        )
        if vertebra is None or registration is None:
            return Finding(state=StepState.MISSING, reason=reason("NOTHING_TO_CHECK"))
        try:
            record = self._defaults.registration_from(registration)
        except NavigationError as error:
            return _unusable(registration, error)
        newest = self._store.newest_heading(case_id, DocumentKind.CHECK, check_name(vertebra))
        if newest is not None and newest.is_damaged:
            missing = reason("NOT_CHECKED", {"title": registration.title_text})
            return _out_of_date(newest, self._store.validity(newest), missing=missing)
        withdrawn = None if newest is None else newest.withdrawn
        if newest is not None and withdrawn is not None and registration.id in newest.depends_on:
            return Finding(
                state=StepState.OUT_OF_DATE,
                reason=reason(
                    "CHECK_WITHDRAWN", {"by": withdrawn.by, "why": withdrawal_text(withdrawn.reason)}
                ),
                document_id=newest.id,
            )
        return check_finding(
            registration=record,
            title=registration.title_text,
            check=self._store.find_current(case_id, DocumentKind.CHECK, check_name(vertebra)),
            run=self.run,
            again_after_min=self._gate.check_again_after_min,
            now=self._clock(),
            now_s=self._seconds(),
        )

    def _found(self, case_id: str, kind: DocumentKind, name: str, *, missing: Reason) -> Document | Finding:
        """Return the newest document if it is valid, otherwise the finding with the reason.

        `missing` is the reason where there is none; its remedy also makes a new version of one out of date.
        """
        newest = self._store.newest_heading(case_id, kind, name)
        if newest is None:
            return Finding(state=StepState.MISSING, reason=missing)
        validity = self._store.validity(newest)
        if isinstance(validity, Current):
            return self._store.document(case_id, newest.id)
        return _out_of_date(newest, validity, missing=missing)


def _out_of_date(newest: Heading, validity: Validity, *, missing: Reason) -> Finding:
    why = replace(validity.why, remedy=missing.remedy) if isinstance(validity, OutOfDate) else missing
    return Finding(state=StepState.OUT_OF_DATE, reason=why, document_id=newest.id)


def _done(document: Document, done: Reason, numbers: dict[str, float | int | bool | str | None]) -> Finding:
    return Finding(state=StepState.DONE, reason=done, numbers=numbers, document_id=document.id)


def _unusable(document: Document, error: NavigationError) -> Finding:
    return Finding(state=StepState.OUT_OF_DATE, reason=reason_of_error(error), document_id=document.id)


def _axis_missing(document: Document) -> Finding:
    return Finding(
        state=StepState.MISSING,
        reason=reason("TOOL_AXIS_MISSING", {"tool": document.name}),
        document_id=document.id,
    )


def _number(value: object) -> float | None:
    return float(value) if isinstance(value, int | float) else None

"""Publishes the setup of the open case to the tracking process after each change.

A new calibration or plan takes effect with the next image, without a restart, and is part of the setup of a
restarted tracking process. A registration that was made for one camera, marker or plan is never used with
another.
"""

import math
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import structlog

from server.alarms import ProcedureFacts
from server.camera_file import CameraFile
from server.camera_remarks import warn_of_doubtful_camera
from server.clock import AgeClock
from server.procedure.camera import MAIN_CAMERA, camera_from_document
from server.procedure.confirmation import confirmation_name
from server.procedure.drill_reference import DrillReferenceBuilder
from server.procedure.facts import facts_of
from server.procedure.markers import MarkerStep
from server.procedure.placement import placed_screws
from server.procedure.plan import ACTIVE_CHANNEL, active_channel_from_document, planned_ct_id
from server.procedure.registration_record import (
    CheckRecord,
    RegistrationRecord,
    check_from_document,
    check_name,
    with_tip_in_common,
)
from server.procedure.state import Procedure, SetupDefaults
from server.procedure.tool import tool_from_document
from server.setup import CaseSetup
from server.store import CaseStore, Document, DocumentKind
from tracker.errors import NavigationError
from tracker.navigation import AbsentReason, DrillReference, MeasuredLatency
from tracker.plan import Channel
from tracker.pose import ToolModel
from tracker.registration import AnchoredTo

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackingLink:
    """Connection of the procedure to tracking and alarms.

    Attributes:
        publish_setup: sends the setup of the open case to the tracking process.
        publish_facts: sends the facts of the procedure to the alarms.
        tracked_from_s: returns the start of the current tracking process, on the image clock.
        age_clock: returns the present time on the image clock, plus the computer's sleep.
    """

    publish_setup: Callable[[CaseSetup], None]
    publish_facts: Callable[[ProcedureFacts], None] = lambda _: None
    tracked_from_s: Callable[[], float] = lambda: -math.inf
    age_clock: Callable[[], float] = field(default_factory=AgeClock)


class SetupPublisher:
    """Publishes calibration, tools, plan and registration of the open case.

    Documents that are out of date, withdrawn, unreadable or made for another camera are not used. The
    registration is that of the vertebra to be drilled. Its numbers are withheld until it is checked, and
    after a restart until a person has confirmed it.

    Args:
        store: the case store.
        link: receives the new setup and the facts for the alarms after each change.
        procedure: state of the procedure, which decides whether numbers are withheld.
        drill_references: Builds the reference with which the drill is compared.
        defaults: setup from the settings; a calibration of another camera source, or a registration that is
            anchored to another reference, is not used.
        markers: source of the case's markers.
        latency: returns the last measured latency of the camera; None if it was not measured.
    """

    def __init__(
        self,
        store: CaseStore,
        link: TrackingLink,
        *,
        procedure: Procedure,
        drill_references: DrillReferenceBuilder,
        defaults: SetupDefaults,
        markers: MarkerStep,
        latency: Callable[[], MeasuredLatency | None] = lambda: None,
    ) -> None:
        self._store = store
        self._link = link
        self._procedure = procedure
        self._defaults = defaults
        self._lock = threading.Lock()
        self._drill_references = drill_references
        self._markers = markers
        self._latency = latency
        self._published: tuple[tuple[str, ...], DrillReference | None, MeasuredLatency | None] = (
            (),
            None,
            None,
        )
        self._warned_of: set[tuple[str, str]] = set()
        drill_references.on_change = self.refresh

    def refresh(self) -> None:
        """Read the open case, and publish its setup if it differs from the published one."""
        with self._lock:
            documents = self._documents()
            ids = tuple(document.id for document in documents)
            active = [document for document in documents if document.kind is DocumentKind.PLAN]
            drill_reference = self._drill_references.build(active[0]) if active else None
            latency = self._latency()
            if (ids, latency) != (
                self._published[0],
                self._published[2],
            ) or drill_reference is not self._published[1]:
                self._link.publish_setup(
                    replace(self._setup_of(documents), drill_reference=drill_reference, latency=latency)
                )
                self._published = (ids, drill_reference, latency)
                self._link.publish_facts(facts_of(self._procedure.state(), now_s=time.monotonic()))

    def _documents(self) -> list[Document]:
        """Return the valid documents of the open case that are part of the setup."""
        case = self._store.get_open_case()
        if case is None:
            return []
        kinds = (DocumentKind.CAMERA, DocumentKind.MARKER, DocumentKind.TOOL)
        documents = [document for kind in kinds for document in self._store.all_current(case.id, kind)]
        named = [(DocumentKind.PLAN, ACTIVE_CHANNEL)]
        vertebra = self._procedure.active_vertebra(case.id)
        # In place of a damaged calibration that of the settings would be used, and nobody decided that.
        if vertebra is not None and not self._store.damaged(case.id, *kinds):
            named += [
                (DocumentKind.REGISTRATION, vertebra),
                (DocumentKind.CHECK, check_name(vertebra)),
                (DocumentKind.CONFIRMATION, confirmation_name(vertebra)),
            ]
        found = [self._store.find_current(case.id, kind, name) for kind, name in named]
        documents += [document for document in found if document is not None]
        for kind in (DocumentKind.SIGNATURE, DocumentKind.PLACEMENT):
            documents += self._store.all_current(case.id, kind)
        return documents

    def _setup_of(self, documents: list[Document]) -> CaseSetup:
        cameras: dict[str, CameraFile] = {}
        tools: dict[str, ToolModel] = {}
        channel: Channel | None = None
        ct_id = ""
        registered: RegistrationRecord | None = None
        check: CheckRecord | None = None
        for document in documents:
            try:
                if document.kind is DocumentKind.CAMERA:
                    camera_file = camera_from_document(document, source=self._defaults.source)
                    cameras[document.name] = camera_file
                    self._warn_once(document, camera_file)
                elif document.kind is DocumentKind.MARKER:
                    # Markers are read together, because they must be distinguishable from each other.
                    continue
                elif document.kind is DocumentKind.PLAN:
                    channel = active_channel_from_document(document).channel
                    ct_id = planned_ct_id(self._store, document)
                elif document.kind is DocumentKind.REGISTRATION:
                    registered = with_tip_in_common(
                        self._defaults.registration_from(document),
                        document,
                        [one for one in documents if one.kind is DocumentKind.TOOL],
                    )
                elif document.kind is DocumentKind.CHECK:
                    check = check_from_document(document)
                elif document.kind is DocumentKind.TOOL:
                    tools.update(_named(document.name, tool_from_document(document).model(document.name)))
            except NavigationError as error:
                log.warning(error.message, code=error.code, remedy=error.remedy, document=document.title)
        camera = cameras.get(MAIN_CAMERA)
        return CaseSetup(
            camera=None if camera is None else camera.model,
            camera_controls={} if camera is None else camera.controls,
            camera_device="" if camera is None else camera.device,
            readout_ms=None if camera is None else camera.readout_ms,
            models=self._markers.of_case,
            tools=tools,
            channel=channel,
            ct_id=ct_id,
            placed_screws=()
            if registered is None
            else placed_screws(
                [one for one in documents if one.kind is DocumentKind.PLACEMENT], registered.vertebra
            ),
            registration=None if registered is None else registered.registration,
            registered_from_s=None if registered is None else self._from_s(registered, check),
            withheld=None if registered is None else self._withheld(),
            confirmed_from_s=None
            if registered is None
            else self._procedure.confirmed_from_s(registered, documents[0].case_id),
        )

    def _warn_once(self, document: Document, camera: CameraFile) -> None:
        """Log the warning about a doubtful camera once for each document, not at each publication."""
        if (document.case_id, document.id) not in self._warned_of:
            self._warned_of.add((document.case_id, document.id))
            warn_of_doubtful_camera(camera, title=document.title, max_rms_px=self._defaults.max_rms_px)

    def _withheld(self) -> AbsentReason | None:
        """Return why numbers are withheld although the vertebra is registered."""
        state = self._procedure.state()
        if state.waits_for_check:
            return AbsentReason.NOT_CHECKED
        if state.unsigned is not None:
            return AbsentReason.NOT_COSIGNED
        return None if state.confirmation is None else AbsentReason.NOT_CONFIRMED

    def _from_s(self, registered: RegistrationRecord, check: CheckRecord | None) -> float | None:
        """Return the capture time, or that of a later check, on the image clock; None before this run."""
        run = self._procedure.run
        is_fixed = registered.registration.anchored_to is AnchoredTo.REFERENCE
        # A check on one landmark cannot exclude a camera move, because it does not observe a rotation.
        if is_fixed and check is not None and check.passed and check.run == run:
            return check.from_s
        return registered.from_s if registered.run == run else None


def _named(name: str, tool: ToolModel | None) -> Mapping[str, ToolModel]:
    return {} if tool is None else {name: tool}

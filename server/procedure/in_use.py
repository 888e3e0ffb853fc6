"""What the open case knows, kept in use: each change of it reaches the tracking process at once.

A new calibration or plan takes effect with the next image, without a restart, and is part of the order from
which a restarted tracking process begins. What was registered for one camera, marker or plan is never used
with another.
"""

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import replace

import structlog

from server.alarms import ProcedureFacts
from server.camera_file import CameraFile
from server.procedure.camera import MAIN_CAMERA, kept_camera
from server.procedure.confirmed import confirmation_name
from server.procedure.facts import facts_of
from server.procedure.guiding import Guiding
from server.procedure.markers import MarkerStep
from server.procedure.plan import ACTIVE_CHANNEL, kept_channel
from server.procedure.registered import (
    KeptCheck,
    KeptRegistration,
    check_name,
    kept_check,
    kept_registration,
)
from server.procedure.state import Brought, Procedure
from server.procedure.tool import kept_tool
from server.setup import CaseSetup
from server.store import CaseStore, Current, Document, DocumentKind
from tracker.errors import NavigationError
from tracker.navigation import AbsentReason, Guide
from tracker.plan import Channel
from tracker.pose import ToolModel
from tracker.registration import AnchoredTo

log = structlog.get_logger(__name__)


class CaseInUse:
    """Hands what the open case knows to whatever tracks.

    What is out of date, withdrawn, unreadable or of another camera is not used: it is then unknown. Of the
    registrations the one of the vertebra that is to be drilled counts, and numbers against it are withheld
    until it was checked, and after a start until a person has confirmed it.

    Args:
        store: where cases are kept.
        adopt: told what the open case knows, whenever that has changed.
        procedure: its state, which says whether numbers are withheld.
        guiding: what the drill is held against.
        brought: by the settings: a calibration of another camera's source, or what is fixed to another
            reference, is not used.
        markers: reads the markers that the case keeps.
        latency_ms: of the camera, as it was measured last; None where it was not.
        know: told what the alarms shall know of the procedure, whenever the case has changed.
    """

    def __init__(
        self,
        store: CaseStore,
        adopt: Callable[[CaseSetup], None],
        *,
        procedure: Procedure,
        guiding: Guiding,
        brought: Brought,
        markers: MarkerStep,
        know: Callable[[ProcedureFacts], None],
        latency_ms: Callable[[], float | None] = lambda: None,
    ) -> None:
        self._store = store
        self._adopt = adopt
        self._procedure = procedure
        self._brought = brought
        self._lock = threading.Lock()
        self._guiding = guiding
        self._markers = markers
        self._know = know
        self._latency_ms = latency_ms
        self._in_use: tuple[tuple[str, ...], Guide | None, float | None] = ((), None, None)
        guiding.tell = self.refresh

    def refresh(self) -> None:
        """Look what the open case knows now, and hand it on if it is not what is in use."""
        with self._lock:
            documents = self._documents()
            ids = tuple(document.id for document in documents)
            active = [document for document in documents if document.kind is DocumentKind.PLAN]
            guide = self._guiding.guide_for(active[0]) if active else None
            latency_ms = self._latency_ms()
            if (ids, latency_ms) != (self._in_use[0], self._in_use[2]) or guide is not self._in_use[1]:
                self._adopt(replace(self._setup_of(documents), guide=guide, latency_ms=latency_ms))
                self._in_use = (ids, guide, latency_ms)
                self._know(facts_of(self._procedure.state(), now_s=time.monotonic()))

    def _documents(self) -> list[Document]:
        """What of the open case holds and says something of the set-up."""
        case = self._store.opened()
        if case is None:
            return []
        kinds = (DocumentKind.CAMERA, DocumentKind.MARKER, DocumentKind.TOOL)
        newest = [document for kind in kinds for document in self._store.all(case.id, kind)]
        active = self._store.latest(case.id, DocumentKind.PLAN, ACTIVE_CHANNEL)
        vertebra = self._procedure.active_vertebra(case.id)
        registered = (
            []
            if vertebra is None
            else [
                self._store.latest(case.id, DocumentKind.REGISTRATION, vertebra),
                self._store.latest(case.id, DocumentKind.CHECK, check_name(vertebra)),
                self._store.latest(case.id, DocumentKind.CONFIRMATION, confirmation_name(vertebra)),
            ]
        )
        newest += [document for document in (active, *registered) if document is not None]
        newest += self._store.all(case.id, DocumentKind.SIGNATURE)
        return [document for document in newest if isinstance(self._store.standing(document), Current)]

    def _setup_of(self, documents: list[Document]) -> CaseSetup:
        cameras: dict[str, CameraFile] = {}
        tools: dict[str, ToolModel] = {}
        channel: Channel | None = None
        registered: KeptRegistration | None = None
        check: KeptCheck | None = None
        for document in documents:
            try:
                if document.kind is DocumentKind.CAMERA:
                    cameras[document.name] = kept_camera(document, source=self._brought.source)
                elif document.kind is DocumentKind.MARKER:
                    # Read all together: no two of them may look the same.
                    continue
                elif document.kind is DocumentKind.PLAN:
                    channel = kept_channel(document).channel
                elif document.kind is DocumentKind.REGISTRATION:
                    registered = kept_registration(document, reference=self._brought.reference)
                elif document.kind is DocumentKind.CHECK:
                    check = kept_check(document)
                elif document.kind is DocumentKind.TOOL:
                    tools.update(_named(document.name, kept_tool(document).model(document.name)))
            except NavigationError as error:
                log.warning(error.message, code=error.code, remedy=error.remedy, document=document.title)
        camera = cameras.get(MAIN_CAMERA)
        return CaseSetup(
            camera=None if camera is None else camera.model,
            camera_controls={} if camera is None else camera.controls,
            readout_ms=None if camera is None else camera.readout_ms,
            models=self._markers.of_case,
            tools=tools,
            channel=channel,
            registration=None if registered is None else registered.registration,
            registered_from_s=None if registered is None else self._from_s(registered, check),
            withheld=None if registered is None else self._withheld(),
            believed_from_s=None
            if registered is None
            else self._procedure.believed_from_s(registered, documents[0].case_id),
        )

    def _withheld(self) -> AbsentReason | None:
        """Why no number is given although the vertebra is registered."""
        state = self._procedure.state()
        if state.waits_for_check:
            return AbsentReason.NOT_CHECKED
        if state.unsigned is not None:
            return AbsentReason.NOT_COSIGNED
        return None if state.confirmation is None else AbsentReason.NOT_CONFIRMED

    def _from_s(self, registered: KeptRegistration, check: KeptCheck | None) -> float | None:
        """Since when it stands, by the images' clock: touched, or checked since; None before this run."""
        run = self._procedure.run
        is_fixed = registered.registration.anchored_to is AnchoredTo.REFERENCE
        # Of a camera that was moved a check on one landmark takes nothing back: its turn is not seen there.
        if is_fixed and check is not None and check.passed and check.run == run:
            return check.from_s
        return registered.from_s if registered.run == run else None


def _named(name: str, tool: ToolModel | None) -> Mapping[str, ToolModel]:
    return {} if tool is None else {name: tool}

"""The bone surface in the 3-D scene: that of the open case while one of its channels is active."""

import threading
from collections.abc import Callable

import structlog

from server.imaging.meshes import mesh_from_bytes
from server.procedure.plan import active_channel_document
from server.procedure.surface import MAIN_SURFACE
from server.store import CaseStore, Document, DocumentKind
from tracker.errors import NavigationError
from tracker.plan import Surface
from tracker.plan.mesh.intake import Space

log = structlog.get_logger(__name__)


class SceneBone:
    """Passes the bone surface to the scene after each change. Thread-safe.

    While a channel of the open case is active, the scene shows the surface of that case, or none if the case
    has none. Otherwise it shows the initial surface.

    Args:
        store: source of the surfaces.
        show: called with the surface to show.
        own: The initial surface, that of the rehearsal, for use without a case.
    """

    def __init__(
        self, store: CaseStore, show: Callable[[Surface | None], None], *, own: Surface | None
    ) -> None:
        self._store = store
        self._show = show
        self._own = own
        self._lock = threading.Lock()
        self._shown = ""
        store.add_commit_listener(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Update the scene; a new surface is read in a separate thread, because that takes time."""
        planned, document = self._documents()
        wanted = "" if planned is None else f"{planned.case_id} {'' if document is None else document.id}"
        with self._lock:
            if wanted == self._shown:
                return
            self._shown = wanted
        if document is None:
            self._show(self._own if planned is None else None)
            return
        threading.Thread(target=self._read, args=(wanted, document), name="shown bone", daemon=True).start()

    def _documents(self) -> tuple[Document | None, Document | None]:
        """Return the documents of the active channel and of its surface; None for those that do not exist."""
        case = self._store.get_open_case()
        if case is None:
            return None, None
        planned = active_channel_document(self._store, case.id)
        surface = self._store.find_current(case.id, DocumentKind.SURFACE, MAIN_SURFACE)
        return planned, surface if planned is not None and surface is not None and surface.files else None

    def _read(self, wanted: str, document: Document) -> None:
        surface = read_surface(self._store, document)
        with self._lock:
            # Another surface may have been requested meanwhile.
            if wanted == self._shown:
                self._show(surface)


def read_surface(store: CaseStore, document: Document) -> Surface | None:
    """Return the bone surface of a document; None if it cannot be read, which is logged."""
    try:
        path = store.file(document.case_id, document.files[0]).path
        return mesh_from_bytes(path.read_bytes(), file_format="ply", unit="mm", space=Space.LPS).surface
    except NavigationError as error:
        log.warning(error.message, code=error.code, remedy=error.remedy, document=document.title)
    except (OSError, IndexError):
        log.warning("the bone surface cannot be read", document=document.title, exc_info=True)
    return None

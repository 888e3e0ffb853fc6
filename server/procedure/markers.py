"""The tracked markers: those of the settings, and those whose image was uploaded to the open case.

A case adds markers to those of the settings and never replaces them. A marker image is a document with a
file, so a tool on a changed marker becomes out of date by the rule that applies to every document. The
reference marker on the patient is named in the settings only. With an external tracker its rigid bodies take
the place of all printed markers.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Annotated

import structlog
from pydantic import Field

from server.config import Section
from server.errors import SetupOrderError
from server.marker_file import load_marker_image, marker_image
from server.procedure.documents import parse_document
from server.procedure.images_in_use import no_camera_in_use
from server.procedure.open_case import require_open_case
from server.store import CaseStore, Document, DocumentKind, NotFound
from server.texts import WITHDRAWALS
from tracker.errors import InvalidInput, NavigationError
from tracker.marker import MarkerModel, reject_mirror_symmetric, reject_similar

# Each one costs search time in every image.
MAX_MARKERS = 8

log = structlog.get_logger(__name__)


class MarkerRecord(Section):
    """A marker as stored in a case; its image is the file of the document."""

    side_mm: Annotated[float, Field(gt=0.0, le=1000.0)]


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownMarker:
    """A tracked marker, or a rigid body of an external tracker.

    Attributes:
        name: its name.
        model: model of the marker; None for a rigid body, which has no image.
        document: its document in the open case; None for a configured marker.
    """

    name: str
    model: MarkerModel | None
    document: Document | None

    @property
    def side_mm(self) -> float | None:
        """Side of the printed square; None for a rigid body."""
        return None if self.model is None else self.model.side_mm


class MarkerStep:
    """Stores marker images in the open case. Thread-safe.

    Args:
        store: where they are stored.
        defaults: the configured markers; no marker of a case may use their names.
        bodies: names of the rigid bodies of an external tracker; empty for a camera.
    """

    def __init__(
        self, *, store: CaseStore, defaults: Sequence[MarkerModel], bodies: Sequence[str] = ()
    ) -> None:
        self._store = store
        self._bodies = tuple(bodies)
        self._defaults = {model.name: model for model in defaults}

    def known(self) -> tuple[KnownMarker, ...]:
        """Return all tracked markers: of the settings first, then of the open case; or all rigid bodies."""
        if self._bodies:
            return tuple(KnownMarker(name=name, model=None, document=None) for name in self._bodies)
        known = [KnownMarker(name=name, model=model, document=None) for name, model in self._defaults.items()]
        case = self._store.get_open_case()
        for document in () if case is None else self._store.all(case.id, DocumentKind.MARKER):
            if document.name in self._defaults:
                continue
            try:
                model = self._model_of(document)
                reject_mirror_symmetric([model])
                reject_similar([*_models(known), model])
            except NavigationError as error:
                # It is not tracked; the others are.
                log.warning(error.message, code=error.code, remedy=error.remedy, document=document.title)
                continue
            known.append(KnownMarker(name=model.name, model=model, document=document))
        return tuple(known)

    @property
    def of_case(self) -> tuple[MarkerModel, ...]:
        """The markers that the open case adds to those of the settings."""
        return _models(one for one in self.known() if one.document is not None)

    def one(self, name: str) -> KnownMarker:
        """Return a tracked marker by name.

        Raises:
            NotFound: MARKER_UNKNOWN.
        """
        found = next((known for known in self.known() if known.name == name), None)
        if found is None:
            raise NotFound(
                "MARKER_UNKNOWN",
                f"there is no marker '{name}'",
                "GET /api/markers lists the markers.",
                {"marker": name},
            )
        return found

    def add(self, name: str, *, side_mm: float, picture: Path, named: str, made_by: str) -> Document:
        """Store a marker's image in the open case; the marker is tracked from the next image on.

        It replaces a marker of the same name; tools that were calibrated on that one become out of date.

        Args:
            name: name of the marker.
            side_mm: side of its printed black square.
            picture: the uploaded file.
            named: original name of the file.
            made_by: name of the person.

        Raises:
            SetupOrderError: NO_CASE_OPEN, MARKER_OF_SETTINGS, NO_CAMERA_IN_USE.
            InvalidInput: the image is not a valid marker, MARKER_MIRROR_SYMMETRIC, MARKERS_TOO_SIMILAR,
                MARKERS_ENOUGH.
        """
        case = require_open_case(self._store)
        if self._bodies:
            raise no_camera_in_use()
        self._reject_configured(name)
        content = picture.read_bytes()
        model = MarkerModel.from_image(marker_image(content, named=named), side_mm=side_mm, name=name)
        reject_mirror_symmetric([model])
        self._reject_among_others(model)
        with self._store.new_file(case.id, ".picture") as new:
            new.path.write_bytes(content)
        return self._store.put(
            case.id,
            DocumentKind.MARKER,
            name,
            MarkerRecord(side_mm=side_mm).model_dump(mode="json"),
            made_by=made_by,
            files=[new.stored.id],
        )

    def remove(self, name: str, *, by: str) -> None:
        """Stop tracking a marker of the open case; tools that were calibrated on it become out of date.

        Raises:
            SetupOrderError: NO_CASE_OPEN, MARKER_OF_SETTINGS.
            NotFound: MARKER_UNKNOWN.
        """
        case = require_open_case(self._store)
        self._reject_configured(name)
        # Also a marker whose image is unreadable.
        document = self._store.latest(case.id, DocumentKind.MARKER, name) or self.one(name).document
        if document is not None:
            self._store.withdraw(document, by=by, reason=WITHDRAWALS["MARKER_REMOVED"]["en"])

    def _model_of(self, document: Document) -> MarkerModel:
        record = parse_document(
            MarkerRecord,
            document,
            code="MARKER_DOCUMENT_INVALID",
            remedy="Upload the image of the marker again.",
        )
        path = self._store.file(document.case_id, document.files[0]).path
        return _model(path, document.name, record.side_mm)

    def _reject_configured(self, name: str) -> None:
        if name in self._defaults:
            raise SetupOrderError(
                "MARKER_OF_SETTINGS",
                f"the marker '{name}' is defined in the settings and cannot be changed in a case",
                "Use another name, or change it under markers in the settings.",
                {"marker": name},
            )

    def _reject_among_others(self, model: MarkerModel) -> None:
        """Reject a marker that could be confused with another, and too many markers (search time)."""
        others = _models(known for known in self.known() if known.name != model.name)
        reject_similar([*others, model])
        if len(others) >= MAX_MARKERS:
            raise InvalidInput(
                "MARKERS_ENOUGH",
                f"{len(others)} markers are tracked, the maximum is {MAX_MARKERS}",
                "Remove a marker that is no longer used.",
                {"markers": len(others), "allowed": MAX_MARKERS},
            )


def _models(known: Iterable[KnownMarker]) -> tuple[MarkerModel, ...]:
    return tuple(one.model for one in known if one.model is not None)


@lru_cache(maxsize=32)
def _model(path: Path, name: str, side_mm: float) -> MarkerModel:
    """Load a marker model. Cached, because files of a case never change."""
    return MarkerModel.from_image(load_marker_image(path), side_mm=side_mm, name=name)

"""The markers that are looked for: those of the settings, and those whose picture was sent into the case.

A case adds markers to those of the settings and never replaces them. A picture is a document with its file,
so a tool behind a changed marker goes out of date by the rule that applies to every document. The marker on
the patient is named in the settings only.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Annotated

import structlog
from pydantic import Field

from server.config import Section
from server.errors import SetupOrderError
from server.marker_file import load_marker_image, marker_image
from server.procedure.opened import opened_case
from server.procedure.read import read_document
from server.store import CaseStore, Document, DocumentKind, NotStored
from tracker.errors import InvalidInput, NavigationError
from tracker.marker import MarkerModel, reject_alike

# Each one costs search time in every image.
MAX_MARKERS = 8

log = structlog.get_logger(__name__)


class KeptMarker(Section):
    """A marker as a case keeps it; its picture is the document's file."""

    side_mm: Annotated[float, Field(gt=0.0, le=1000.0)]


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownMarker:
    """A marker that is looked for.

    Attributes:
        model: what is looked for.
        document: that keeps it; None for one that the settings bring.
    """

    model: MarkerModel
    document: Document | None


class MarkerStep:
    """Takes pictures of markers into the open case. Safe to use from any thread.

    Args:
        store: where they are kept.
        brought: by the settings; these stay, and no marker of a case takes their names.
    """

    def __init__(self, *, store: CaseStore, brought: Sequence[MarkerModel]) -> None:
        self._store = store
        self._brought = {model.name: model for model in brought}

    def known(self) -> tuple[KnownMarker, ...]:
        """All that are looked for: of the settings first, then of the open case."""
        known = [KnownMarker(model=model, document=None) for model in self._brought.values()]
        case = self._store.opened()
        for document in () if case is None else self._store.all(case.id, DocumentKind.MARKER):
            if document.name in self._brought:
                continue
            try:
                model = self._model_of(document)
                reject_alike([*(one.model for one in known), model])
            except NavigationError as error:
                # It is not looked for; the others are.
                log.warning(error.message, code=error.code, remedy=error.remedy, document=document.title)
                continue
            known.append(KnownMarker(model=model, document=document))
        return tuple(known)

    @property
    def of_case(self) -> tuple[MarkerModel, ...]:
        """Those that the open case adds to the ones of the settings."""
        return tuple(one.model for one in self.known() if one.document is not None)

    def one(self, name: str) -> KnownMarker:
        """One of them.

        Raises:
            NotStored: MARKER_UNKNOWN.
        """
        found = next((known for known in self.known() if known.model.name == name), None)
        if found is None:
            raise NotStored(
                "MARKER_UNKNOWN",
                f"no marker '{name}' is looked for",
                "Look at the list of markers.",
                {"marker": name},
            )
        return found

    def add(self, name: str, *, side_mm: float, picture: Path, named: str, made_by: str) -> Document:
        """Keep a marker's picture in the open case; it is looked for from the next image on.

        One of the same name is replaced by it, and what was calibrated behind that one is out of date.

        Args:
            name: of the marker.
            side_mm: of its printed black square.
            picture: the file that was sent.
            named: how that is called where it was sent from.
            made_by: who sends it.

        Raises:
            SetupOrderError: NO_CASE_OPEN, MARKER_OF_SETTINGS.
            InvalidInput: what cannot be a marker's picture, MARKERS_ALIKE, MARKERS_ENOUGH.
        """
        case = opened_case(self._store)
        self._reject_settled(name)
        content = picture.read_bytes()
        model = MarkerModel.from_image(marker_image(content, named=named), side_mm=side_mm, name=name)
        self._reject_among_others(model)
        with self._store.new_file(case.id, ".picture") as new:
            new.path.write_bytes(content)
        return self._store.put(
            case.id,
            DocumentKind.MARKER,
            name,
            KeptMarker(side_mm=side_mm).model_dump(mode="json"),
            made_by=made_by,
            files=[new.stored.id],
        )

    def remove(self, name: str, *, by: str) -> None:
        """Look for this marker of the open case no more; what was calibrated behind it is out of date.

        Raises:
            SetupOrderError: NO_CASE_OPEN, MARKER_OF_SETTINGS.
            NotStored: MARKER_UNKNOWN.
        """
        case = opened_case(self._store)
        self._reject_settled(name)
        # Also one whose picture cannot be read any more.
        document = self._store.latest(case.id, DocumentKind.MARKER, name) or self.one(name).document
        if document is not None:
            self._store.withdraw(document, by=by, reason="it is not to be looked for any more")

    def _model_of(self, document: Document) -> MarkerModel:
        kept = read_document(
            KeptMarker, document, code="MARKER_DOCUMENT_INVALID", remedy="Send the marker's picture again."
        )
        path = self._store.file(document.case_id, document.files[0]).path
        return _model(path, document.name, kept.side_mm)

    def _reject_settled(self, name: str) -> None:
        if name in self._brought:
            raise SetupOrderError(
                "MARKER_OF_SETTINGS",
                f"the marker '{name}' comes from the settings, and stays as they have it",
                "Choose another name, or change it under markers in the settings.",
                {"marker": name},
            )

    def _reject_among_others(self, model: MarkerModel) -> None:
        """Two markers that look the same would be taken for each other; too many cost too much time."""
        others = [known.model for known in self.known() if known.model.name != model.name]
        reject_alike([*others, model])
        if len(others) >= MAX_MARKERS:
            raise InvalidInput(
                "MARKERS_ENOUGH",
                f"{len(others)} markers are looked for, allowed are {MAX_MARKERS}",
                "Remove one that is not used any more.",
                {"markers": len(others), "allowed": MAX_MARKERS},
            )


@lru_cache(maxsize=32)
def _model(path: Path, name: str, side_mm: float) -> MarkerModel:
    """Files of a case are never changed, so what was made of one stays true."""
    return MarkerModel.from_image(load_marker_image(path), side_mm=side_mm, name=name)

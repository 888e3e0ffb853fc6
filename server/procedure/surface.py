"""Surface step: extracts the bone surface from the CT, or imports it from a file."""

import secrets
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from server.errors import SetupOrderError
from server.jobs import Job, Jobs, Work
from server.planning.surface import MESH, PLY, MeshRequest, surface_of_ct, surface_of_file
from server.procedure.ct import CtProvider
from server.procedure.open_case import require_open_case
from server.store import CaseStore, Document, DocumentKind, StoredFile, translate_errors
from tracker.plan.bone import BoneSettings, Region

MAIN_SURFACE = "main"


@dataclass(frozen=True, slots=True, kw_only=True)
class BoneSurfaceRequest:
    """Settings of the extraction of a surface from the CT; None selects a value automatically.

    Attributes:
        threshold_hu: threshold of bone.
        region_lps_mm: two opposite corners of the region.
        largest_part_only: keep only the largest connected component.
        smoothing_rounds: iterations of the smoothing; 0 for none.
        max_faces: maximum number of triangles.
    """

    threshold_hu: float | None = None
    region_lps_mm: tuple[Sequence[float], Sequence[float]] | None = None
    largest_part_only: bool = True
    smoothing_rounds: int = 10
    max_faces: int = 60_000

    @property
    def settings(self) -> BoneSettings:
        """Return the settings for the tracker; raises PlanError REGION_INVALID, BONE_SETTINGS_INVALID."""
        region = None if self.region_lps_mm is None else Region.between(*self.region_lps_mm)
        return BoneSettings(
            threshold_hu=self.threshold_hu,
            region=region,
            largest_part_only=self.largest_part_only,
            smoothing_rounds=self.smoothing_rounds,
            max_faces=self.max_faces,
        )


class SurfaceStep:
    """Creates bone surfaces. Thread-safe."""

    def __init__(self, *, store: CaseStore, jobs: Jobs, ct_provider: CtProvider) -> None:
        self._store = store
        self._jobs = jobs
        self._ct_provider = ct_provider

    def reject_without_case(self) -> None:
        """Raise if no case is open, before a large upload; SetupOrderError NO_CASE_OPEN."""
        require_open_case(self._store)

    def from_ct(self, order: BoneSurfaceRequest, *, made_by: str) -> Job:
        """Start a job that extracts the bone surface from the CT of the open case.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CT_MISSING.
            PlanError: REGION_INVALID, BONE_SETTINGS_INVALID.
        """
        ct = self._ct_provider.current()
        settings = order.settings
        return self._start(
            "extracting the bone surface",
            surface_of_ct,
            {
                "path": str(ct.file.path),
                "lps_from_ijk": ct.document.content["lps_from_ijk"],
                "settings": settings,
            },
            folder=self._new_folder(),
            case_id=ct.document.case_id,
            depends_on=[ct.document.id],
            made_by=made_by,
        )

    def from_mesh(self, path: Path, order: MeshRequest, *, made_by: str) -> Job:
        """Start a job that imports the surface in the file at `path`, which is moved.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
        """
        case = require_open_case(self._store)
        folder = self._new_folder()
        with translate_errors(self._store.home.folder):
            path.replace(folder / MESH)
        return self._start(
            "reading the surface",
            surface_of_file,
            {"order": order},
            folder=folder,
            case_id=case.id,
            depends_on=[],
            made_by=made_by,
        )

    def latest(self) -> tuple[Document, StoredFile]:
        """Return the newest surface of the open case, with its PLY file.

        Raises:
            SetupOrderError: NO_CASE_OPEN, SURFACE_MISSING.
            StoreError: FILE_DAMAGED.
        """
        case = require_open_case(self._store)
        document = self._store.latest(case.id, DocumentKind.SURFACE, MAIN_SURFACE)
        if document is None or not document.files:
            raise SetupOrderError(
                "SURFACE_MISSING",
                "the open case has no bone surface",
                "Extract one from the CT, or upload one.",
                {"case_id": case.id},
            )
        return document, self._store.file(case.id, document.files[0])

    def _new_folder(self) -> Path:
        folder = self._store.home.temporary / f"{secrets.token_hex(8)}.surface"
        with translate_errors(self._store.home.folder):
            folder.mkdir()
        return folder

    def _start(
        self,
        title: str,
        work: Work,
        arguments: Mapping[str, object],
        *,
        folder: Path,
        case_id: str,
        depends_on: Sequence[str],
        made_by: str,
    ) -> Job:
        def keep(values: object) -> object:
            if not isinstance(values, Mapping):
                raise TypeError(f"the surface job returned {type(values).__name__}")
            with self._store.new_file(case_id, ".ply") as new:
                shutil.move(folder / PLY, new.path)
            document = self._store.put(
                case_id,
                DocumentKind.SURFACE,
                MAIN_SURFACE,
                values,
                made_by=made_by,
                depends_on=depends_on,
                files=[new.stored.id],
            )
            return {"document_id": document.id, "version": document.version, **values}

        return self._jobs.start(
            title, work, {**arguments, "folder": str(folder)}, folder=folder, conclude=keep
        )

"""The step in which the bone's surface comes out of the CT, or from a file, into the open case."""

import secrets
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from server.errors import SetupOrderError
from server.jobs import Job, Jobs, Work
from server.planning.surface import MESH, PLY, MeshOrder, surface_of_ct, surface_of_file
from server.procedure.ct import OpenedCt
from server.procedure.opened import opened_case
from server.store import CaseStore, Document, DocumentKind, StoredFile, told
from tracker.plan.bone import BoneSettings, Region

MAIN_SURFACE = "main"


@dataclass(frozen=True, slots=True, kw_only=True)
class BoneOrder:
    """How a surface shall be made out of the CT; what is None is chosen by the program.

    Attributes:
        threshold_hu: from where on a voxel is bone.
        region_lps_mm: two opposite corners of the part that is looked at.
        largest_part_only: leave out what does not hang together with the largest piece.
        smoothing_rounds: 0 for none.
        max_faces: triangles of the result.
    """

    threshold_hu: float | None = None
    region_lps_mm: tuple[Sequence[float], Sequence[float]] | None = None
    largest_part_only: bool = True
    smoothing_rounds: int = 10
    max_faces: int = 60_000

    @property
    def settings(self) -> BoneSettings:
        """For the tracker; PlanError REGION_INVALID, BONE_SETTINGS_INVALID."""
        region = None if self.region_lps_mm is None else Region.between(*self.region_lps_mm)
        return BoneSettings(
            threshold_hu=self.threshold_hu,
            region=region,
            largest_part_only=self.largest_part_only,
            smoothing_rounds=self.smoothing_rounds,
            max_faces=self.max_faces,
        )


class SurfaceStep:
    """Makes surfaces; safe to use from any thread."""

    def __init__(self, *, store: CaseStore, jobs: Jobs, opened: OpenedCt) -> None:
        self._store = store
        self._jobs = jobs
        self._opened = opened

    def reject_without_case(self) -> None:
        """To be asked before much is sent; SetupOrderError NO_CASE_OPEN."""
        opened_case(self._store)

    def from_ct(self, order: BoneOrder, *, made_by: str) -> Job:
        """The surface of the bone in the CT of the open case, in a job.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CT_MISSING.
            PlanError: REGION_INVALID, BONE_SETTINGS_INVALID.
        """
        ct = self._opened.current()
        settings = order.settings
        return self._start(
            "making the bone's surface",
            surface_of_ct,
            {
                "path": str(ct.file.path),
                "lps_from_ijk": ct.document.content["lps_from_ijk"],
                "settings": settings,
            },
            folder=self._new_folder(),
            case_id=ct.document.case_id,
            stands_on=[ct.document.id],
            made_by=made_by,
        )

    def from_mesh(self, path: Path, order: MeshOrder, *, made_by: str) -> Job:
        """The surface in a file, which is moved away from `path`, in a job.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
        """
        case = opened_case(self._store)
        folder = self._new_folder()
        with told(self._store.home.folder):
            path.replace(folder / MESH)
        return self._start(
            "reading the surface",
            surface_of_file,
            {"order": order},
            folder=folder,
            case_id=case.id,
            stands_on=[],
            made_by=made_by,
        )

    def latest(self) -> tuple[Document, StoredFile]:
        """The newest surface of the open case, with its PLY file.

        Raises:
            SetupOrderError: NO_CASE_OPEN, SURFACE_MISSING.
            StoreError: FILE_DAMAGED.
        """
        case = opened_case(self._store)
        document = self._store.latest(case.id, DocumentKind.SURFACE, MAIN_SURFACE)
        if document is None or not document.files:
            raise SetupOrderError(
                "SURFACE_MISSING",
                "the open case has no surface of the bone",
                "Make one from the CT, or send one.",
                {"case_id": case.id},
            )
        return document, self._store.file(case.id, document.files[0])

    def _new_folder(self) -> Path:
        folder = self._store.home.temporary / f"{secrets.token_hex(8)}.surface"
        with told(self._store.home.folder):
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
        stands_on: Sequence[str],
        made_by: str,
    ) -> Job:
        def keep(values: object) -> object:
            if not isinstance(values, Mapping):
                raise TypeError(f"a surface gave {type(values).__name__}")
            with self._store.new_file(case_id, ".ply") as new:
                shutil.move(folder / PLY, new.path)
            document = self._store.put(
                case_id,
                DocumentKind.SURFACE,
                MAIN_SURFACE,
                values,
                made_by=made_by,
                stands_on=stands_on,
                files=[new.stored.id],
            )
            return {"document_id": document.id, "version": document.version, **values}

        return self._jobs.start(
            title, work, {**arguments, "folder": str(folder)}, folder=folder, conclude=keep
        )

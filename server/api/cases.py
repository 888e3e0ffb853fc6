"""Cases: list, create, open, export, import and delete; their documents and files."""

from pathlib import Path

from anyio import to_thread
from fastapi import APIRouter, Request, Response
from fastapi.responses import FileResponse
from starlette.background import BackgroundTask

from server.api.case_messages import (
    CaseMessage,
    CaseNameMessage,
    CasesMessage,
    ConfirmationMessage,
    DocumentMessage,
    DocumentsMessage,
    FilesMessage,
    ImportedCaseMessage,
    RestoreMessage,
    VerificationMessage,
    WithdrawMessage,
    case_message,
    document_message,
    documents_message,
    files_message,
    imported_case_message,
    verification_message,
)
from server.api.errors import rejections
from server.api.uploads import received
from server.security import actor_name
from server.store import CaseStore, StoreConflict

MAX_ARCHIVE_BYTES = 16 * 2**30
ZIP = "application/zip"
BINARY = "application/octet-stream"


def cases_router(store: CaseStore) -> APIRouter:
    """Return the router of `/api/cases`. Its routes are synchronous because they wait for the disk."""
    router = APIRouter(prefix="/api/cases", tags=["cases"])
    _add_list(router, store)
    _add_one(router, store)
    _add_archives(router, store)
    _add_documents(router, store)
    _add_files(router, store)
    return router


def _add_list(router: APIRouter, store: CaseStore) -> None:
    @router.get("", responses=rejections(503))
    def cases() -> CasesMessage:
        """Return all cases, and which one is open."""
        opened = store.get_open_case()
        return CasesMessage(
            opened_id=None if opened is None else opened.id,
            cases=[case_message(case) for case in store.list()],
        )

    @router.post("", status_code=201, responses=rejections(422, 503, 507))
    def create(requested: CaseNameMessage) -> CaseMessage:
        """Create a case."""
        return case_message(store.create(requested.name))


def _add_one(router: APIRouter, store: CaseStore) -> None:
    @router.get("/{case_id}", responses=rejections(404, 503))
    def case(case_id: str) -> CaseMessage:
        """Return one case."""
        return case_message(store.get(case_id))

    @router.patch("/{case_id}", responses=rejections(404, 422, 503, 507))
    def rename(case_id: str, requested: CaseNameMessage) -> CaseMessage:
        """Rename a case."""
        return case_message(store.rename(case_id, requested.name))

    @router.post("/{case_id}/open", responses=rejections(404, 503, 507))
    def open_case(case_id: str) -> CaseMessage:
        """Open this case and close the one that was open."""
        return case_message(store.open(case_id))

    @router.post("/{case_id}/close", responses=rejections(404, 409, 503, 507))
    def close_case(case_id: str) -> CaseMessage:
        """Close this case."""
        closed = store.get(case_id)
        opened = store.get_open_case()
        if opened is None or opened.id != case_id:
            raise StoreConflict(
                "CASE_NOT_OPEN",
                f"the case {case_id} is not open",
                "GET /api/cases shows which case is open.",
                {"case_id": case_id},
            )
        store.close()
        return case_message(closed)

    @router.post("/{case_id}/deletion", status_code=204, responses=rejections(404, 409, 422, 503))
    def delete(case_id: str, requested: ConfirmationMessage) -> Response:
        """Delete a case permanently. The name of the case is the confirmation.

        An open case, or one that is being exported or written, is not deleted (409).
        """
        store.delete(case_id, confirm=requested.confirm)
        return Response(status_code=204)


def _add_archives(router: APIRouter, store: CaseStore) -> None:
    @router.get(
        "/{case_id}/archive",
        response_class=FileResponse,
        responses={200: {"content": {ZIP: {}}}, **rejections(404, 503, 507)},
    )
    def copy_out(case_id: str, *, with_identity: bool = False, without_damaged: bool = False) -> FileResponse:
        """Return the case as a zip archive. Case name and patient identity are only included on request.

        If the disk has damaged a document or a file, the export is rejected (503), unless `without_damaged`
        is true. Then the manifest of the archive lists under `missing` what it does not contain, its file
        name ends in `-incomplete`, and the header `Coaxial-Missing` is the number of missing documents and
        files.
        """
        archive = store.export_case(case_id, with_identity=with_identity, without_damaged=without_damaged)
        incomplete = "-incomplete" if archive.missing else ""
        return FileResponse(
            archive.path,
            media_type=ZIP,
            filename=f"coaxial-case-{case_id[:6]}{incomplete}.zip",
            headers={"Coaxial-Missing": f"{archive.missing}"},
            background=BackgroundTask(archive.path.unlink, missing_ok=True),
        )

    @router.post(
        "/archive",
        status_code=201,
        responses=rejections(413, 422, 503, 507),
        openapi_extra={"requestBody": {"required": True, "content": {ZIP: {}}}},
    )
    async def copy_in(request: Request) -> ImportedCaseMessage:
        """Import a case from an archive in the request body, completely or not at all.

        What was damaged before the export, and is missing in the archive, is in `damages`.
        Its documents record who imported them and when. Their authors are only claimed by the archive.
        Signatures in the archive are not valid on this server.
        """
        by = actor_name(request.scope, None)
        async with received(request, store.home, max_bytes=MAX_ARCHIVE_BYTES) as path:
            return await to_thread.run_sync(lambda: _imported(store, path, by=by))


def _imported(store: CaseStore, archive: Path, *, by: str) -> ImportedCaseMessage:
    case = store.import_archive(archive, by=by)
    return imported_case_message(case, store.verify(case.id))


def _add_documents(router: APIRouter, store: CaseStore) -> None:
    @router.get("/{case_id}/documents", responses=rejections(404, 503))
    def documents(case_id: str) -> DocumentsMessage:
        """Return all versions of all documents with their dependencies and validity."""
        return documents_message(store.outline(case_id))

    @router.get("/{case_id}/documents/{document_id}", responses=rejections(404, 503))
    def document(case_id: str, document_id: str) -> DocumentMessage:
        """Return one version of a document with its content."""
        found = store.document(case_id, document_id)
        return document_message(found, store.validity(found))

    @router.post("/{case_id}/documents/{document_id}/withdrawal", responses=rejections(404, 422, 503, 507))
    def withdraw(case_id: str, document_id: str, requested: WithdrawMessage) -> DocumentMessage:
        """Withdraw a document; documents that depend on it become out of date."""
        found = store.withdraw(store.document(case_id, document_id), by=requested.by, reason=requested.reason)
        return document_message(found, store.validity(found))

    @router.post(
        "/{case_id}/documents/{document_id}/restoration", responses=rejections(404, 409, 422, 503, 507)
    )
    def restore(case_id: str, document_id: str, requested: RestoreMessage) -> DocumentMessage:
        """Go on with this version, the last intact one, after the disk has damaged the newest one.

        Its content is stored again as the newest version; documents that depended on the damaged one stay out
        of date.
        """
        found = store.restore(store.document(case_id, document_id), by=requested.by)
        return document_message(found, store.validity(found))


def _add_files(router: APIRouter, store: CaseStore) -> None:
    @router.get("/{case_id}/files", responses=rejections(404, 503))
    def files(case_id: str) -> FilesMessage:
        """Return the files of a case with sizes and checksums."""
        return files_message(store.files(case_id))

    @router.get(
        "/{case_id}/files/{file_id}",
        response_class=FileResponse,
        responses={200: {"content": {BINARY: {}}}, **rejections(404, 503)},
    )
    def file(case_id: str, file_id: str) -> FileResponse:
        """Return a file; supports `Range`."""
        found = store.file(case_id, file_id)
        return FileResponse(found.path, media_type=BINARY, filename=found.id)

    @router.post("/{case_id}/verification", responses=rejections(404, 503))
    def verify(case_id: str) -> VerificationMessage:
        """Verify the checksums of all files and documents of the case and return the damaged ones."""
        return verification_message(store.verify(case_id))

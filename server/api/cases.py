"""Cases: listed, made, opened, copied out and in, deleted; their documents and files."""

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
    VerificationMessage,
    WithdrawMessage,
    case_message,
    document_message,
    documents_message,
    files_message,
    verification_message,
)
from server.api.errors import rejections
from server.api.uploads import received
from server.security import acting
from server.store import CaseStore, StoreConflict

LARGEST_ARCHIVE_BYTES = 16 * 2**30
ZIP = "application/zip"
BINARY = "application/octet-stream"


def cases_router(store: CaseStore) -> APIRouter:
    """Everything under `/api/cases`. Plain functions: they wait for the disk, in threads."""
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
        """All cases, and which one is open."""
        opened = store.opened()
        return CasesMessage(
            opened_id=None if opened is None else opened.id,
            cases=[case_message(case) for case in store.list()],
        )

    @router.post("", status_code=201, responses=rejections(422, 503, 507))
    def create(asked: CaseNameMessage) -> CaseMessage:
        """Make a case."""
        return case_message(store.create(asked.name))


def _add_one(router: APIRouter, store: CaseStore) -> None:
    @router.get("/{case_id}", responses=rejections(404, 503))
    def case(case_id: str) -> CaseMessage:
        """One case."""
        return case_message(store.get(case_id))

    @router.patch("/{case_id}", responses=rejections(404, 422, 503, 507))
    def rename(case_id: str, asked: CaseNameMessage) -> CaseMessage:
        """Give a case another name."""
        return case_message(store.rename(case_id, asked.name))

    @router.post("/{case_id}/open", responses=rejections(404, 503, 507))
    def open_case(case_id: str) -> CaseMessage:
        """Make this the case that is worked in; the one that was open is closed by it."""
        return case_message(store.open(case_id))

    @router.post("/{case_id}/close", responses=rejections(404, 409, 503, 507))
    def close_case(case_id: str) -> CaseMessage:
        """Close this case; then none is open."""
        closed = store.get(case_id)
        opened = store.opened()
        if opened is None or opened.id != case_id:
            raise StoreConflict(
                "CASE_NOT_OPEN",
                f"the case {case_id} is not open",
                "Look at the list of cases for the one that is.",
                {"case_id": case_id},
            )
        store.close()
        return case_message(closed)

    @router.post("/{case_id}/deletion", status_code=204, responses=rejections(404, 409, 422, 503))
    def delete(case_id: str, asked: ConfirmationMessage) -> Response:
        """Delete a case and everything in it for ever. The word of confirmation is its name.

        An open case, or one that is being copied out or written, is not deleted (409).
        """
        store.delete(case_id, confirm=asked.confirm)
        return Response(status_code=204)


def _add_archives(router: APIRouter, store: CaseStore) -> None:
    @router.get(
        "/{case_id}/archive",
        response_class=FileResponse,
        responses={200: {"content": {ZIP: {}}}, **rejections(404, 503, 507)},
    )
    def copy_out(case_id: str, *, with_identity: bool = False) -> FileResponse:
        """The case as one archive (zip). Its name, and who the patient is, are in it only if asked for."""
        archive = store.copy_out(case_id, with_identity=with_identity)
        return FileResponse(
            archive.path,
            media_type=ZIP,
            filename=f"coaxial-case-{case_id[:6]}.zip",
            background=BackgroundTask(archive.path.unlink, missing_ok=True),
        )

    @router.post(
        "/archive",
        status_code=201,
        responses=rejections(413, 422, 503, 507),
        openapi_extra={"requestBody": {"required": True, "content": {ZIP: {}}}},
    )
    async def copy_in(request: Request) -> CaseMessage:
        """Take a case in from its archive, which is the body of the request: whole, or nothing of it.

        Its documents say from then on who took them in, and when; whom they name as their maker, only the
        archive says. Signatures in it do not count here.
        """
        by = acting(request.scope, None)
        async with received(request, store.home, max_bytes=LARGEST_ARCHIVE_BYTES) as path:
            return case_message(await to_thread.run_sync(lambda: store.copy_in(path, by=by)))


def _add_documents(router: APIRouter, store: CaseStore) -> None:
    @router.get("/{case_id}/documents", responses=rejections(404, 503))
    def documents(case_id: str) -> DocumentsMessage:
        """Every version of every document, with what it stands on, and whether it holds."""
        return documents_message(store.outline(case_id))

    @router.get("/{case_id}/documents/{document_id}", responses=rejections(404, 503))
    def document(case_id: str, document_id: str) -> DocumentMessage:
        """One version of a document with its content."""
        found = store.document(case_id, document_id)
        return document_message(found, store.standing(found))

    @router.post("/{case_id}/documents/{document_id}/withdrawal", responses=rejections(404, 422, 503, 507))
    def withdraw(case_id: str, document_id: str, asked: WithdrawMessage) -> DocumentMessage:
        """Say that a document no longer holds; what stands on it is out of date from then on."""
        found = store.withdraw(store.document(case_id, document_id), by=asked.by, reason=asked.reason)
        return document_message(found, store.standing(found))


def _add_files(router: APIRouter, store: CaseStore) -> None:
    @router.get("/{case_id}/files", responses=rejections(404, 503))
    def files(case_id: str) -> FilesMessage:
        """The files of a case, with their sizes and sums."""
        return files_message(store.files(case_id))

    @router.get(
        "/{case_id}/files/{file_id}",
        response_class=FileResponse,
        responses={200: {"content": {BINARY: {}}}, **rejections(404, 503)},
    )
    def file(case_id: str, file_id: str) -> FileResponse:
        """One file, whole; parts of it by `Range`."""
        found = store.file(case_id, file_id)
        return FileResponse(found.path, media_type=BINARY, filename=found.id)

    @router.post("/{case_id}/verification", responses=rejections(404, 503))
    def verify(case_id: str) -> VerificationMessage:
        """Read every file of the case from end to end, and tell those that are not as they were stored."""
        return verification_message(store.verify(case_id))

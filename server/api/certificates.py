"""Accuracy certificates of the tools in use: state, installation, and the files to take along."""

from anyio import to_thread
from fastapi import APIRouter, Request, Response

from server.api.errors import rejections
from server.api.uploads import received
from server.procedure.accuracy import AccuracyStep
from server.procedure.certificates import CertificateStep, ToolCertification
from server.store import Home
from server.stream.messages import Message, ProblemMessage, translated_problem

MAX_CERTIFICATE_BYTES = 2 * 2**20
CERTIFICATE_TYPES: dict[str, dict[str, object]] = {"application/json": {}, "application/pdf": {}}


class ToolCertificationMessage(Message):
    """Whether the accuracy of a tool in use is certified now."""

    tool: str
    marker: str
    certified: bool
    """Whether its certificate is valid now, for this camera, tool and version."""
    problem: ProblemMessage | None
    """Why it is not certified."""
    error_95_mm: float | None
    """Of its certificate, valid or not: 95 % of single tips are at most this far from the truth. Null without
    a certificate."""
    valid_until: str | None
    """UTC, ISO 8601."""
    issued_at: str | None
    issued_by: str | None


class CertificatesMessage(Message):
    """The tools of the newest image; none before the first image."""

    collecting: bool
    """Whether an accuracy test is in progress: see `/api/certificates/collection`."""
    tools: list[ToolCertificationMessage]


def certificates_router(step: CertificateStep, accuracy: AccuracyStep, home: Home) -> APIRouter:
    """Return the router of `/api/certificates`."""
    router = APIRouter(prefix="/api/certificates", tags=["tools"])

    @router.get("", responses=rejections(503))
    def certificates() -> CertificatesMessage:
        """Return whether the tools in use are certified, with the reason if not."""
        return _message(step, accuracy)

    @router.post(
        "",
        status_code=201,
        responses=rejections(413, 422, 503, 507),
        openapi_extra={"requestBody": {"required": True, "content": CERTIFICATE_TYPES}},
    )
    async def install(request: Request) -> CertificatesMessage:
        """Install the certificate in the request body, JSON or PDF as `coaxial certify issue` wrote it.

        It must be signed with the key of this installation. The one of the same marker is replaced.
        """
        async with received(request, home, max_bytes=MAX_CERTIFICATE_BYTES) as path:

            def put() -> CertificatesMessage:
                step.install(path.read_bytes())
                return _message(step, accuracy)

            return await to_thread.run_sync(put)

    @router.get(
        "/{marker}/json",
        response_class=Response,
        responses={200: {"content": {"application/json": {}}}, **rejections(404, 503)},
    )
    def signed_json(marker: str) -> Response:
        """Return the installed certificate of a marker as it was signed."""
        return _file(step.signed_json(marker), "application/json", "certificate.json")

    @router.get(
        "/{marker}/pdf",
        response_class=Response,
        responses={200: {"content": {"application/pdf": {}}}, **rejections(404, 503)},
    )
    def signed_pdf(marker: str) -> Response:
        """Return the installed certificate of a marker to print, signed, with its JSON attached."""
        return _file(step.signed_pdf(marker), "application/pdf", "certificate.pdf")

    return router


def _file(content: bytes, media_type: str, name: str) -> Response:
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(content, media_type=media_type, headers=headers)


def _message(step: CertificateStep, accuracy: AccuracyStep) -> CertificatesMessage:
    return CertificatesMessage(collecting=accuracy.is_collecting, tools=[_tool(one) for one in step.tools()])


def _tool(one: ToolCertification) -> ToolCertificationMessage:
    certificate = one.certificate
    return ToolCertificationMessage(
        tool=one.tool,
        marker=one.marker,
        certified=one.problem is None,
        problem=None if one.problem is None else translated_problem(one.problem),
        error_95_mm=None if certificate is None else certificate.error_95_mm,
        valid_until=None if certificate is None else certificate.valid_until.isoformat(),
        issued_at=None if certificate is None else certificate.issued_at.isoformat(),
        issued_by=None if certificate is None else certificate.issued_by,
    )

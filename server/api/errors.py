"""Every refusal has one shape: code, message, remedy, context."""

from typing import Any

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from server.errors import CaptureError, SetupOrderError
from server.jobs import JobUnknown
from server.security import rejections as door
from server.store import NotStored, OutOfDateError, StoreConflict, StoreError
from server.stream.errors import CameraUnknown, TooManyViewers
from server.stream.fitting.sizes import SizeUnknown
from server.stream.messages import ProblemMessage
from tracker.errors import CalibrationError, InvalidInput, NavigationError, PlanError, RegistrationError

_log = structlog.get_logger(__name__)

STATUS_OF: dict[type[NavigationError], int] = {
    CameraUnknown: 404,
    TooManyViewers: 503,
    SizeUnknown: 422,
    SetupOrderError: 409,
    CaptureError: 503,
    InvalidInput: 422,
    CalibrationError: 409,
    PlanError: 409,
    RegistrationError: 409,
    NotStored: 404,
    StoreConflict: 409,
    OutOfDateError: 409,
    StoreError: 503,
    JobUnknown: 404,
    **door.STATUS_OF,
}
# Where HTTP has a word of its own for what the code says.
STATUS_OF_CODE = {"STORE_FULL": 507, "UPLOAD_TOO_LARGE": 413, "BODY_TOO_LARGE": 413, "BODY_TOO_SLOW": 408}

# Of what did not come in time nothing more is waited for, and the line is cut.
TIMEOUT = 408
# Whose refusals say how long to wait.
AGAIN_LATER = 429

REJECTED_WORDS = {
    401: "Nobody is signed in, or no longer.",
    403: "Who is signed in may not do this, or a page that is none of this server asks for it.",
    404: "There is no such thing.",
    408: "It was not sent in time.",
    409: "It cannot be done as things stand.",
    413: "It is larger than is taken.",
    421: "This server does not answer to the name in `Host`.",
    422: "What was asked cannot be used.",
    429: "Too many wrong links or sessions came from there, or one link signed in too often; `Retry-After` "
    "says how long to wait.",
    500: "The server made a mistake.",
    503: "Not now.",
    507: "The disk is full, or what was done could not be written into the audit log.",
}
TOLD = {
    404: ("NOT_FOUND", "there is nothing at {path}", "Look at /api/docs for what can be asked."),
    405: (
        "METHOD_NOT_ALLOWED",
        "{method} is not possible at {path}",
        "Look at /api/docs for what can be asked.",
    ),
}
INTERNAL = ProblemMessage(
    code="INTERNAL",
    message="the server made a mistake while answering",
    remedy="Try again; if it comes back, send the server's log to the maintainer.",
    context={},
)


class NothingYet(NavigationError):
    """What was asked for is not there yet, and will be."""


STATUS_OF[NothingYet] = 503


def rejections(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """What OpenAPI says of a route's refusals."""
    return {status: {"model": ProblemMessage, "description": REJECTED_WORDS[status]} for status in statuses}


def status_of(error: NavigationError) -> int:
    """The HTTP status of an error: of its code, of its class, or of the nearest class above it."""
    if error.code in STATUS_OF_CODE:
        return STATUS_OF_CODE[error.code]
    return next((STATUS_OF[kind] for kind in type(error).__mro__ if kind in STATUS_OF), 500)


def install_errors(app: FastAPI) -> None:
    """Give every error of the application the one shape."""
    app.add_exception_handler(NavigationError, _navigation)
    app.add_exception_handler(HTTPException, _http)
    app.add_exception_handler(RequestValidationError, _invalid)
    app.add_middleware(InternalErrors)


def _answer(status: int, problem: ProblemMessage, headers: dict[str, str] | None = None) -> JSONResponse:
    kept = {"Cache-Control": "no-store", **(headers or {})}
    return JSONResponse(problem.model_dump(mode="json"), status_code=status, headers=kept)


async def _navigation(_request: Request, error: Exception) -> JSONResponse:
    if not isinstance(error, NavigationError):
        raise error
    told = ProblemMessage(code=error.code, message=error.message, remedy=error.remedy, context=error.context)
    status = status_of(error)
    headers = {
        TIMEOUT: {"Connection": "close"},
        AGAIN_LATER: {"Retry-After": str(error.context.get("wait_s"))},
    }
    return _answer(status, told, headers.get(status))


async def _http(request: Request, error: Exception) -> JSONResponse:
    if not isinstance(error, HTTPException):
        raise error
    path = request.url.path[:200]
    if isinstance(error.__cause__, NavigationError):
        # FastAPI's own 400 for whatever happened while it read the body.
        return await _navigation(request, error.__cause__)
    if isinstance(error.__cause__, ValueError | RecursionError):
        # FastAPI's own 400 for a body that is no text; a body that is no JSON is 422 everywhere else.
        told = ProblemMessage(
            code="REQUEST_INVALID",
            message="the body of the request is no JSON: it is no text in UTF-8, is nested too deeply, or "
            "has a number that is too long",
            remedy="Send JSON; /api/docs tells what this request takes.",
            context={"path": path},
        )
        return _answer(422, told)
    code, message, remedy = TOLD.get(
        error.status_code,
        (f"HTTP_{error.status_code}", str(error.detail), "Look at /api/docs for what can be asked."),
    )
    told = ProblemMessage(
        code=code,
        message=message.format(path=path, method=request.method) if error.status_code in TOLD else message,
        remedy=remedy,
        context={"path": path},
    )
    return _answer(error.status_code, told, dict(error.headers or {}))


async def _invalid(request: Request, error: Exception) -> JSONResponse:
    if not isinstance(error, RequestValidationError):
        raise error
    found = error.errors()
    first = found[0]
    where = ".".join(str(part) for part in first["loc"])
    # curl -d says that it sends a form, and the framework then says only that a text is no object.
    sent = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    is_form = sent in ("application/x-www-form-urlencoded", "text/plain")
    told = ProblemMessage(
        code="REQUEST_INVALID",
        message=f"{where}: {first['msg']}" + (f" (and {len(found) - 1} more)" if len(found) > 1 else ""),
        remedy=f"Send JSON and say so, with 'Content-Type: application/json' in place of {sent}."
        if is_form
        else "Look at /api/docs for what this request takes.",
        context={
            "path": request.url.path[:200],
            "problems": [
                {"where": ".".join(str(part) for part in one["loc"]), "what": one["msg"]} for one in found
            ],
        },
    )
    return _answer(422, told)


class InternalErrors:
    """ASGI middleware: logs what nobody expected, once, and answers without telling a stranger what."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on; answer 500 for an answer that did not begin."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        started = False

        async def note(message: Message) -> None:
            nonlocal started
            started = started or message["type"] == "http.response.start"
            await send(message)

        try:
            await self._app(scope, receive, note)
        except Exception:
            if started:
                # The answer is broken in the middle; only the server below can end it, and it logs.
                raise
            _log.exception("request_failed", method=scope["method"], path=scope["path"])
            await _answer(500, INTERNAL)(scope, receive, send)

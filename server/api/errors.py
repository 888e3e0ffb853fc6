"""Error responses: every error has the fields code, message, remedy and context."""

from typing import Any

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from server.errors import CaptureError, RecordingError, SetupOrderError
from server.hub.connection import HubError
from server.jobs import JobUnknown
from server.security import rejections as door
from server.store import NotFound, OutOfDateError, StoreConflict, StoreError
from server.stream.errors import CameraUnknown, TooManyViewers
from server.stream.messages import ProblemMessage, translated_problem
from server.stream.scaling.sizes import ChoiceUnknown
from tracker.errors import CalibrationError, InvalidInput, NavigationError, PlanError, RegistrationError

_log = structlog.get_logger(__name__)

STATUS_OF: dict[type[NavigationError], int] = {
    CameraUnknown: 404,
    TooManyViewers: 503,
    ChoiceUnknown: 422,
    SetupOrderError: 409,
    CaptureError: 503,
    RecordingError: 409,
    InvalidInput: 422,
    CalibrationError: 409,
    PlanError: 409,
    RegistrationError: 409,
    NotFound: 404,
    StoreConflict: 409,
    OutOfDateError: 409,
    StoreError: 503,
    JobUnknown: 404,
    HubError: 503,
    **door.STATUS_OF,
}
# Codes with a specific HTTP status.
STATUS_OF_CODE = {
    "HUB_REQUEST_OLD": 409,
    "HUB_REQUEST_REJECTED": 403,
    "HUB_SUPERVISORS_ONLY": 403,
    "RECORDING_BUDGET_EXCEEDED": 507,
    "RECORDING_DISK_FULL": 507,
    "STORE_FULL": 507,
    "UPLOAD_TOO_LARGE": 413,
    "BODY_TOO_LARGE": 413,
    "BODY_TOO_SLOW": 408,
}

# After a timeout the connection is closed.
TIMEOUT = 408
# Its response carries Retry-After.
TOO_MANY_REQUESTS = 429

STATUS_TEXTS = {
    401: "Not signed in, or the session has ended.",
    403: "The role does not permit this, or the request comes from a page of another origin.",
    404: "Not found.",
    408: "The request was not received in time.",
    409: "Not possible in the present state.",
    413: "The request is too large.",
    421: "The host name in `Host` is not a name of this server.",
    422: "The request is invalid.",
    429: "Too many failed logins from this address, or too many logins with one link; `Retry-After` is the "
    "waiting time in s.",
    500: "Internal server error.",
    503: "Temporarily unavailable.",
    507: "The disk is full, or the action could not be written to the audit log.",
}
HTTP_ERROR_TEXTS = {
    404: ("NOT_FOUND", "{path} does not exist", "See /api/docs for the available addresses."),
    405: (
        "METHOD_NOT_ALLOWED",
        "{path} does not support {method}",
        "See /api/docs for the available addresses.",
    ),
}
INTERNAL = ProblemMessage(
    code="INTERNAL",
    message="an internal error occurred in the server",
    remedy="Try again; if the error persists, send the server log to the maintainer.",
    context={},
    language="en",
)


class NotYetAvailable(NavigationError):
    """The requested data are not available yet."""


STATUS_OF[NotYetAvailable] = 503


# A reference: for a model FastAPI would build a validator for each status of each route, two thirds of all
# that it builds. The message is described in any case, because the live message contains it.
PROBLEM_CONTENT = {
    "application/json": {"schema": {"$ref": f"#/components/schemas/{ProblemMessage.__name__}"}}
}


def rejections(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Return the OpenAPI responses for these error statuses of a route."""
    return {status: {"description": STATUS_TEXTS[status], "content": PROBLEM_CONTENT} for status in statuses}


def status_of(error: NavigationError) -> int:
    """Return the HTTP status of an error: by its code, its class, or its nearest base class."""
    if error.code in STATUS_OF_CODE:
        return STATUS_OF_CODE[error.code]
    return next((STATUS_OF[kind] for kind in type(error).__mro__ if kind in STATUS_OF), 500)


def install_errors(app: FastAPI) -> None:
    """Register the handlers that turn every error into a `ProblemMessage`."""
    app.add_exception_handler(NavigationError, _navigation)
    app.add_exception_handler(HTTPException, _http)
    app.add_exception_handler(RequestValidationError, _invalid)
    app.add_middleware(InternalErrorMiddleware)


def _answer(status: int, problem: ProblemMessage, headers: dict[str, str] | None = None) -> JSONResponse:
    all_headers = {"Cache-Control": "no-store", **(headers or {})}
    return JSONResponse(problem.model_dump(mode="json"), status_code=status, headers=all_headers)


async def _navigation(_request: Request, error: Exception) -> JSONResponse:
    if not isinstance(error, NavigationError):
        raise error
    problem = translated_problem(error)
    status = status_of(error)
    headers = {
        TIMEOUT: {"Connection": "close"},
        TOO_MANY_REQUESTS: {"Retry-After": str(error.context.get("wait_s"))},
    }
    return _answer(status, problem, headers.get(status))


async def _http(request: Request, error: Exception) -> JSONResponse:
    if not isinstance(error, HTTPException):
        raise error
    path = request.url.path[:200]
    if isinstance(error.__cause__, NavigationError):
        # FastAPI answers 400 for any exception that is raised while it reads the body.
        return await _navigation(request, error.__cause__)
    if isinstance(error.__cause__, ValueError | RecursionError):
        # FastAPI answers 400 for a body that is not text; invalid JSON is 422 everywhere else.
        problem = ProblemMessage(
            code="REQUEST_INVALID",
            message="the request body is not valid JSON: it is not UTF-8 text, is nested too deeply, or "
            "contains a number that is too long",
            remedy="Send JSON as described in /api/docs.",
            context={"path": path},
            language="en",
        )
        return _answer(422, problem)
    code, message, remedy = HTTP_ERROR_TEXTS.get(
        error.status_code,
        (f"HTTP_{error.status_code}", str(error.detail), "See /api/docs for the available addresses."),
    )
    problem = ProblemMessage(
        code=code,
        message=message.format(path=path, method=request.method)
        if error.status_code in HTTP_ERROR_TEXTS
        else message,
        remedy=remedy,
        context={"path": path},
        language="en",
    )
    return _answer(error.status_code, problem, dict(error.headers or {}))


async def _invalid(request: Request, error: Exception) -> JSONResponse:
    if not isinstance(error, RequestValidationError):
        raise error
    found = error.errors()
    first = found[0]
    where = ".".join(str(part) for part in first["loc"])
    # curl -d sends the content type of a form, for which the message of the framework is misleading.
    sent = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    is_form = sent in ("application/x-www-form-urlencoded", "text/plain")
    problem = ProblemMessage(
        code="REQUEST_INVALID",
        message=f"{where}: {first['msg']}" + (f" (and {len(found) - 1} more)" if len(found) > 1 else ""),
        remedy=f"Send JSON with 'Content-Type: application/json' instead of {sent}."
        if is_form
        else "See /api/docs for the fields of this request.",
        context={
            "path": request.url.path[:200],
            "problems": [
                {"where": ".".join(str(part) for part in one["loc"]), "what": one["msg"]} for one in found
            ],
        },
        language="en",
    )
    return _answer(422, problem)


class InternalErrorMiddleware:
    """ASGI middleware: log an unexpected exception once and answer 500 without its details."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Run the application; answer 500 if it fails before its response starts."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        started = False

        async def track_start(message: Message) -> None:
            nonlocal started
            started = started or message["type"] == "http.response.start"
            await send(message)

        try:
            await self._app(scope, receive, track_start)
        except Exception:
            if started:
                # The response has started; uvicorn closes the connection and logs the exception.
                raise
            _log.exception("request_failed", method=scope["method"], path=scope["path"])
            await _answer(500, INTERNAL)(scope, receive, send)

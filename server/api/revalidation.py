"""Responses that a browser caches and revalidates on each request."""

from collections.abc import Callable, Mapping

from fastapi import Request, Response

CACHE_CONTROL = "private, no-cache"


def unless_known(
    request: Request,
    tag: str,
    respond: Callable[[Mapping[str, str]], Response],
    *,
    headers: Mapping[str, str] | None = None,
) -> Response:
    """Return 304 if the browser has the response with this ETag, else the response.

    Args:
        request: The request, with the ETags that the browser has.
        tag: ETag without its quotes; it changes with the content.
        respond: Returns the response with these headers.
        headers: Further headers of both responses.
    """
    known = {"ETag": f'"{tag}"', "Cache-Control": CACHE_CONTROL, **(headers or {})}
    if known["ETag"] in request.headers.get("if-none-match", ""):
        return Response(status_code=304, headers=known)
    return respond(known)

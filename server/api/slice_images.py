"""PNG images of CT slices: query parameters, geometry headers, and browser caching.

The server resamples the slices and sends each with its geometry: pixels and numbers have one source, only
visible slices are transferred, and no GPU is needed on the tablet. Scrolling needs a connection.
"""

import hashlib
from collections.abc import Callable, Mapping
from typing import Annotated, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt
from fastapi import Query, Request, Response

from server.api.revalidation import unless_known
from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.plan.slices import WINDOWS, Window

PNG = "image/png"
PNG_ANSWER: dict[int | str, dict[str, object]] = {200: {"content": {PNG: {}}}}
# Pixels and geometry are in one response, so that a page cannot combine those of different slices.
SLICE_PLACE, SLICE_CT = "Slice-Place", "Slice-Ct"
SLICE_ANSWER: dict[int | str, dict[str, object]] = {
    200: {
        "content": {PNG: {}},
        "headers": {
            SLICE_PLACE: {
                "description": "A SliceMessage as JSON: positions of the pixels in the patient.",
                "required": True,
                "schema": {"type": "string"},
            },
            SLICE_CT: {
                "description": "Id of the document of the CT.",
                "required": True,
                "schema": {"type": "string"},
            },
        },
    }
}
# Revalidated each time, because the address does not change when the CT is replaced.
HU: TypeAlias = Annotated[float, Query(ge=-40_000.0, le=40_000.0, allow_inf_nan=False)]
WindowHu: TypeAlias = Annotated[float, Query(gt=0.0, le=80_000.0, allow_inf_nan=False)]
SlabMm: TypeAlias = Annotated[float, Query(ge=0.0, le=100.0, allow_inf_nan=False)]
PixelMm: TypeAlias = Annotated[float, Query(ge=0.05, le=20.0, allow_inf_nan=False)]
SizeMm: TypeAlias = Annotated[float, Query(ge=5.0, le=400.0, allow_inf_nan=False)]


def window_from_query(window: float | None, level: float | None, preset: str | None) -> Window:
    """Return the display window: a preset by name, overridden by window and level.

    Raises:
        InvalidInput: PRESET_UNKNOWN.
        PlanError: WINDOW_INVALID.
    """
    name = (preset or "bone").replace("-", " ").lower()
    if name not in WINDOWS:
        available = ", ".join(WINDOWS)
        raise InvalidInput(
            "PRESET_UNKNOWN",
            f"there is no preset '{name[:40]}', available are {available}",
            "Use one of them, or give window and level in HU.",
            {"preset": name[:40], "presets": list(WINDOWS), "available": available},
        )
    chosen = WINDOWS[name]
    return Window(
        centre_hu=chosen.centre_hu if level is None else level,
        width_hu=chosen.width_hu if window is None else window,
    )


def point_from_query(text: str, *, name: str) -> Array:
    """Parse `x,y,z` in mm.

    Raises:
        InvalidInput: POINT_INVALID.
    """
    try:
        point = np.array([float(word) for word in text.split(",")])
    except ValueError:
        point = np.zeros(0)
    if point.shape != (3,) or not np.isfinite(point).all() or np.abs(point).max() > 10_000.0:
        raise InvalidInput(
            "POINT_INVALID",
            f"{name} is '{text[:60]}', expected three numbers within 10000 mm",
            f"Give {name}=x,y,z in mm of LPS.",
            {"name": name, "given": text[:60]},
        )
    return point


def picture(request: Request, made_from: str, draw: Callable[[], npt.NDArray[np.uint8]]) -> Response:
    """Return a PNG, or 304 if the browser has it.

    Args:
        request: Its address is part of the ETag.
        made_from: Ids of the documents from which it is drawn.
        draw: Returns the image: (height, width) grey or (height, width, 3) BGR.
    """
    return image_with_headers(request, made_from, lambda: (draw(), {}))


def image_with_headers(
    request: Request,
    made_from: str,
    draw: Callable[[], tuple[npt.NDArray[np.uint8], Mapping[str, str]]],
) -> Response:
    """Return the same as `picture`, with additional headers that the browser caches with the image."""
    known_by = hashlib.sha256(f"{made_from} {request.url.path}?{request.url.query}".encode()).hexdigest()

    def respond(headers: Mapping[str, str]) -> Response:
        pixels, reported = draw()
        encoded, content = cv2.imencode(".png", pixels)
        if not encoded:
            raise RuntimeError("the image could not be encoded")
        return Response(content.tobytes(), media_type=PNG, headers={**headers, **reported})

    return unless_known(request, known_by[:32], respond)

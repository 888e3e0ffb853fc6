"""Pictures of the CT: what may be asked of them, and how a browser keeps them until the CT changes.

The server cuts the slices, and each comes with its place in the patient: pixels and numbers are from one
reader, only what is looked at is sent, and a tablet's GPU is not needed. Scrolling needs a connection.
"""

import hashlib
from collections.abc import Callable, Mapping
from typing import Annotated, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt
from fastapi import Query, Request, Response

from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.plan.slices import WINDOWS, Window

PNG = "image/png"
PNG_ANSWER: dict[int | str, dict[str, object]] = {200: {"content": {PNG: {}}}}
# Pixels and their place come in one answer, so that no page can lay one slice's numbers on another's picture.
SLICE_PLACE, SLICE_CT = "Slice-Place", "Slice-Ct"
SLICE_ANSWER: dict[int | str, dict[str, object]] = {
    200: {
        "content": {PNG: {}},
        "headers": {
            SLICE_PLACE: {
                "description": "A SliceMessage as JSON: where the pixels lie in the patient.",
                "required": True,
                "schema": {"type": "string"},
            },
            SLICE_CT: {
                "description": "The id of the document of the CT that was cut.",
                "required": True,
                "schema": {"type": "string"},
            },
        },
    }
}
# Asked again each time, because the address stays when the CT is replaced.
KEEP = "private, no-cache"
HU: TypeAlias = Annotated[float, Query(ge=-40_000.0, le=40_000.0, allow_inf_nan=False)]
WindowHu: TypeAlias = Annotated[float, Query(gt=0.0, le=80_000.0, allow_inf_nan=False)]
SlabMm: TypeAlias = Annotated[float, Query(ge=0.0, le=100.0, allow_inf_nan=False)]
PixelMm: TypeAlias = Annotated[float, Query(ge=0.05, le=20.0, allow_inf_nan=False)]
SizeMm: TypeAlias = Annotated[float, Query(ge=5.0, le=400.0, allow_inf_nan=False)]


def asked_window(window: float | None, level: float | None, preset: str | None) -> Window:
    """What is shown in grey: a preset by its name, and window and level in its place.

    Raises:
        InvalidInput: PRESET_UNKNOWN.
        PlanError: WINDOW_INVALID.
    """
    name = (preset or "bone").replace("-", " ").lower()
    if name not in WINDOWS:
        raise InvalidInput(
            "PRESET_UNKNOWN",
            f"there is no preset '{name[:40]}', those are {', '.join(WINDOWS)}",
            "Name one of them, or give window and level in HU.",
            {"preset": name[:40], "presets": list(WINDOWS)},
        )
    chosen = WINDOWS[name]
    return Window(
        centre_hu=chosen.centre_hu if level is None else level,
        width_hu=chosen.width_hu if window is None else window,
    )


def asked_point(text: str, *, name: str) -> Array:
    """The point of `x,y,z` in mm.

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
            f"{name} is '{text[:60]}', needed three numbers within 10000 mm",
            f"Give {name}=x,y,z in mm of LPS.",
            {name: text[:60]},
        )
    return point


def picture(request: Request, made_from: str, draw: Callable[[], npt.NDArray[np.uint8]]) -> Response:
    """A PNG, which is not drawn where the browser has it already.

    Args:
        request: whose address is part of what the picture is known by.
        made_from: ids of the documents that it is drawn from.
        draw: gives it: (height, width) grey or (height, width, 3) BGR.
    """
    return placed_picture(request, made_from, lambda: (draw(), {}))


def placed_picture(
    request: Request,
    made_from: str,
    draw: Callable[[], tuple[npt.NDArray[np.uint8], Mapping[str, str]]],
) -> Response:
    """The same with headers that say what was drawn; a browser that has the picture has them with it."""
    known_by = hashlib.sha256(f"{made_from} {request.url.path}?{request.url.query}".encode()).hexdigest()
    headers = {"ETag": f'"{known_by[:32]}"', "Cache-Control": KEEP}
    if headers["ETag"] in request.headers.get("if-none-match", ""):
        return Response(status_code=304, headers=headers)
    pixels, told = draw()
    encoded, content = cv2.imencode(".png", pixels)
    if not encoded:
        raise RuntimeError("a picture could not be encoded")
    return Response(content.tobytes(), media_type=PNG, headers={**headers, **told})

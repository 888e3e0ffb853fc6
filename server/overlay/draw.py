"""Drawing of snapshot and alarms into a copy of an image, and its JPEG encoding."""

from enum import StrEnum

import cv2
import numpy as np
import numpy.typing as npt

from server.overlay.alarm_band import draw_alarm_band
from server.overlay.bullseye import Inset, Target, draw_bullseye, reach_of
from server.overlay.card import draw_no_camera
from server.overlay.channel import draw_channel, draw_placed_screw
from server.overlay.drill import draw_drill, draw_marker
from server.overlay.headline import draw_headline
from server.overlay.panel import MARGIN_PX, WIDTH_PX, draw_panel, draw_small_print
from server.overlay.panel_readings import panel_of
from server.overlay.primitives import Image
from server.overlay.view import View
from server.texts import Language
from tracker.errors import InvalidInput
from tracker.navigation import Absent, Deviation, NavigationSnapshot, bullseye_view
from tracker.navigation.alarms import QUIET, AlarmSnapshot
from tracker.pose import Seen

BASE_HEIGHT_PX = 720.0
# Width that the texts at the top and in the panel need side by side.
MIN_WIDTH_PX = 880.0
GAP_PX = 8.0
AHEAD_MM = 50.0
PAST_TARGET_MM = 10.0
FARTHEST_AHEAD_MM = 150.0


class OverlayContent(StrEnum):
    """What is drawn into the image.

    GEOMETRY is for viewers that display figures and alarms beside the picture: they update figures and
    alarms with each image, and the picture less often.
    """

    FULL = "full"
    GEOMETRY = "geometry"


def draw_overlay(
    image: npt.NDArray[np.uint8],
    snapshot: NavigationSnapshot,
    alarms: AlarmSnapshot = QUIET,
    *,
    language: Language = "en",
    content: OverlayContent = OverlayContent.FULL,
) -> Image:
    """Return a copy of the image with the overlay.

    Without a camera calibration only outlines, names and scores are drawn. Absent results are not drawn; the
    panel states the reason. The blank image of an external tracker states that there is no camera.

    Args:
        image: uint8, BGR (h, w, 3) or grey (h, w); the image from which the snapshot was computed.
        snapshot: Results of this image.
        alarms: Alarms of that moment.
        language: Language of the text.
        content: Everything, or only markers, drills and channel.

    Raises:
        InvalidInput: OVERLAY_SIZE, image and snapshot differ in size.
    """
    if (image.shape[1], image.shape[0]) != tuple(snapshot.size_wh_px):
        width, height = snapshot.size_wh_px
        raise InvalidInput(
            "OVERLAY_SIZE",
            f"the image has {image.shape[1]}x{image.shape[0]} px, but its snapshot is of {width}x{height} px",
            "Draw each snapshot into the image from which it was computed.",
            {"image_wh_px": [image.shape[1], image.shape[0]], "size_wh_px": [width, height]},
        )
    drawn = np.repeat(image[..., None], 3, axis=2) if image.ndim == 2 else image.copy(order="C")
    # The width limits the scale of a portrait image.
    scale = min(drawn.shape[0] / BASE_HEIGHT_PX, drawn.shape[1] / MIN_WIDTH_PX)
    if not snapshot.setup.has_images:
        draw_no_camera(drawn, language, scale=scale)
    else:
        _draw_projected(drawn, snapshot, scale)
    if content is OverlayContent.GEOMETRY:
        return drawn
    panel = panel_of(snapshot, alarms, language)
    top_px = draw_panel(drawn, panel, scale=scale)
    beside = None
    if panel.readings:
        top_px = _draw_inset(drawn, snapshot, snapshot.displayed_tool, below_px=top_px, scale=scale)
        left_px, bottom_px = MARGIN_PX * scale, top_px - GAP_PX * scale
        beside = draw_headline(
            drawn, panel.headline, language, left_px=left_px, bottom_px=bottom_px, scale=scale
        )
    draw_small_print(drawn, snapshot, language=language, scale=scale)
    draw_alarm_band(drawn, alarms, scale=scale, language=language, beside=beside)
    return drawn


def _draw_projected(image: Image, snapshot: NavigationSnapshot, scale: float) -> None:
    """Draw what is measured where it lies in the image."""
    if snapshot.setup.camera_calibrated:
        _draw_theatre(image, snapshot, scale)
    for name, sighting in snapshot.sightings.items():
        if isinstance(sighting, Seen):
            draw_marker(image, name, sighting, scale=scale)


def _draw_theatre(image: Image, snapshot: NavigationSnapshot, scale: float) -> None:
    """Draw the channel, and every visible drill over it."""
    setup = snapshot.setup
    view = View.of(setup.camera)
    if not isinstance(setup.channel, Absent) and not isinstance(snapshot.vertebra, Absent):
        camera_from_vertebra = snapshot.vertebra.camera_from_vertebra
        for screw in setup.placed_screws:
            draw_placed_screw(image, view, camera_from_vertebra, screw, scale)
        draw_channel(image, view, camera_from_vertebra, setup.channel, scale)
    for name, in_view in snapshot.tools.items():
        if not isinstance(in_view, Absent):
            ahead = _ahead_mm(snapshot.deviations[name])
            draw_drill(image, view, setup.tools[name], in_view, ahead_mm=ahead, scale=scale)


def _draw_inset(
    image: Image, snapshot: NavigationSnapshot, tool: str, *, below_px: float, scale: float
) -> float:
    """Draw the view along the channel above the panel, for the tool of the panel.

    Returns the upper edge in px of panel and inset.
    """
    channel = snapshot.setup.channel
    if isinstance(channel, Absent):
        return below_px
    placed = snapshot.vertebra_from_tool(tool)
    if isinstance(placed, Absent):
        return below_px
    side = WIDTH_PX * scale
    top_px = below_px - GAP_PX * scale - side
    seen, judged = bullseye_view(placed, channel, snapshot.setup.side), snapshot.analyses[tool]
    draw_bullseye(
        image,
        Inset(
            left_px=MARGIN_PX * scale,
            top_px=top_px,
            side_px=side,
            extent_mm=reach_of(channel),
            scale=scale,
        ),
        Target(
            seen=seen,
            channel_radius_mm=channel.radius_mm,
            drill_radius_mm=snapshot.setup.tools[tool].radius_mm,
            tip_covariance_mm2=None
            if isinstance(judged, Absent)
            else seen.across_mm2(judged.spread.tip_covariance_mm2),
        ),
    )
    return top_px


def _ahead_mm(deviation: Deviation | Absent) -> float:
    """Return how far the drill's line is extended beyond the tip: slightly past the planned end."""
    if isinstance(deviation, Absent):
        return AHEAD_MM
    return float(np.clip(deviation.remaining_mm + PAST_TARGET_MM, PAST_TARGET_MM, FARTHEST_AHEAD_MM))


def encode_jpeg(image: npt.NDArray[np.uint8], quality: int) -> bytes:
    """Encode the image as JPEG of this quality (1 to 100).

    Raises:
        InvalidInput: IMAGE_NOT_ENCODED, the image has no pixels or is too large for JPEG (65,500 px).
    """
    try:
        done, encoded = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, int(quality)])
    except cv2.error:
        done = False
    if not done:
        raise InvalidInput(
            "IMAGE_NOT_ENCODED",
            f"an image of shape {image.shape} cannot be encoded as JPEG",
            "Use images with 1 or 3 channels and at most 65,500 px on a side.",
            {"shape": str(image.shape)},
        )
    return encoded.tobytes()

"""Do blur, uneven light and something over its border explain what a square shows, and only they?

An image that is out of focus, has a shadow's edge or a highlight in it, or is partly covered, is not like the
model as it is printed. But each of these has its own law: blur spreads the outline as it spreads the inside;
light is bright or dim over whole regions, never negative; a cover is one piece that comes over the border.
What is left when these are fitted says far more than before of whether the inside is the model's.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.fields import (
    FIELDS,
    WIDE,
    Mask,
    gain_terms,
    grid,
    inside_square,
    light_terms,
    pictures,
    sampled,
    shadow_in,
    spectrum_of,
)

ROUNDS, ROUNDS_AGAIN = 6, 4
# Blur to begin with: a camera in focus, its pixel, the sampling between pixels.
FIRST_BLUR_PX, LEAST_BLUR_PX, MOST_BLUR_PX = 0.8, 0.3, 3.6
OUTLIER_CONTRAST = 0.2
SATURATED_GREY = 250.0
HIDDEN_CONTRAST, CLEAR_CONTRAST = 0.35, 0.2
LEAST_PIECE = 3
MOST_CLEAR_RATIO = 0.1
SAME_COVER_CONTRAST, MOST_SLOPE = 0.35, 0.12
# Light is nowhere under this part of the brightest: a field that is dark is ink, not night.
LEAST_GAIN_RATIO = 0.08

# Light that varies smoothly with a shadow's edge in it, and light with a highlight.
ATTEMPTS = ((2, True), (4, False))
WORTH_ANOTHER_LIGHT = 0.75
COVER_ROUNDS = 2
# Squares with something else inside reach 0.95 at 14 px and 0.9 at 30 px under blur, shadow, glare and cover;
# the marker itself has 0.97 and more. What is small has little to say, and what is covered less.
LIKENESS_SIDES_PX, LEAST_LIKENESS = (18.0, 26.0, 34.0), (0.98, 0.96, 0.95)
COVERED_MORE = 0.01
COVERED_RATIO, MOST_HIDDEN_RATIO = 0.03, 0.45
LEAST_AREA_RATIO = 3 / FIELDS**2 - 1e-9
MOST_MOVED_PX, MOST_MOVED_SIDE_RATIO = 2.0, 0.04
# A cover's own edge pulls a fit to it: where there is one, the edges must have been right already.
MOST_MOVED_COVERED_PX, MOST_MOVED_COVERED_SIDE_RATIO = 0.8, 0.02
# Blurred over more of its side than this, one square is like another.
MOST_BLUR_SIDE_RATIO = 0.135

UNIT = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
_Fitted = tuple[Array, Array, Array, Array]  # seen, the picture, what is left, the contrast


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """How far blur, light and cover explain the pixels of a square.

    Attributes:
        side_px: of the square in the image.
        likeness: correlation of what is visible with the model, blur and light fitted, -1..1.
        inner_likeness: the same where the model has its shape, the outline left out.
        hidden_ratio: part of the square that is covered, 0..1.
        inside_ratio: area of the largest piece that contradicts and is not covered, by the square's.
        corners_px: (4, 2), where they explain it best.
        moved_px: how far the corners (4, 2) had to be moved to explain it best, the farthest.
        blur_px: (2,), sd along the sharpest and the most blurred direction.
    """

    side_px: float
    likeness: float
    inner_likeness: float
    hidden_ratio: float
    inside_ratio: float
    corners_px: Array
    moved_px: float
    blur_px: tuple[float, float]

    @property
    def explains(self) -> bool:
        """Whether nothing is left that would need another shape to explain it."""
        covered = self.hidden_ratio > COVERED_RATIO
        px, ratio = (
            (MOST_MOVED_COVERED_PX, MOST_MOVED_COVERED_SIDE_RATIO)
            if covered
            else (MOST_MOVED_PX, MOST_MOVED_SIDE_RATIO)
        )
        least = float(np.interp(self.side_px, LIKENESS_SIDES_PX, LEAST_LIKENESS))
        return (
            min(self.likeness, self.inner_likeness) >= least + COVERED_MORE * covered
            and self.inside_ratio < LEAST_AREA_RATIO
            and self.hidden_ratio <= MOST_HIDDEN_RATIO
            and self.moved_px <= max(px, ratio * self.side_px)
            and self.blur_px[1] <= MOST_BLUR_SIDE_RATIO * self.side_px
        )


@dataclass(slots=True)
class _State:
    """Where the fit is. Mutable: it walks."""

    corners: Array  # (4, 2) in the unit square
    blur: Array  # (3,) variances along u, v, and between, in fields
    gain: Array  # (WIDE, WIDE)
    visible: Mask
    shadow: Array | None = None
    order: int = 2  # of the light that is added


def explanation_of(
    image: GreyImage, square: GreyImage, corners_px: Array, *, side_px: float
) -> Explanation | None:
    """Explain a grey image (h, w) by a model (n, n) at about these corners (4, 2); None if it has none of it.

    `corners_px` are pixels of `image`: top-left, top-right, bottom-right, bottom-left of the printed face.
    """
    best: Explanation | None = None
    for order, with_shadow in ATTEMPTS:
        found = _attempt(image, square, corners_px, side_px=side_px, order=order, with_shadow=with_shadow)
        if found is not None and (best is None or found.likeness > best.likeness):
            best = found
        if best is None or best.explains or best.likeness < WORTH_ANOTHER_LIGHT:
            break
    return best


def _attempt(
    image: GreyImage,
    square: GreyImage,
    corners_px: Array,
    *,
    side_px: float,
    order: int,
    with_shadow: bool,
) -> Explanation | None:
    """The explanation by light of this order, with or without a straight edge in it."""
    field_px = max(side_px, 8.0) / FIELDS
    state = _State(
        corners=UNIT.copy(),
        blur=np.array([1.0, 1.0, 0.0]) * (FIRST_BLUR_PX / field_px) ** 2,
        gain=np.ones((WIDE, WIDE)),
        visible=np.ones((WIDE, WIDE), np.bool_),
        order=order,
    )
    to_px = np.asarray(
        cv2.getPerspectiveTransform(UNIT.astype(np.float32), corners_px.astype(np.float32)), dtype=np.float64
    )
    spectrum = spectrum_of(square)
    fitted = _walk(image, to_px, spectrum, state, field_px, ROUNDS)
    if fitted is not None and with_shadow:
        state.shadow = shadow_in(fitted[0], fitted[1])
        fitted = _walk(image, to_px, spectrum, state, field_px, ROUNDS_AGAIN)
    # What is covered has no say; without it, what is covered shows more clearly.
    for _ in range(COVER_ROUNDS):
        if fitted is None:
            return None
        hidden, _ = _hidden(*fitted)
        if not hidden.any():
            break
        state.visible = ~hidden
        if not (state.visible & inside_square()).any():
            return None
        fitted = _walk(image, to_px, spectrum, state, field_px, ROUNDS_AGAIN)
    return None if fitted is None else _explanation(state, fitted, side_px, to_px)


def _explanation(state: _State, fitted: _Fitted, side_px: float, to_px: Array) -> Explanation:
    seen, expected, rest, _ = fitted
    hidden, inside = _hidden(*fitted)
    visible = ~hidden & state.visible
    light = light_terms(state.shadow, order=state.order)
    telling = visible & (seen < SATURATED_GREY)
    return Explanation(
        side_px=side_px,
        likeness=_likeness(seen, rest, telling & inside_square(), light),
        inner_likeness=_likeness(seen, rest, telling & _shape(expected), light),
        hidden_ratio=1.0 - float(visible[inside_square()].mean()),
        inside_ratio=inside / FIELDS**2,
        corners_px=np.asarray(cv2.perspectiveTransform(state.corners[None], to_px)[0]),
        moved_px=float(np.abs(state.corners - UNIT).max()) * side_px,
        blur_px=_blur_px(state.blur, max(side_px, 8.0) / FIELDS),
    )


def _blur_px(blur: Array, field_px: float) -> tuple[float, float]:
    least, most = np.linalg.eigvalsh(np.array([[blur[0], blur[2]], [blur[2], blur[1]]]))
    return float(np.sqrt(max(least, 0.0))) * field_px, float(np.sqrt(max(most, 0.0))) * field_px


def _walk(
    image: GreyImage, to_px: Array, spectrum: Array, state: _State, field_px: float, rounds: int
) -> _Fitted | None:
    """Gauss-Newton of place, blur and light; None where the model has no contrast."""
    predicted: Array = np.zeros((WIDE, WIDE))
    weight = state.visible.astype(np.float64)
    for turn in range(rounds):
        seen = sampled(image, to_px, state.corners)
        shown = pictures(spectrum, state.blur)
        light, gains = light_terms(state.shadow, order=state.order), gain_terms(state.shadow)
        basis = _basis(shown, state.gain, light, gains)
        # Where the sensor is full, brighter is as good.
        values = np.where(seen >= SATURATED_GREY, np.maximum(seen, predicted), seen)
        solution = _solved(basis, values.ravel(), weight.ravel())
        predicted = (basis @ solution).reshape(seen.shape)
        rest = seen - predicted
        n = light.shape[1]
        free = n + gains.shape[1]
        gain = (gains @ solution[n:free]).reshape(seen.shape)
        contrast = float(np.median(gain[inside_square() & state.visible]))
        if contrast <= 1.0:
            return None
        rest[(seen >= SATURATED_GREY) & (rest < 0.0)] = 0.0
        local = np.maximum(gain, 0.25 * contrast)
        state.gain = np.maximum(gain, 0.05 * contrast)
        weight = state.visible / (1.0 + (rest / (OUTLIER_CONTRAST * local)) ** 2) ** 2
        if turn < rounds - 1:
            _step(state, solution[free:], field_px)
    return seen, shown[0], rest, gain


def _step(state: _State, step: Array, field_px: float) -> None:
    """Move the corners and change the blur by what the fit says."""
    x = state.corners * 2.0 - 1.0
    reach = 0.7 / field_px
    terms = np.column_stack([np.ones(4), x])
    moved = np.column_stack([terms @ step[0:3], terms @ step[3:6]])
    far = float(np.abs(moved).max())
    state.corners = state.corners - moved * min(1.0, reach / max(far, 1e-9)) / FIELDS
    least, most = (LEAST_BLUR_PX / field_px) ** 2, (MOST_BLUR_PX / field_px) ** 2
    change = np.clip(step[6:9], -0.5 * state.blur[:2].max() - 0.3, state.blur[:2].max() + 0.3)
    blur = state.blur + change
    values, vectors = np.linalg.eigh(np.array([[blur[0], blur[2]], [blur[2], blur[1]]]))
    bounded = (vectors * np.clip(values, least, most)) @ vectors.T
    state.blur = np.array([bounded[0, 0], bounded[1, 1], bounded[0, 1]])


def _basis(shown: list[Array], gain: Array, light: Array, gains: Array) -> Array:
    """All columns of the fit: light, contrast, place (6) and blur (3)."""
    u, v = grid()
    picture, du, dv, *blurs = shown
    moves = [gain * one for one in (du, du * u, du * v, dv, dv * u, dv * v, *blurs)]
    contrast = gains * picture.ravel()[:, None]
    return np.column_stack([light, contrast, *(one.ravel() for one in moves)])


def _solved(basis: Array, values: Array, weight: Array) -> Array:
    weighted = basis * weight[:, None]
    matrix = weighted.T @ basis
    ridge = 1e-6 * np.diag(np.diag(matrix)) + 1e-9 * np.eye(len(matrix))
    return np.asarray(np.linalg.solve(matrix + ridge, weighted.T @ values))


def _hidden(seen: Array, picture: Array, rest: Array, gain: Array) -> tuple[Mask, int]:
    """What lies over the square from outside, and the area of the largest other contradicting piece."""
    night = LEAST_GAIN_RATIO * float(gain.max())
    contrast = np.maximum(gain, night)
    smooth = cv2.blur(rest / contrast, (3, 3), borderType=cv2.BORDER_REPLICATE)
    wrong = np.abs(smooth) > HIDDEN_CONTRAST
    count, labels, stats, _ = cv2.connectedComponentsWithStats(wrong.astype(np.uint8), connectivity=8)
    outer = ~inside_square()
    hidden = gain <= night
    pieces = []
    for label in range(1, count):
        piece = labels == label
        if int(stats[label][4]) < LEAST_PIECE:
            continue
        if (piece & outer).any():
            hidden |= piece
        else:
            pieces.append(piece)
    inside = 0
    covers = hidden.copy()
    for piece in pieces:
        if _goes_on(piece, covers, (seen, picture, rest, contrast)):
            hidden |= piece
        else:
            inside = max(inside, int(piece.sum()))
    grown = cv2.dilate(hidden.astype(np.uint8), np.ones((3, 3), np.uint8)).astype(np.bool_)
    return grown, inside


def _goes_on(piece: Mask, covers: Mask, fitted: _Fitted) -> bool:
    """Whether a piece inside goes on, unseen for being as dark as the ink, to what covers the outside.

    It does where one hull over both has nothing clear of the model in it, the outline least of all: in mere
    shadow the outline is faint and there.
    """
    seen, picture, rest, contrast = fitted
    count, labels = cv2.connectedComponents(covers.astype(np.uint8), connectivity=8)
    grey = float(np.median(seen[piece]))
    clear = (np.abs(rest) < CLEAR_CONTRAST * contrast) & (np.abs(seen - grey) > 0.4 * contrast)
    for label in range(1, count):
        end = labels == label
        alike = abs(float(np.median(seen[end])) - grey) < SAME_COVER_CONTRAST * float(
            np.median(contrast[end])
        )
        if not alike or end.sum() < 0.5 * piece.sum():
            continue
        v, u = np.nonzero(piece | end)
        area = np.zeros(piece.shape, np.uint8)
        cv2.fillConvexPoly(area, cv2.convexHull(np.stack([u, v], axis=1).astype(np.int32)), 1)
        over = area > 0
        if (
            float(clear[over].mean()) < MOST_CLEAR_RATIO
            and _slope(seen, picture, over, contrast) < MOST_SLOPE
        ):
            return True
    return False


def _slope(seen: Array, picture: Array, area: Mask, contrast: Array) -> float:
    """How much of the model's contrast is seen in an area, 0..1."""
    model = picture[area] - picture[area].mean()
    spread = float(model @ model)
    return float(model @ seen[area]) / (spread * float(np.median(contrast[area]))) if spread > 0.0 else 0.0


def _shape(picture: Array) -> Mask:
    """Where the model has its shape: around what is bright within the outline."""
    u, v = grid()
    bright = (picture > 0.5) & (np.maximum(np.abs(u), np.abs(v)) < 0.85)
    rows, columns = np.nonzero(bright)
    if len(rows) == 0:
        return inside_square()
    out = np.zeros_like(bright)
    out[max(rows.min() - 1, 0) : rows.max() + 2, max(columns.min() - 1, 0) : columns.max() + 2] = True
    return np.asarray(out & inside_square())


def _likeness(seen: Array, rest: Array, chosen: Mask, light: Array) -> float:
    """Root of the part that the model explains of what light alone leaves over."""
    if int(chosen.sum()) < 40:
        return 0.0
    light = light[chosen.ravel()]
    values = seen[chosen]
    alone = values - light @ np.linalg.lstsq(light, values, rcond=None)[0]
    whole, left = float(alone @ alone), float((rest[chosen] ** 2).sum())
    return float(np.sqrt(max(1.0 - left / whole, 0.0))) if whole > 0.0 else 0.0

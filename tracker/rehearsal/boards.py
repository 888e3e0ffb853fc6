"""Printed calibration boards, and the hand that presents them to the camera."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera import AprilGridBoard, Board, CameraModel, CharucoBoard, CheckerBoard, DotBoard
from tracker.geometry import Array, Camera, Pattern, Rigid, rotation_from_vector
from tracker.rehearsal.printed_plane import PrintedPlane
from tracker.rehearsal.settings import BoardKind

Image8 = npt.NDArray[np.uint8]

PER_MM = 8.0
RIM_MM = 12.0
PAPER, INK = 247, 22
DOT_RATIO, FIDUCIAL_RATIO = 0.25, 0.36  # radius by pitch
SHIFT_BITS = 6

HOLD_S, MOVE_S = 2.2, 0.7
BOARD_MARGIN_PX = 6.0
TREMOR_MM, TREMOR_HZ = 0.012, 9.0

# Large enough to fill a good part of the image at arm's length, each with a unique orientation.
BOARD_FROM_KIND: dict[BoardKind, Board] = {
    BoardKind.DOTS: DotBoard(columns=14, rows=10, pitch_mm=12.0, fiducials=(31, 38, 101, 108, 60)),
    BoardKind.CHECKERBOARD: CheckerBoard(columns=10, rows=7, square_mm=15.0),
    BoardKind.CHARUCO: CharucoBoard(
        columns=11, rows=8, square_mm=15.0, marker_mm=11.0, dictionary="DICT_5X5_100"
    ),
    # All edges lie on whole pixels of the face: OpenCV shifts others by up to 20 um, which biases p1.
    BoardKind.APRILGRID: AprilGridBoard(columns=7, rows=5, tag_mm=20.0, gap_mm=5.0),
}

# Position of the board's centre, in half image sizes from the image centre; distance, as a ratio of its
# minimum; tilt backwards, rotation (left edge away) and roll, in degrees.
PLACES = np.array(
    [
        [0.0, 0.0, 1.25, 0, 0, 0],
        [-0.9, -0.9, 1.0, 8, 12, 2],
        [0.9, -0.9, 1.0, 8, -12, -2],
        [0.9, 0.9, 1.0, -10, -10, 2],
        [-0.9, 0.9, 1.0, -10, 10, -2],
        [0.0, 0.1, 1.1, 30, 0, 6],
        [0.1, 0.0, 1.1, -30, 4, -8],
        [-0.1, 0.0, 1.15, 3, 32, 10],
        [0.1, -0.1, 1.15, -4, -32, -12],
        [0.0, -0.6, 1.0, 22, 0, 30],
        [0.0, 0.6, 1.0, -24, 0, -40],
        [-0.65, 0.0, 1.05, 0, 25, 15],
        [0.65, 0.0, 1.05, 0, -25, -15],
        [0.2, 0.2, 1.6, 18, -20, 80],
        [-0.3, -0.2, 1.5, -20, 20, -60],
        [0.0, 0.0, 1.0, 14, 14, 2],
    ]
)


@dataclass(frozen=True, slots=True, kw_only=True)
class PrintedBoard:
    """A calibration board on its paper.

    Attributes:
        board: the printed board.
        face: (h, w) grey, row 0 on top, `PER_MM` pixels to a millimetre.
        origin_px: position of the board's first point on the face, from its top left corner.
    """

    board: Board
    face: Image8
    origin_px: tuple[float, float]

    @property
    def plane(self) -> PrintedPlane:
        """Return the board as a drawable plane."""
        return PrintedPlane(self.face, per_mm=PER_MM, middle_px=self.origin_px)

    @property
    def corners_mm(self) -> Array:
        """Return the paper's corners (4, 3) in the board's frame (x right, y down)."""
        height, width = self.face.shape
        x, y = self.origin_px
        corners = np.array([[-x, -y], [width - x, -y], [width - x, height - y], [-x, height - y]]) / PER_MM
        return np.column_stack([corners, np.zeros(4)])


def printed(board: Board) -> PrintedBoard:
    """Return the printed board with a white rim."""
    points, reach = board.object_points_mm[:, :2], _reach_mm(board)
    low = points.min(axis=0) - reach - RIM_MM
    high = points.max(axis=0) + reach + RIM_MM
    width, height = (int(v) for v in np.ceil((high - low) * PER_MM))
    face = np.full((height, width), PAPER, dtype=np.uint8)
    origin = -low * PER_MM
    match board:
        case DotBoard():
            _print_dots(face, board, origin)
        case CheckerBoard():
            _print_squares(face, board, origin)
        case CharucoBoard():
            _print_charuco(face, board, origin)
        case AprilGridBoard():
            _print_april_grid(face, board, origin)
    return PrintedBoard(board=board, face=face, origin_px=(float(origin[0]), float(origin[1])))


def _reach_mm(board: Board) -> float:
    """Return how far the ink may reach beyond the outermost points."""
    match board:
        case DotBoard():
            return board.pitch_mm
        case CheckerBoard() | CharucoBoard():
            return board.square_mm
        case AprilGridBoard():
            return board.gap_mm


class BoardHand:
    """A hand that presents the board in a sequence of fixed poses; the poses follow from the seed.

    Args:
        printed_board: the board, whose paper remains inside the image.
        camera: the camera that sees the board.
        seed: varies the poses slightly.
    """

    def __init__(self, printed_board: PrintedBoard, camera: CameraModel, seed: int) -> None:
        self._board = printed_board
        self._camera = camera
        random = np.random.default_rng([seed, 0x424F4152])
        places = PLACES + random.normal(0.0, [0.03, 0.03, 0.03, 1.5, 1.5, 1.0], PLACES.shape)
        self._nearest_mm = self._distance_for_width(0.42)
        self._places = [self._moved_into_image(place) for place in places]
        self._tremor_rad = random.uniform(0.0, 2.0 * np.pi, 6)
        self.cycle_s = len(places) * (HOLD_S + MOVE_S)

    def camera_from_board_at(self, at_s: float) -> Rigid[Camera, Pattern]:
        """Return the board pose: origin at its first point, x right and y down on its face."""
        place, since_s = divmod(at_s % self.cycle_s, HOLD_S + MOVE_S)
        one, other = self._places[int(place)], self._places[(int(place) + 1) % len(self._places)]
        share = np.clip((since_s - HOLD_S) / MOVE_S, 0.0, 1.0)
        pose = self._pose(one + (other - one) * share * share * (3.0 - 2.0 * share))
        tremor = TREMOR_MM * np.sin(2.0 * np.pi * TREMOR_HZ * at_s + self._tremor_rad[:3])
        return Rigid(rotation=pose.rotation, translation_mm=pose.translation_mm + tremor)

    def _distance_for_width(self, share: float) -> float:
        """Return the distance at which the paper fills this share of the image width."""
        corners = self._board.corners_mm
        width_mm = float(corners[:, 0].max() - corners[:, 0].min())
        return float(self._camera.matrix[0, 0]) * width_mm / (share * self._camera.size_wh_px[0])

    def _pose(self, place: Array) -> Rigid[Camera, Pattern]:
        width, height = self._camera.size_wh_px
        px = np.array([width * (1.0 + place[0]), height * (1.0 + place[1])]) / 2.0
        ray = np.append(self._camera.normalised_from_px(px)[0], 1.0)
        lean, turn, roll = np.radians(place[3:])
        rotation = (
            rotation_from_vector(np.array([0.0, turn, 0.0]))
            @ rotation_from_vector(np.array([-lean, 0.0, 0.0]))
            @ rotation_from_vector(np.array([0.0, 0.0, roll]))
        )
        middle = self._board.corners_mm.mean(axis=0)
        return Rigid(rotation=rotation, translation_mm=ray * self._nearest_mm * place[2] - rotation @ middle)

    def _moved_into_image(self, place: Array) -> Array:
        """Return the pose, moved to the centre and away until the whole paper is in the image."""
        last = np.array(self._camera.size_wh_px) - 1.0 - BOARD_MARGIN_PX
        for _ in range(200):
            px = self._camera.px_from_camera(self._pose(place).move_points(self._board.corners_mm))
            out = (px < BOARD_MARGIN_PX).any(axis=0) | (px > last).any(axis=0)
            if not out.any():
                break
            nearer = np.where(out, 0.97, 1.0)
            place = place * np.array([*nearer, 1.004, 1.0, 1.0, 1.0])
        return place


def _fixed(values: Array | float) -> npt.NDArray[np.int32]:
    """Convert to fixed-point pixels; a face's top-left corner lies half a pixel before its first centre."""
    return np.asarray(np.rint((np.asarray(values) - 0.5) * 2**SHIFT_BITS), dtype=np.int32)


def _print_dots(face: Image8, board: DotBoard, origin: Array) -> None:
    for index, point in enumerate(board.object_points_mm[:, :2]):
        ratio = FIDUCIAL_RATIO if index in board.fiducials else DOT_RATIO
        x, y = _fixed(point * PER_MM + origin)
        radius = round(ratio * board.pitch_mm * PER_MM * 2**SHIFT_BITS)
        cv2.circle(face, (int(x), int(y)), radius, INK, -1, cv2.LINE_AA, SHIFT_BITS)


def _print_squares(face: Image8, board: CheckerBoard, origin: Array) -> None:
    for row in range(-1, board.rows):
        for column in range(-1, board.columns):
            if (row + column) % 2 == 0:
                corner = np.array([column, row]) * board.square_mm * PER_MM + origin
                _print_box(face, corner, board.square_mm * PER_MM)


def _print_box(face: Image8, corner: Array, side: float) -> None:
    x, y = corner
    box = np.array([[x, y], [x + side, y], [x + side, y + side], [x, y + side]])
    cv2.fillConvexPoly(face, _fixed(box), INK, cv2.LINE_AA, SHIFT_BITS)


def _print_charuco(face: Image8, board: CharucoBoard, origin: Array) -> None:
    size = (round(board.columns * board.square_mm * PER_MM), round(board.rows * board.square_mm * PER_MM))
    picture = board.opencv_board().generateImage(size, marginSize=0)
    inked = (INK + (PAPER - INK) * (picture.astype(np.float32) / 255.0)).astype(np.uint8)
    # The origin of OpenCV's board and points is the corner of its first square.
    x, y = (round(float(v)) for v in origin)
    face[y : y + size[1], x : x + size[0]] = inked


def _print_april_grid(face: Image8, board: AprilGridBoard, origin: Array) -> None:
    pitch, gap = (board.tag_mm + board.gap_mm) * PER_MM, board.gap_mm * PER_MM
    for row in range(board.rows + 1):
        for column in range(board.columns + 1):
            _print_box(face, origin + pitch * np.array([column, row]) - gap, gap)
    for row in range(board.rows):
        for column in range(board.columns):
            corner = origin + pitch * np.array([column, row])
            _print_box(face, corner, board.tag_mm * PER_MM)
            white = board.white_modules(board.tag_at(column, row))
            # In whole pixels, because anti-aliasing would leave seams between modules.
            steps = board.tag_mm * PER_MM / len(white) * np.arange(len(white) + 1)
            x, y = (np.rint(start + steps).astype(int) for start in corner)
            for down, right in np.argwhere(white):
                face[y[down] : y[down + 1], x[right] : x[right + 1]] = PAPER

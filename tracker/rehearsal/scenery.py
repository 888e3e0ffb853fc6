"""Static scenery, rendered once: operating field, bone, needles and clutter."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.geometry import Camera, Rigid, Vertebra
from tracker.rehearsal.anatomy import Needle, bone_field, bone_normals
from tracker.rehearsal.clutter import PLACES, Sheet, instruments, sheets
from tracker.rehearsal.field import OperatingField
from tracker.rehearsal.grain import Coordinates, Grain
from tracker.rehearsal.lamp import TO_LAMP, lit, shine
from tracker.rehearsal.lens import NODE_PX, RayGrid, resized, spread
from tracker.rehearsal.placement import Placement, Room
from tracker.rehearsal.raster import RasterSamples, rasterise
from tracker.rehearsal.reference_renderer import lay_reference, post, reference_rods
from tracker.rehearsal.rods import Rod, rod_of_bar, rod_of_needle
from tracker.rehearsal.soft_tissue import soft_colours
from tracker.rehearsal.solids import Solid, ball, joined, moved, tube
from tracker.rehearsal.theatre import Theatre

Image32 = npt.NDArray[np.float32]
SUPERSAMPLING = 2
LAMP_STEPS_MM = (2.5, 5.0, 9.0, 15.0, 24.0, 36.0)
# Absorption of bone's blue, green and red by traces of muscle.
TRACES = np.array([0.62, 0.58, 0.22], dtype=np.float32)
NEEDLE_COLOUR, NEEDLE_HEADS = (0.74, 0.73, 0.72), ((0.25, 0.75, 0.95), (0.85, 0.60, 0.20), (0.45, 0.75, 0.35))


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenery:
    """Render of the static objects.

    Attributes:
        picture: (h, w, 3) float32, BGR 0..1, sharp, evenly lit by the camera's gain.
        depth_mm: (h, w) float32 along the optical axis, of the nearest static object.
        points_mm: (h/4, w/4, 3) float32, centre of each 4x4 block in the room's frame.
    """

    picture: Image32
    depth_mm: Image32
    points_mm: Image32


def still_scenery(theatre: Theatre, rays: RayGrid, placement: Placement) -> Scenery:
    """Render the theatre without its drill, for one placement of camera and patient."""
    random = np.random.default_rng([theatre.settings.seed, 0x53434E45])
    field, grain = OperatingField(random), Grain(random)
    width, height = theatre.camera.size_wh_px
    pose, patient = placement.camera_from_room, placement.room_from_vertebra
    full = spread(rays.block(0, 0, rays.columns * NODE_PX, rays.rows * NODE_PX), 1)[:height, :width]
    soft_depth, points = _soft_points(field, pose, full)
    clutter = theatre.settings.clutter
    # Clutter positions are independent of later camera motion.
    first = theatre.placement_at_rest
    laid = points if placement.key == first.key else _soft_points(field, first.camera_from_room, full)[1]
    steel = instruments(clutter, field, _spots(laid), random)
    rods = [rod_of_needle(needle, patient) for needle in theatre.needles] + [rod_of_bar(bar) for bar in steel]
    bones = [_bone_solid(theatre), *_needle_solids(theatre.needles)]
    if theatre.reference is not None:
        bones.append(post(theatre.reference_from_vertebra))
        rods += reference_rods(theatre.reference_from_vertebra, patient)
    shade = _soft_shade(points, rods, patient)
    picture, light = soft_colours(field, grain, points, shade, pose.inverse.translation_mm)
    for sheet in sheets(clutter, random):
        _lay(picture, light, sheet, field, laid, theatre.camera, pose)
    solid = joined([*(moved(one, patient) for one in bones), *steel])
    depth = _draw_solids(picture, soft_depth, solid, theatre.camera, pose, grain, rods)
    if theatre.reference is not None:
        lay_reference(
            picture,
            depth,
            marker_image=theatre.reference.image,
            camera=theatre.camera,
            rays=rays,
            placement=placement,
            reference_from_vertebra=theatre.reference_from_vertebra,
        )
    quarter = resized(points, rays.columns, rays.rows)
    return Scenery(picture=picture, depth_mm=depth, points_mm=quarter)


def _soft_points(field: OperatingField, pose: Rigid[Camera, Room], rays: Image32) -> tuple[Image32, Image32]:
    """Return depth (h, w) and position in the vertebra's frame (h, w, 3) of the field at each pixel."""
    height, width = rays.shape[:2]
    turn = pose.rotation.astype(np.float32)
    origin = pose.inverse.translation_mm
    directions = rays @ turn
    # Cloth and muscle are smooth enough for half resolution.
    half = resized(directions, width // 2, height // 2)
    depth = resized(field.meet(origin, half), width, height)
    points = origin.astype(np.float32) + depth[..., None] * directions
    return depth, np.asarray(points, dtype=np.float32)


def _spots(points: Image32) -> list[tuple[float, float]]:
    """Return the positions of clutter on the patient."""
    height, width = points.shape[:2]
    found = [points[min(int(v * height), height - 1), min(int(u * width), width - 1)] for u, v in PLACES]
    return [(float(p[0]), float(p[2])) for p in found]


def _soft_shade(points: Image32, rods: list[Rod], patient: Rigid[Room, Vertebra]) -> Image32:
    """Return the fraction (h, w) of the lamp's light on the soft field, with the shadows of other objects."""
    height, width = points.shape[:2]
    half = resized(points, width // 2, height // 2).reshape(-1, 3)
    left = np.ones(len(half), dtype=np.float32)
    near = np.flatnonzero((np.abs(half[:, 0]) < 75) & (np.abs(half[:, 2]) < 80))
    beside_bone = (half[near] - patient.translation_mm.astype(np.float32)) @ patient.rotation.astype(
        np.float32
    )
    left[near] -= 0.62 * _bone_shadow(beside_bone, 0.4)
    # Ambient occlusion where soft tissue meets bone.
    left[near] *= 0.55 + 0.45 * np.clip(bone_field(beside_bone) / 5.0, 0.0, 1.0)
    for rod in rods:
        left *= 1.0 - rod.shadow(half)
    return resized(left.reshape(height // 2, width // 2), width, height)


def _bone_shadow(points: Coordinates, lift_mm: float) -> Image32:
    """Return the shadow of the bone, 0..1, at points (n, 3)."""
    openness = np.full(len(points), np.float32(1.0))
    for step_mm in LAMP_STEPS_MM:
        ahead = bone_field(points + (step_mm * TO_LAMP).astype(np.float32))
        openness = np.minimum(openness, (ahead + lift_mm) / (0.16 * step_mm + 0.5))
    return np.asarray(np.clip(0.5 - 0.5 * openness, 0.0, 1.0), dtype=np.float32)


def _bone_solid(theatre: Theatre) -> Solid:
    vertices = theatre.surface.vertices_mm
    normals = bone_normals(vertices)
    near = np.clip(bone_field(vertices + 2.5 * normals) / 2.5, 0.0, 1.0)
    far = np.clip(bone_field(vertices + 8.0 * normals) / 8.0, 0.0, 1.0)
    open_ratio = 0.30 + 0.35 * near + 0.35 * far
    shadow = _bone_shadow((vertices + 1.2 * normals).astype(np.float32), 0.3)
    light = open_ratio * (1.0 - 0.55 * shadow)
    # Clean bone on top; blood and muscle cling to what lies deep and in the creases.
    stain = np.clip((17.0 - vertices[:, 1]) / 14.0, 0.0, 1.0) * 0.55 + 0.5 * (1.0 - near)
    stain = np.clip(stain, 0.0, 0.85)[:, None]
    ivory, wet = np.array([0.64, 0.79, 0.90]), np.array([0.24, 0.28, 0.62])
    return Solid(
        vertices_mm=vertices,
        normals=normals,
        faces=theatre.surface.faces,
        colours=(ivory * (1.0 - stain) + wet * stain) * light[:, None],
        gloss=0.42 * light,
    )


def _needle_solids(needles: tuple[Needle, ...]) -> list[Solid]:
    out = []
    for needle, colour in zip(needles, NEEDLE_HEADS, strict=False):
        line = np.linspace(needle.tip_in_vertebra_mm, needle.head_in_vertebra_mm, 40)
        out.append(tube(line, np.full(40, needle.radius_mm), colour=NEEDLE_COLOUR, gloss=0.9))
        out.append(ball(needle.head_in_vertebra_mm, 2.6, colour=colour, gloss=0.6))
    return out


def _lay(
    picture: Image32,
    light: Image32,
    sheet: Sheet,
    field: OperatingField,
    points: Image32,
    camera: CameraModel,
    pose: Rigid[Camera, Room],
) -> None:
    """Draw a flat object into the picture with the local light."""
    height, width = picture.shape[:2]
    middle = points[int(sheet.place[1] * (height - 1)), int(sheet.place[0] * (width - 1))]
    half = np.array(sheet.size_mm) / 2.0
    # Seen from above the patient's back, x runs to the left and z up: top-left is where both are great.
    corners = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * half
    cosine, sine = np.cos(sheet.turn_rad), np.sin(sheet.turn_rad)
    xz = corners @ np.array([[cosine, sine], [-sine, cosine]]) + middle[[0, 2]]
    ground = field.height_at(xz[None, :, 0].astype(np.float32), xz[None, :, 1].astype(np.float32))[0]
    px = camera.px_from_camera(pose.move_points(np.stack([xz[:, 0], ground + 0.5, xz[:, 1]], axis=1)))
    rows, columns = sheet.picture.shape[:2]
    source = np.array([[0, 0], [columns, 0], [columns, rows], [0, rows]], dtype=np.float32) - 0.5
    matrix = cv2.getPerspectiveTransform(source, px.astype(np.float32))
    low = np.clip(np.floor(px.min(axis=0)).astype(int) - 3, 0, [width, height])
    high = np.clip(np.ceil(px.max(axis=0)).astype(int) + 4, 0, [width, height])
    if (high <= low).any():
        return
    shift = np.array([[1, 0, -low[0]], [0, 1, -low[1]], [0, 0, 1]], dtype=np.float64)
    size = (int(high[0] - low[0]), int(high[1] - low[1]))
    flat = sheet.picture.copy()
    flat[..., :3] *= flat[..., 3:]
    soft = cv2.GaussianBlur(flat, (0, 0), max(0.3, 0.25 * columns / sheet.size_mm[0]))
    warped = cv2.warpPerspective(soft, shift @ matrix, size, flags=cv2.INTER_LINEAR)
    part = picture[low[1] : high[1], low[0] : high[0]]
    part *= 1.0 - warped[..., 3:]
    part += warped[..., :3] * light[low[1] : high[1], low[0] : high[0], None]


def _draw_solids(
    picture: Image32,
    soft_depth: Image32,
    solid: Solid,
    camera: CameraModel,
    pose: Rigid[Camera, Room],
    grain: Grain,
    rods: list[Rod],
) -> Image32:
    """Draw solids into the picture with 2x supersampling; return the depth (h, w) of all static objects."""
    height, width = picture.shape[:2]
    in_camera = pose.move_points(solid.vertices_mm)
    px = camera.px_from_camera(in_camera)
    covered = rasterise(
        px * SUPERSAMPLING + (SUPERSAMPLING - 1) / 2.0,
        in_camera[:, 2],
        solid.faces,
        width=width * SUPERSAMPLING,
        height=height * SUPERSAMPLING,
    )
    row, column = np.divmod(covered.pixel, width * SUPERSAMPLING)
    in_front = covered.depth_mm < soft_depth[row // SUPERSAMPLING, column // SUPERSAMPLING] + 0.2
    covered = RasterSamples(
        pixel=covered.pixel[in_front],
        face=covered.face[in_front],
        weights=covered.weights[in_front],
        depth_mm=covered.depth_mm[in_front],
    )
    colour = _solid_colours(covered, solid, pose, grain, rods)
    fine = np.zeros((height * SUPERSAMPLING * width * SUPERSAMPLING, 4), dtype=np.float32)
    fine[covered.pixel, :3] = colour
    fine[covered.pixel, 3] = 1.0
    layer = resized(fine.reshape(height * SUPERSAMPLING, width * SUPERSAMPLING, 4), width, height)
    picture *= 1.0 - layer[..., 3:]
    picture += layer[..., :3]
    depth = soft_depth.copy()
    row, column = np.divmod(covered.pixel, width * SUPERSAMPLING)
    np.minimum.at(depth, (row // SUPERSAMPLING, column // SUPERSAMPLING), covered.depth_mm)
    return depth


def _solid_colours(
    covered: RasterSamples, solid: Solid, pose: Rigid[Camera, Room], grain: Grain, rods: list[Rod]
) -> Image32:
    values = np.hstack([solid.vertices_mm, solid.normals, solid.colours, solid.gloss[:, None]])
    at = covered.of_corners(values.astype(np.float32), solid.faces)
    points, normals, colours, gloss = at[:, :3], at[:, 3:6].copy(), at[:, 6:9], at[:, 9]
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-6)
    to_camera = pose.inverse.translation_mm.astype(np.float32) - points
    to_camera /= np.linalg.norm(to_camera, axis=1, keepdims=True)
    bony = (gloss < 0.5).astype(np.float32)
    normals += bony[:, None] * _roughness(points, grain)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-6)
    light = lit(normals)
    for rod in rods:
        # A rod's surface is at its radius, so it casts no shadow on itself.
        light *= 1.0 - rod.shadow(points) * bony
    side = points[:, 0] + 0.6 * points[:, 1]
    mottle = grain.clouds(side, points[:, 2] + 0.5 * points[:, 1], 60.0)
    pores = grain.specks(side, points[:, 2] - 0.4 * points[:, 1], 0.8)
    texture = 1.0 + bony * (0.055 * mottle + 0.035 * pores)
    wet = np.clip(0.6 + 0.35 * mottle, 0.0, 1.4) * bony + (1.0 - bony)
    # Where the muscle was scraped off in a hurry some of it is left.
    rest = np.clip(0.45 * mottle + (20.0 - points[:, 1]) / 14.0 - 0.35, 0.0, 0.6) * bony
    traces = 1.0 - rest[:, None] * TRACES
    out = colours * traces * (light * texture)[:, None]
    out += (gloss * wet * (0.75 * shine(normals, to_camera, 42.0) + 0.12 * shine(normals, to_camera, 6.0)))[
        :, None
    ]
    return np.asarray(np.clip(out, 0.0, 1.0), dtype=np.float32)


def _roughness(points: Image32, grain: Grain) -> Image32:
    """Return perturbations of bone normals (n, 3): lumps and scrape marks."""
    x, y, z = (np.ascontiguousarray(points[:, i]) for i in range(3))
    return np.stack(
        [
            0.13 * grain.clouds(y + 0.4 * x, z, 90.0),
            0.13 * grain.clouds(x + 37.0, z + 0.5 * y, 90.0),
            0.13 * grain.clouds(x, y + 0.3 * z, 90.0),
        ],
        axis=1,
    )

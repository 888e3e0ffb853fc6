"""Drawing of one instant into the scene, atomically."""

from collections.abc import Sequence

import viser

from server.live import Instant
from server.scene.door import Door
from server.scene.drills import DrillNodes, DrillNow
from server.scene.marks import Mark, MarkNodes
from server.scene.nodes import (
    VIEW_ANGLE_RAD,
    Vector,
    World,
    add_bone,
    add_camera,
    add_channel,
    add_placed_screw,
    add_reference,
    add_screw,
    quaternion,
    vector,
)
from server.scene.views import ViewName, ViewNodes, camera_view, channel_view, first_view
from tracker.geometry import Camera, Rigid, Vertebra
from tracker.navigation import Absent, NavigationSnapshot, Setup
from tracker.plan import Channel, Surface
from tracker.pose import Seen

NUMBER_NODE = "/image_number"
# viser drops relative changes of a position below 1e-5, so that the image number is sent in two parts:
# thousands and the rest.
NUMBER_BASE = 1000


def number_position(image_number: int | None, *, beats: int) -> Vector:
    """Encode the image number as the position of a hidden node: x = 1 + thousands, y = the rest.

    x is 0 if no image is shown, as before a new node has its first position. z changes with each batch, so
    that a page can distinguish an unchanged scene from a lost connection.
    """
    if image_number is None:
        return 0.0, 0.0, float(beats % NUMBER_BASE)
    thousands, rest = divmod(image_number, NUMBER_BASE)
    return 1.0 + thousands, float(rest), float(beats % NUMBER_BASE)


class Stage:
    """The drawn scene. Call it from the event loop only."""

    def __init__(self, door: Door, *, setup: Setup | None, surface: Surface | None) -> None:
        self._door = door
        self._surface = surface
        self._drawn_key: tuple[object, ...] | None = None
        self._drawn_setup: Setup | None = None
        self._camera: viser.CameraFrustumHandle | None = None
        self._beats = 0
        self._generation = 0
        self._root: viser.FrameHandle | None = None
        self._reference: viser.FrameHandle | None = None
        self._tools: dict[str, DrillNodes] = {}
        self._marks: MarkNodes | None = None
        scene = door.scene
        self._views = ViewNodes(scene)
        scene.configure_environment_map(hdri=None)
        scene.configure_default_lights(enabled=True, cast_shadow=False)
        # The environment map is off, so that the shaded sides need a separate light.
        scene.add_light_ambient("/light", intensity=1.4)
        door.initial_camera.fov = VIEW_ANGLE_RAD
        door.initial_camera.near = 1.0
        door.initial_camera.far = 5000.0
        self._build(setup)
        self._number = scene.add_frame(NUMBER_NODE, show_axes=False, visible=False)
        self._count(None)

    def show(self, instant: Instant, marks: Sequence[Mark] = ()) -> None:
        """Draw this instant: each visible drill in its pose, other drills hidden, and the image number.

        Args:
            instant: the instant.
            marks: marks on cuts; those of another CT are left out.
        """
        snapshot = instant.snapshot
        if snapshot is None:
            self.show_nothing()
            return
        rebuilt = snapshot.setup is not self._drawn_setup and _key(snapshot.setup) != self._drawn_key
        with self._door.atomic():
            if rebuilt:
                self._build(snapshot.setup)
            self._drawn_setup = snapshot.setup
            world_from_camera = _world_from_camera(snapshot)
            self._place_camera(world_from_camera)
            self._place_reference(snapshot, world_from_camera)
            for name, nodes in self._tools.items():
                nodes.show(_drill_now(snapshot, name, world_from_camera))
            if self._marks is not None:
                ct_id = snapshot.setup.ct_id
                self._marks.show([one for one in marks if one.plane is not None and one.plane.ct_id == ct_id])
            self._count(snapshot.image_number)
        self._door.flush()

    def show_nothing(self) -> None:
        """Hide every drill and mark, because there is no image."""
        with self._door.atomic():
            if self._reference is not None:
                self._reference.visible = False
            for nodes in self._tools.values():
                nodes.show(None)
            if self._marks is not None:
                self._marks.show(())
            self._count(None)
        self._door.flush()

    def show_surface(self, surface: Surface | None) -> None:
        """Replace the bone; moving nodes follow with the next image."""
        if surface is self._surface:
            return
        self._surface = surface
        with self._door.atomic():
            self._build(self._drawn_setup)
            self._count(None)
        self._door.flush()

    def _count(self, image_number: int | None) -> None:
        self._beats += 1
        self._number.position = number_position(image_number, beats=self._beats)

    def _place_camera(self, world_from_camera: Rigid[World, Camera] | None) -> None:
        if self._camera is None:
            return
        if world_from_camera is not None:
            self._camera.position = vector(world_from_camera.translation_mm)
            self._camera.wxyz = quaternion(world_from_camera.rotation)
            self._views.put(ViewName.CAMERA, camera_view(world_from_camera))
        self._camera.visible = world_from_camera is not None

    def _place_reference(
        self, snapshot: NavigationSnapshot, world_from_camera: Rigid[World, Camera] | None
    ) -> None:
        seen = snapshot.sightings.get(snapshot.setup.reference)
        if self._reference is None:
            return
        if isinstance(seen, Seen) and world_from_camera is not None:
            pose = world_from_camera @ seen.camera_from_marker
            self._reference.position = vector(pose.translation_mm)
            self._reference.wxyz = quaternion(pose.rotation)
        self._reference.visible = isinstance(seen, Seen) and world_from_camera is not None

    def _build(self, setup: Setup | None) -> None:
        """Rebuild all static nodes, and the drills as hidden nodes."""
        scene = self._door.scene
        # Under a new name each time, because a viewer keeps pose and visibility of a node that is removed and
        # added again under the same name.
        if self._root is not None:
            self._root.remove()
        self._generation += 1
        root = f"/setup_{self._generation}"
        self._root = scene.add_frame(root, show_axes=False)
        self._tools, self._camera, self._reference, self._marks = {}, None, None, None
        self._drawn_setup, self._drawn_key = setup, None if setup is None else _key(setup)
        self._look(setup)
        if setup is None:
            return
        if not isinstance(setup.registration, Absent):
            self._marks = MarkNodes(scene, root)
            if self._surface is not None:
                add_bone(scene, root, self._surface)
            if isinstance(setup.channel, Channel):
                add_channel(scene, root, setup.channel)
                if setup.screw is not None:
                    add_screw(scene, root, setup.channel, setup.screw)
                for index, screw in enumerate(setup.placed_screws):
                    add_placed_screw(scene, f"{root}/placed_{index}", screw)
        if setup.camera_calibrated:
            if setup.has_images:
                self._camera = add_camera(scene, root, setup.camera)
            if setup.reference:
                self._reference = add_reference(scene, root)
        # Numbered, because a name may contain a slash, which separates child nodes in viser.
        for index, (name, tool) in enumerate(setup.tools.items()):
            self._tools[name] = DrillNodes(scene, f"{root}/tool_{index}", tool)

    def _look(self, setup: Setup | None) -> None:
        view, along = first_view(setup, self._surface), channel_view(setup)
        self._views.put(ViewName.BEHIND, view)
        # Without a channel, the view along it is the view from behind.
        self._views.put(ViewName.CHANNEL, along or view)
        self._door.scene.set_up_direction(view.up)
        camera = self._door.initial_camera
        camera.position, camera.look_at, camera.up = (
            vector(view.position_mm),
            vector(view.look_at_mm),
            view.up,
        )


def _world_from_camera(snapshot: NavigationSnapshot) -> Rigid[World, Camera] | None:
    """Return the pose of the camera in the scene; None while the patient's reference is not seen."""
    if isinstance(snapshot.setup.registration, Absent):
        return Rigid.identity()
    if isinstance(snapshot.vertebra, Absent):
        return None
    world_from_vertebra: Rigid[World, Vertebra] = Rigid.identity()
    return world_from_vertebra @ snapshot.vertebra.camera_from_vertebra.inverse


def _drill_now(
    snapshot: NavigationSnapshot, name: str, world_from_camera: Rigid[World, Camera] | None
) -> DrillNow | None:
    """Return the state of a drill; None if its pose in the scene is unknown."""
    tool, judged = snapshot.tools[name], snapshot.analyses[name]
    if world_from_camera is None or isinstance(tool, Absent):
        return None
    return DrillNow(
        world_from_tool=world_from_camera @ tool.camera_from_tool,
        spread=None if isinstance(judged, Absent) else judged.spread,
        leaves_trace=not isinstance(snapshot.setup.registration, Absent),
        at_s=snapshot.captured_at_s,
    )


def _key(setup: Setup) -> tuple[object, ...]:
    """Return a key that is equal for setups of equal appearance; each image has its own copy of the setup."""
    channel, registration = setup.channel, setup.registration
    return (
        setup.camera_calibrated,
        setup.has_images,
        setup.reference,
        setup.screw,
        tuple(
            (one.head_in_vertebra_mm.tobytes(), one.tip_in_vertebra_mm.tobytes(), one.radius_mm)
            for one in setup.placed_screws
        ),
        setup.camera.size_wh_px,
        setup.camera.matrix.tobytes(),
        tuple((name, tool.radius_mm, tool.length_mm) for name, tool in setup.tools.items()),
        None
        if isinstance(channel, Absent)
        else (
            channel.entry_in_vertebra_mm.tobytes(),
            channel.target_in_vertebra_mm.tobytes(),
            channel.radius_mm,
        ),
        None
        if isinstance(registration, Absent)
        else (registration.anchored_to, registration.anchor_from_vertebra.matrix.tobytes()),
    )

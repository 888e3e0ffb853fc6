"""A patient for tests of registration: ground truth, a case with camera, tool and plan, the tip on bone."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from server.store import DocumentKind
from tests.procedure.conftest import Server
from tests.procedure.test_tool_step import calibrated
from tracker.geometry import Array, Camera, Marker, Rigid, Vertebra, rotation_from_vector
from tracker.navigation import AbsentReason
from tracker.plan import Channel, Landmark, PlanDocument, ReferenceSlice, plan_to_mapping
from tracker.plan.document import PlannedChannel, VertebraPlan
from tracker.plan.pedicle import Side
from tracker.pose import Seen
from tracker.registration import Registration

BY = {"made_by": "ito"}
DRILL = {"tool": "drill"}
TIP_IN_MARKER = np.array([0.0, -120.0, -10.0])
LANDMARKS = {
    "spinous process": (0.0, 42.0, -4.0),
    "left lamina": (12.0, 22.0, 5.0),
    "right lamina": (-12.5, 21.0, 4.0),
    "left transverse process": (36.0, 11.0, -3.0),
    "right transverse process": (-35.0, 12.0, -1.0),
}
USED = list(LANDMARKS)[:4]
SPARE = list(LANDMARKS)[4]
CAMERA_FROM_VERTEBRA: Rigid[Camera, Vertebra] = Rigid.from_vector([1.3, 0.2, -0.1], [12.0, -20.0, 460.0])
SIDES: tuple[tuple[Side, float], ...] = (("left", 1.0), ("right", -1.0))
# Facing the camera, with its tool below it.
FACING = rotation_from_vector([np.pi, 0.0, 0.0])


def marker_seen(pose: Rigid[Camera, Marker]) -> Seen:
    """A marker as a good tracker sees it."""
    sd = np.array([0.02, 0.02, 0.1, 0.001, 0.001, 0.0004])
    return Seen(
        camera_from_marker=pose,
        pose_covariance=np.diag(sd**2),
        corners_px=np.array([[600.0, 300.0], [640.0, 300.0], [640.0, 340.0], [600.0, 340.0]]),
        score_ratio=0.95,
        target_score_ratio=0.9,
        model_coverage_ratio=0.95,
        target_coverage_ratio=0.9,
        fit_error_px2=0.1,
        found_by="track",
    )


def drill_at(tip_in_camera_mm: Array) -> Seen:
    """Pose of the drill's marker with its tip at this point."""
    return marker_seen(Rigid(rotation=FACING, translation_mm=tip_in_camera_mm - FACING @ TIP_IN_MARKER))


def tool_content(tip_in_marker_mm: Array = TIP_IN_MARKER) -> dict[str, Any]:
    return {
        "marker": "drill",
        "side_mm": 25.0,
        "pivot": {
            "tip_in_marker_mm": tip_in_marker_mm.tolist(),
            "covariance_mm2": (0.1**2 * np.eye(3)).tolist(),
            "rms_3d_mm": 0.3,
            "used": 40,
            "rejected": 0,
            "tilt_range_deg": 40.0,
            "made_at": "2026-11-21T10:00:00Z",
        },
        "axis_in_marker": [0.0, -1.0, 0.0],
        "radius_mm": 2.0,
        "length_mm": 118.0,
    }


def plan_content(
    *vertebrae: str, shift_mm: float = 0.0, references: tuple[ReferenceSlice, ...] = ()
) -> dict[str, Any]:
    """A plan of these vertebrae, each with both channels and all landmarks."""
    return plan_to_mapping(
        PlanDocument(
            vertebrae=tuple(
                VertebraPlan(
                    name=name,
                    references=references,
                    channels=tuple(
                        PlannedChannel(
                            side=side,
                            channel=Channel(
                                name=f"{name} {side}",
                                entry_in_vertebra_mm=np.array([way * 15.0 + shift_mm, 14.0, 2.0]),
                                target_in_vertebra_mm=np.array([way * 8.0, -30.0, 3.0]),
                                radius_mm=3.0,
                            ),
                        )
                        for side, way in SIDES
                    ),
                    landmarks=tuple(
                        Landmark(name=one, point_lps_mm=np.array(point)) for one, point in LANDMARKS.items()
                    ),
                )
                for name in vertebrae
            )
        )
    )


@dataclass(slots=True, kw_only=True)
class Patient:
    """The patient in front of the camera, and the hand that holds the tip on the bone."""

    server: Server
    camera_from_vertebra: Rigid[Camera, Vertebra] = CAMERA_FROM_VERTEBRA
    camera_from_reference: Rigid[Camera, Marker] | None = None
    at_s: float = 0.0
    rate_hz: float = 30.0
    random: np.random.Generator = field(default_factory=lambda: np.random.default_rng(4))

    def show(self, seen: Seen | None, **said: Any) -> Any:  # noqa: ANN401  as Server.show
        self.at_s += 1.0 / self.rate_hz
        reference = self.camera_from_reference
        beside = {} if reference is None else {"reference": marker_seen(reference)}
        return self.server.show(at_s=self.at_s, seen=seen, beside=said.pop("beside", beside), **said)

    def tip_on(self, landmark: str, *, off_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Seen:
        point = np.array(LANDMARKS[landmark]) + off_mm
        in_camera = self.camera_from_vertebra.move_points(point)
        return drill_at(in_camera + self.random.normal(0.0, 0.05, 3))

    def hold(self, path: str, landmark: str, *, off_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Any:  # noqa: ANN401  JSON
        """Hold the tip on a landmark until the running capture ends; return the session's state."""
        reported: Any = self.server.ask("GET", path, 200)
        for _ in range(100):
            if reported["capture"]["state"] != "looking":
                break
            self.show(self.tip_on(landmark, off_mm=off_mm))

            def looked_at(images: int = reported["capture"]["images"]) -> bool:
                nonlocal reported
                reported = self.server.ask("GET", path, 200)
                return bool(
                    reported["capture"]["state"] != "looking" or reported["capture"]["images"] > images
                )

            self.server.until(looked_at)
        return reported

    def touch(self, landmark: str, *, off_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Any:  # noqa: ANN401  JSON
        """Capture a landmark in the running session."""
        self.server.ask("POST", "/api/registration/points/captures", 202, json={"landmark": landmark})
        return self.hold("/api/registration/points", landmark, off_mm=off_mm)

    def register(self, landmarks: list[str] = USED) -> Any:  # noqa: ANN401  JSON
        """Register with landmarks."""
        self.show(None)
        self.server.ask("POST", "/api/registration/points", 201, json=DRILL)
        for one in landmarks:
            self.touch(one)
        return self.server.ask("POST", "/api/registration/points/conclusion", 201, json=BY)

    def check(self, *, off_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Any:  # noqa: ANN401  JSON
        """Check on the spare landmark."""
        self.server.ask("POST", "/api/registration/check", 201, json={**DRILL, "landmark": SPARE})
        self.hold("/api/registration/check", SPARE, off_mm=off_mm)
        return self.server.ask("POST", "/api/registration/check/conclusion", 201, json=BY)


def with_tool(server: Server, case_id: str) -> None:
    camera = server.store.current(case_id, DocumentKind.CAMERA, "main")
    server.store.put(
        case_id, DocumentKind.TOOL, "drill", tool_content(), made_by="test", depends_on=[camera.id]
    )


def with_plan(server: Server, case_id: str, *vertebrae: str) -> None:
    ct = server.store.put(case_id, DocumentKind.CT, "main", {}, made_by="test")
    content = plan_content(*(vertebrae or ("L3",)))
    server.store.put(case_id, DocumentKind.PLAN, "main", content, made_by="test", depends_on=[ct.id])


def activate(server: Server, vertebra: str = "L3", side: str = "left") -> None:
    server.ask("POST", "/api/plan/active-channel", 200, json={**BY, "vertebra": vertebra, "side": side})


def ready(server: Server, *vertebrae: str) -> str:
    """An open case with camera, tool, plan and an active channel."""
    case_id = calibrated(server)
    with_tool(server, case_id)
    with_plan(server, case_id, *vertebrae)
    activate(server)
    return case_id


def withheld(server: Server) -> AbsentReason | None:
    """The tracking process' reason for withheld numbers."""
    return server.adopted[-1].withheld


def registered(server: Server) -> Registration | None:
    """The tracking process' set-up for navigation."""
    return server.adopted[-1].registration


def states(server: Server) -> dict[str, str]:
    """State of each step, from the API."""
    reported = server.ask("GET", "/api/procedure", 200)
    return {one["step"]: one["state"] for one in reported["steps"]}

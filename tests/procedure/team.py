"""The operating team, working through the API only, and what its camera sees."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import cv2
import numpy as np

from server.config import Config, RehearsalConfig, RehearsalEventConfig
from server.theatre import theatre_from_config
from tests.procedure.real_server import RealServer
from tracker.geometry import Rigid, Tool, Vertebra
from tracker.navigation import Deviation
from tracker.navigation.deviation import deviation_from_channel
from tracker.plan import Channel
from tracker.rehearsal import Theatre, Truth
from tracker.rehearsal.boards import HOLD_S, MOVE_S, PLACES

BY = {"made_by": "M. Ito"}
DRILL = {"tool": "drill"}
BOARD = {
    "pattern": "dots",
    "columns": 14,
    "rows": 10,
    "pitch_mm": 12.0,
    "fiducials": [31, 38, 60, 101, 108],
}
POINTS, CHECK = "/api/registration/points", "/api/registration/check"


def board_images(rehearsal: RehearsalConfig) -> list[bytes]:
    """JPEG files of the board at each of its positions before the camera of this rehearsal."""
    renderer = theatre_from_config(rehearsal.model_copy(update={"scene": "board"})).renderer()
    times_s = [place * (HOLD_S + MOVE_S) + HOLD_S / 2.0 for place in range(len(PLACES))]
    return [cv2.imencode(".jpg", renderer.image_at(at_s))[1].tobytes() for at_s in times_s]


@dataclass(frozen=True, slots=True, kw_only=True)
class Heard:
    """A live message with the ground truth of its image."""

    message: dict[str, Any]
    truth: Truth

    @property
    def drill(self) -> dict[str, Any]:
        """The drill's values in this message."""
        (tool,) = self.message["snapshot"]["tools"]
        return dict(tool)

    @property
    def alarms(self) -> dict[str, dict[str, Any]]:
        """Visible landmarks, by condition."""
        return {one["condition"]: one for one in self.message["alarms"]["alarms"]}

    def deviation_from(self, channel: Channel) -> Deviation:
        """True distance of the drill from the planned channel."""
        vertebra_from_tool: Rigid[Vertebra, Tool] = (
            self.truth.camera_from_vertebra.inverse @ self.truth.camera_from_tool
        )
        return deviation_from_channel(vertebra_from_tool, channel)


@dataclass(slots=True, kw_only=True)
class Team:
    """Does the steps of the procedure as users do, waiting only for the server's answers."""

    server: RealServer
    config: Config
    theatre: Theatre = field(init=False)
    first_number: int = 0

    def __post_init__(self) -> None:
        self.theatre = theatre_from_config(self.config.rehearsal)

    def play(self, scene: str, *, skill: str = "good", events: Sequence[RehearsalEventConfig] = ()) -> None:
        """Play a scene and wait until it is in front of the camera."""
        requested = {"scene": scene, "skill": skill, "events": [one.model_dump() for one in events]}
        changed = {**requested, "events": list(events)}
        self.theatre = theatre_from_config(self.config.rehearsal.model_copy(update=changed))
        self.server.ask("PUT", "/api/rehearsal", 200, json=requested)

        def is_shown() -> bool:
            reported = self.server.ask("GET", "/api/rehearsal?truth=1", 200)
            self.first_number = reported["first_number"] or 0
            return reported["begun"] and reported["truth"]["moment"] is not None

        self.server.until(f"the scene {scene}", is_shown)

    def truth_of(self, snapshot: dict[str, Any]) -> Truth:
        """Ground truth of a message's image."""
        since_s = (snapshot["image_number"] - self.first_number) / self.config.rehearsal.rate_hz
        return self.theatre.truth_at(since_s)

    def touched(self) -> str:
        """The landmark on which the tip rests now."""
        moment = self.server.ask("GET", "/api/rehearsal?truth=1", 200)["truth"]["moment"]
        return "" if moment is None else str(moment["touched"])

    def calibrate_camera(self) -> dict[str, Any]:
        """Collect two views of a moving board, send images of all its positions, and calibrate."""
        self.play("board")
        self.server.ask("POST", "/api/camera/collection", 201, json={"board": BOARD})
        self.server.until(
            "two views of the board",
            lambda: len(self.server.ask("GET", "/api/camera/collection", 200)["views"]) >= 2,
        )
        for image in board_images(self.config.rehearsal):
            collection = self.server.ask("POST", "/api/camera/collection/images", 201, content=image)
        assert not collection["missing"]
        report = self.server.done(self.server.ask("POST", "/api/camera/calibration", 202, json=BY))
        self.server.until(
            "images taken with the calibrated camera",
            lambda: (self.server.ask("GET", "/api/live", 200)["snapshot"] or {}).get("camera_calibrated"),
        )
        return dict(report)

    def calibrate_tool(self) -> dict[str, Any]:
        """Calibrate the tip by pivoting; axis and diameter come from the drawing."""
        self.play("pivot")
        self.server.ask(
            "POST", "/api/tools/collection", 201, json={**DRILL, "purpose": "pivot", "marker": "drill"}
        )
        self.server.until(
            "enough poses of the drill",
            lambda: not self.server.ask("GET", "/api/tools/collection", 200)["missing"],
        )
        drawing = {"radius_mm": 2.0, "length_mm": 118.0, "axis_in_marker": [0.0, -1.0, 0.0]}
        path = "/api/tools/collection/conclusion"
        return dict(self.server.ask("POST", path, 201, json={**BY, **drawing})["content"])

    def plan(self, vertebra: str) -> None:
        """Send the CT, measure both pedicles, lay channels, set screws and landmarks."""
        ask, ct = self.server.ask, self.server.door.get("/api/rehearsal/ct").content
        self.server.done(ask("POST", "/api/ct", 202, content=ct, params=BY))
        ask("POST", "/api/plan/vertebrae", 201, json={**BY, "name": vertebra})
        truth = ask("GET", "/api/rehearsal?truth=1", 200)["truth"]
        where = f"/api/plan/vertebrae/{vertebra}"
        for side, true_channel in zip(("left", "right"), truth["channels"], strict=True):
            ends = np.array([true_channel["entry_lps_mm"], true_channel["target_lps_mm"]])
            click = ends[0] + 0.35 * (ends[1] - ends[0])
            requested = {**BY, "seed_lps_mm": click.tolist()}
            self.server.done(ask("POST", f"{where}/pedicles/{side}", 202, json=requested))
            ask("PUT", f"{where}/channels/{side}", 200, json=BY)
            ask("PUT", f"{where}/channels/{side}/screw", 200, json=BY)
        self.server.done(ask("POST", "/api/surface/from-ct", 202, json=BY))
        landmarks = [*truth["landmarks"], truth["check_landmark"]]
        ask("PUT", f"{where}/landmarks", 200, json={**BY, "landmarks": landmarks})

    def choose(self, vertebra: str, side: str) -> Channel:
        """The active channel of the plan."""
        requested = {**BY, "vertebra": vertebra, "side": side}
        plan = self.server.ask("POST", "/api/plan/active-channel", 200, json=requested)
        planned = plan["active_channel"]["channel"]
        return Channel(
            name=planned["name"],
            entry_in_vertebra_mm=np.array(planned["entry_in_vertebra_mm"]),
            target_in_vertebra_mm=np.array(planned["target_in_vertebra_mm"]),
            radius_mm=planned["radius_mm"],
        )

    def touch(self, count: int) -> dict[str, Any]:
        """Capture this many landmarks; return what is still missing."""
        self.play("landmarks")
        self.server.ask("POST", POINTS, 201, json=DRILL)
        return self.touch_more(count)

    def touch_more(self, count: int) -> dict[str, Any]:
        """Capture this many more."""
        return [self._captured() for _ in range(count)][-1]

    def _captured(self) -> dict[str, Any]:
        """Capture the next landmark on which the tip rests."""
        ask = self.server.ask

        def taken() -> dict[str, Any] | None:
            reported: dict[str, Any] = ask("GET", POINTS, 200)
            known = {one["name"] for one in reported["landmarks"] if one["touched"]}
            name = self.touched()
            if not name or name in known:
                return None
            ask("POST", f"{POINTS}/captures", 202, json={"landmark": name})
            reported = self._captured_at(POINTS)
            return reported if reported["capture"]["state"] == "taken" else None

        return dict(self.server.until("a landmark with the tip at rest on it", taken))

    def _captured_at(self, path: str) -> dict[str, Any]:
        def over() -> dict[str, Any] | None:
            reported: dict[str, Any] = self.server.ask("GET", path, 200)
            return None if reported["capture"]["state"] == "looking" else reported

        return dict(self.server.until("the end of a capture", over))

    def check(self) -> dict[str, Any]:
        """Check on the unused landmark."""
        self.play("check")
        landmark = self.theatre.check_landmark.name

        def is_captured() -> bool:
            self.server.until("the tip at rest", lambda: self.touched() == landmark)
            self.server.ask("POST", CHECK, 201, json={**DRILL, "landmark": landmark})
            return str(self._captured_at(CHECK)["capture"]["state"]) == "taken"

        self.server.until("a tip that was held still", is_captured)
        return dict(self.server.ask("POST", f"{CHECK}/conclusion", 201, json=BY)["content"])

    def steps(self) -> dict[str, str]:
        """State of each step."""
        reported = self.server.ask("GET", "/api/procedure", 200)
        return {one["step"]: one["state"] for one in reported["steps"]}

    def waits_for(self, step: str, code: str) -> None:
        """The server names this as the next step, and rejects a registration before it."""
        assert self.server.ask("GET", "/api/procedure", 200)["next_step"] == step
        self.server.rejected("POST", POINTS, code, json=DRILL)

    def open_case(self, name: str) -> None:
        """A new, empty, open case."""
        case = self.server.ask("POST", "/api/cases", 201, json={"name": name})
        self.server.ask("POST", f"/api/cases/{case['id']}/open", 200)

    def arm_a_screen(self) -> None:
        """Report a theatre screen with armed sound."""
        requested = {"screen": "theatre-one", "state": "armed"}
        self.server.ask("POST", "/api/alarms/screens", 200, json=requested)

    def heard(self, messages: Iterator[dict[str, Any]]) -> Iterator[Heard]:
        """Messages with an image of the played scene."""
        for message in messages:
            snapshot = message["snapshot"]
            if snapshot is not None and snapshot["image_number"] >= self.first_number:
                yield Heard(message=message, truth=self.truth_of(snapshot))

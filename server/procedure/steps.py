"""All steps of the set-up, made for one server."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from server.capture.address import source_from_text
from server.config import Config
from server.jobs import Jobs
from server.live import LiveHub
from server.procedure.camera import CameraStep
from server.procedure.ct import CtStep, OpenedCt
from server.procedure.in_use import CaseInUse
from server.procedure.plan import PlanStep
from server.procedure.surface import SurfaceStep
from server.procedure.tool import ToolStep
from server.setup import CaseSetup
from server.store import CaseStore
from tracker.pose.tool import ToolGate


@dataclass(frozen=True, slots=True, kw_only=True)
class Steps:
    """The steps of the set-up, which hold what is being collected just now.

    Attributes:
        camera: calibrates the camera.
        tool: calibrates tools.
        ct: takes a CT in.
        opened_ct: the CT that the others look at and plan on.
        plan: measures pedicles, lays channels, chooses screws.
        surface: makes the surface of the bone.
    """

    camera: CameraStep
    tool: ToolStep
    ct: CtStep
    opened_ct: OpenedCt
    plan: PlanStep
    surface: SurfaceStep

    @classmethod
    def of(
        cls,
        *,
        hub: LiveHub,
        store: CaseStore,
        jobs: Jobs,
        config: Config,
        side_mm_from_marker: Mapping[str, float],
        adopt: Callable[[CaseSetup], None],
    ) -> "Steps":
        """The steps; from here on `adopt` is told whenever the open case knows something else.

        Args:
            hub: the live images.
            store: where results are kept.
            jobs: where long work is done.
            config: the gates, and the tools as the settings have them.
            side_mm_from_marker: the markers that are looked for.
            adopt: has the tracking process work with what a case knows.
        """
        source = source_from_text(config.camera.source).name
        in_use = CaseInUse(store, adopt, source=source)
        store.call_after_writing(in_use.refresh)
        # A case that was open when the server stopped is open again.
        in_use.refresh()
        opened_ct = OpenedCt(store)
        return cls(
            camera=CameraStep(
                hub=hub,
                store=store,
                jobs=jobs,
                gate=config.calibration,
                source=source,
            ),
            tool=ToolStep(
                hub=hub,
                store=store,
                gate=ToolGate(**config.tool_calibration.model_dump()),
                side_mm_from_marker=side_mm_from_marker,
                tools=config.tools,
            ),
            ct=CtStep(store=store, jobs=jobs),
            opened_ct=opened_ct,
            plan=PlanStep(store=store, jobs=jobs, opened=opened_ct, config=config.plan),
            surface=SurfaceStep(store=store, jobs=jobs, opened=opened_ct),
        )

    def close(self) -> None:
        """Collect no more."""
        self.camera.end()
        self.tool.end()

"""All steps of the set-up, made for one server."""

import math
import secrets
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import structlog

from server.alarms import ProcedureFacts
from server.capture.address import SourceKind, source_from_text
from server.config import Config
from server.jobs import Jobs
from server.live import LiveHub
from server.procedure.camera import CameraStep
from server.procedure.confirm import ConfirmStep
from server.procedure.ct import CtStep, OpenedCt
from server.procedure.guiding import Guiding
from server.procedure.in_use import CaseInUse
from server.procedure.latency import LatencyStep
from server.procedure.markers import MarkerStep
from server.procedure.plan import PlanStep
from server.procedure.readout import ReadoutStep
from server.procedure.registration import RegistrationSteps
from server.procedure.state import Brought, Procedure
from server.procedure.surface import SurfaceStep
from server.procedure.tool import ToolStep
from server.setup import CaseSetup
from server.store import CaseStore, StoreError
from server.store.latency_file import LatencyFile
from tracker.marker import MarkerModel
from tracker.pose.tool import ToolGate

# As the rehearsal's theatre calls them; to load the theatre for a name takes time.
REHEARSED_TOOL, REHEARSED_REFERENCE = "drill", "reference"

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Steps:
    """The steps of the set-up, which hold what is being collected just now.

    Attributes:
        camera: calibrates the camera.
        latency: measures the latency from light to page.
        markers: takes pictures of markers in.
        tool: calibrates tools.
        ct: takes a CT in.
        opened_ct: the CT that the others look at and plan on.
        plan: measures pedicles, lays channels, chooses screws.
        surface: makes the surface of the bone.
        procedure: what may follow what.
        registration: finds the vertebra on the patient.
        confirm: takes a person's word after a start.
    """

    camera: CameraStep
    readout: ReadoutStep
    latency: LatencyStep
    markers: MarkerStep
    tool: ToolStep
    ct: CtStep
    opened_ct: OpenedCt
    plan: PlanStep
    surface: SurfaceStep
    procedure: Procedure
    registration: RegistrationSteps
    confirm: ConfirmStep

    @classmethod
    def of(
        cls,
        *,
        hub: LiveHub,
        store: CaseStore,
        jobs: Jobs,
        config: Config,
        markers: Sequence[MarkerModel],
        adopt: Callable[[CaseSetup], None],
        know: Callable[[ProcedureFacts], None] = lambda _: None,
        tracked_from_s: Callable[[], float] = lambda: -math.inf,
    ) -> "Steps":
        """The steps; from here on `adopt` is told whenever the open case knows something else.

        Args:
            hub: the live images.
            store: where results are kept.
            jobs: where long work is done.
            config: the gates, and the tools as the settings have them.
            markers: that are looked for whatever the case has.
            adopt: has the tracking process work with what a case knows.
            know: told what the alarms shall know of the procedure.
            tracked_from_s: since when the tracking process of now runs, by the images' clock.
        """
        brought = brought_by(config)
        marker_step = MarkerStep(store=store, brought=markers)
        procedure = _procedure(store, config, brought, tracked_from_s)
        latencies = LatencyFile(store.home.folder)
        in_use = CaseInUse(
            store,
            adopt,
            procedure=procedure,
            guiding=Guiding(store=store, jobs=jobs),
            brought=brought,
            markers=marker_step,
            know=know,
            latency_ms=lambda: _latency_ms(latencies, brought.source),
        )
        _keep_in_use(in_use, store)
        opened_ct = OpenedCt(store)
        surface = SurfaceStep(store=store, jobs=jobs, opened=opened_ct)
        plan = PlanStep(store=store, jobs=jobs, opened=opened_ct, config=config.plan)
        return cls(
            camera=_camera_step(hub, store, jobs, config, brought),
            readout=ReadoutStep(hub=hub, store=store, jobs=jobs, source=brought.source),
            latency=LatencyStep(
                hub=hub, store=store, file=latencies, camera=brought.source, tell=in_use.refresh
            ),
            markers=marker_step,
            tool=_tool_step(hub, store, config, marker_step),
            ct=CtStep(store=store, jobs=jobs),
            opened_ct=opened_ct,
            plan=plan,
            surface=surface,
            procedure=procedure,
            registration=_registration(hub, store, config, procedure, brought, plan=plan, surface=surface),
            confirm=ConfirmStep(hub=hub, store=store, procedure=procedure),
        )

    def close(self) -> None:
        """Collect no more."""
        self.camera.end()
        self.readout.end()
        self.latency.end()
        self.tool.end()
        self.registration.close()


def _procedure(
    store: CaseStore, config: Config, brought: Brought, tracked_from_s: Callable[[], float]
) -> Procedure:
    return Procedure(
        store,
        brought=brought,
        gate=config.registration,
        run=new_run(),
        cosign=config.supervision.cosign,
        tracked_from_s=tracked_from_s,
    )


def _registration(
    hub: LiveHub,
    store: CaseStore,
    config: Config,
    procedure: Procedure,
    brought: Brought,
    *,
    plan: PlanStep,
    surface: SurfaceStep,
) -> RegistrationSteps:
    return RegistrationSteps.of(
        hub=hub,
        store=store,
        plans=plan.repository,
        surfaces=surface,
        procedure=procedure,
        brought=brought,
        gate=config.registration,
    )


def _camera_step(hub: LiveHub, store: CaseStore, jobs: Jobs, config: Config, brought: Brought) -> CameraStep:
    return CameraStep(
        hub=hub,
        store=store,
        jobs=jobs,
        gate=config.calibration,
        source=brought.source,
        same_sensor_area=config.camera.same_sensor_area,
    )


def _latency_ms(latencies: LatencyFile, camera: str) -> float | None:
    """What 99 % of the latency measured last are within; None where there is none, or it cannot be read."""
    try:
        result = latencies.of(camera)
    except StoreError as error:
        log.warning(error.message, code=error.code, remedy=error.remedy)
        return None
    return None if result is None else result.report.p99_ms


def _tool_step(hub: LiveHub, store: CaseStore, config: Config, markers: MarkerStep) -> ToolStep:
    return ToolStep(
        hub=hub,
        store=store,
        gate=ToolGate(**config.tool_calibration.model_dump()),
        markers=markers,
        tools=config.tools,
    )


def _keep_in_use(in_use: CaseInUse, store: CaseStore) -> None:
    """Hand on each change of the store, and what is there already: a case that was open is open again."""
    store.call_after_writing(in_use.refresh)
    in_use.refresh()


def brought_by(config: Config) -> Brought:
    """What the settings bring, whatever the case has."""
    source = source_from_text(config.camera.source)
    is_rehearsal = source.kind is SourceKind.REHEARSAL
    knows_itself = is_rehearsal and config.rehearsal.brings_setup
    rehearsed = REHEARSED_REFERENCE if is_rehearsal and config.rehearsal.reference else ""
    return Brought(
        source=source.name,
        reference=config.reference.marker or rehearsed,
        has_camera=config.camera.calibration is not None or knows_itself,
        tools=frozenset(config.tools) | (frozenset({REHEARSED_TOOL}) if knows_itself else frozenset()),
    )


def new_run() -> str:
    """A name of this run of the server that no other run has."""
    return secrets.token_hex(8)

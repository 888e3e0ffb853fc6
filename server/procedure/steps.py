"""All steps of the procedure, created together for one server."""

import secrets
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import structlog

from server.capture.address import SourceKind, source_from_text
from server.certificate import InstalledCertificates
from server.config import Config
from server.installation import product_version
from server.jobs import Jobs
from server.live import LiveHub
from server.procedure.accuracy import AccuracyStep, CalibratedCameraFinder
from server.procedure.camera import CameraStep
from server.procedure.certificates import CertificateStep
from server.procedure.channel_proposal import ChannelProposer
from server.procedure.confirmation_step import ConfirmStep
from server.procedure.ct import CtProvider, CtStep
from server.procedure.drill_reference import DrillReferenceBuilder
from server.procedure.labels import LabelProvider, LabelStep
from server.procedure.latency import LatencyStep
from server.procedure.markers import MarkerStep
from server.procedure.navigation_ct import NavigationCtProvider
from server.procedure.placement import PlacementStep
from server.procedure.plan import PlanStep
from server.procedure.readout import ReadoutStep
from server.procedure.registration import RegistrationSteps
from server.procedure.setup_check import SetupChecker
from server.procedure.setup_publisher import SetupPublisher, TrackingLink
from server.procedure.state import Procedure, SetupDefaults
from server.procedure.surface import SurfaceStep
from server.procedure.tool import ToolStep
from server.store import CaseStore, StoreError
from server.store.latency_file import LatencyFile
from tracker.marker import MarkerModel
from tracker.navigation import MeasuredLatency
from tracker.pose import ToolModel
from tracker.pose.tool import ToolGate

# Names in the rehearsal's simulated theatre; repeated here because importing the theatre is slow.
REHEARSED_TOOL, REHEARSED_REFERENCE = "drill", "reference"

NO_TOOLS: Mapping[str, ToolModel] = MappingProxyType({})

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Steps:
    """The steps of the procedure, with their active collections.

    Attributes:
        camera: calibrates the camera.
        readout: measures the readout time of the camera.
        latency: measures the latency from the scene to the page.
        certificates: whether the accuracy of the tools in use is certified.
        accuracy: tests the accuracy of a tool, and issues its certificate.
        markers: stores images of markers.
        tool: calibrates tools.
        ct: imports a CT.
        ct_provider: the CT of the open case.
        navigation_ct: its part around the navigated vertebra, for viewers.
        plan: measures pedicles, plans channels, chooses screws.
        labels: takes in a segmentation of the vertebrae.
        surface: computes the surface of the bone.
        procedure: state of the procedure and order of its steps.
        registration: registers the vertebra on the patient.
        confirm: confirms a registration after a restart.
        placement: stores where screws were placed.
        channel_proposer: proposes another channel that the drill is nearer to.
        setup_check: whether the planned screw can be navigated with the registration.
    """

    camera: CameraStep
    readout: ReadoutStep
    latency: LatencyStep
    certificates: CertificateStep
    accuracy: AccuracyStep
    markers: MarkerStep
    tool: ToolStep
    ct: CtStep
    ct_provider: CtProvider
    navigation_ct: NavigationCtProvider
    plan: PlanStep
    labels: LabelStep
    surface: SurfaceStep
    procedure: Procedure
    registration: RegistrationSteps
    confirm: ConfirmStep
    placement: PlacementStep
    channel_proposer: ChannelProposer
    setup_check: SetupChecker

    @classmethod
    def of(
        cls,
        *,
        hub: LiveHub,
        store: CaseStore,
        jobs: Jobs,
        config: Config,
        markers: Sequence[MarkerModel],
        tracking: TrackingLink,
        tools: Mapping[str, ToolModel] = NO_TOOLS,
    ) -> "Steps":
        """Create the steps and start publishing each change of the open case.

        Args:
            hub: the live images.
            store: where results are stored.
            jobs: runs long computations.
            config: acceptance limits, and the configured tools.
            markers: markers that are tracked in every case.
            tracking: connection to tracking and alarms.
            tools: tools of the settings, which are used in every case.
        """
        defaults = defaults_from_config(config)
        marker_step = MarkerStep(store=store, defaults=markers, bodies=_bodies(config))
        labels = LabelProvider(store)
        procedure = _procedure(store, config, defaults, labels, tracking)
        latencies = LatencyFile(store.home.folder)
        drill_references = DrillReferenceBuilder(store=store, jobs=jobs)
        setup_publisher = SetupPublisher(
            store,
            tracking,
            procedure=procedure,
            drill_references=drill_references,
            defaults=defaults,
            markers=marker_step,
            latency=lambda: _latency(latencies, defaults.source),
        )
        _publish_changes(setup_publisher, store)
        ct_provider = CtProvider(store)
        surface = SurfaceStep(store=store, jobs=jobs, ct_provider=ct_provider)
        plan = PlanStep(
            store=store,
            jobs=jobs,
            ct_provider=ct_provider,
            labels=labels,
            config=config.plan,
            bone_wall=drill_references.bone_wall,
        )
        registration = _registration(hub, store, config, procedure, defaults, plan=plan, surface=surface)
        placement = PlacementStep(
            hub=hub,
            store=store,
            plans=plan.repository,
            registrations=registration.repository,
            run=procedure.run,
            max_age_s=config.limits.video_stale_after_ms / 1000.0,
        )
        certificates, accuracy = _certificate_steps(
            hub, store, config, defaults, markers=marker_step, latencies=latencies
        )
        channel_proposer = ChannelProposer(placement)
        store.add_commit_listener(channel_proposer.refresh)
        channel_proposer.refresh()
        return cls(
            camera=_camera_step(hub, store, jobs, config, defaults),
            readout=ReadoutStep(hub=hub, store=store, jobs=jobs, source=defaults.source),
            latency=LatencyStep(
                hub=hub,
                store=store,
                file=latencies,
                camera=defaults.source,
                on_result=setup_publisher.refresh,
            ),
            certificates=certificates,
            accuracy=accuracy,
            markers=marker_step,
            tool=_tool_step(hub, store, config, marker_step),
            ct=CtStep(store=store, jobs=jobs),
            ct_provider=ct_provider,
            navigation_ct=NavigationCtProvider(
                store=store, ct_provider=ct_provider, jobs=jobs, is_rehearsal=_knows_itself(config)
            ),
            plan=plan,
            labels=LabelStep(store=store, jobs=jobs, ct_provider=ct_provider, provider=labels),
            surface=surface,
            procedure=procedure,
            registration=registration,
            confirm=ConfirmStep(hub=hub, store=store, procedure=procedure),
            placement=placement,
            channel_proposer=channel_proposer,
            setup_check=SetupChecker(store=store, defaults=defaults, tools=tools, catalogue=plan.catalogue),
        )

    def close(self) -> None:
        """Stop all active collections."""
        self.camera.end()
        self.readout.end()
        self.latency.end()
        self.tool.end()
        self.accuracy.end()
        self.registration.close()


def _procedure(
    store: CaseStore,
    config: Config,
    defaults: SetupDefaults,
    labels: LabelProvider,
    tracking: TrackingLink,
) -> Procedure:
    return Procedure(
        store,
        labels=labels,
        defaults=defaults,
        gate=config.registration,
        run=new_run(),
        cosign=config.supervision.cosign,
        tracked_from_s=tracking.tracked_from_s,
        seconds=tracking.age_clock,
    )


def _registration(
    hub: LiveHub,
    store: CaseStore,
    config: Config,
    procedure: Procedure,
    defaults: SetupDefaults,
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
        defaults=defaults,
        gate=config.registration,
    )


def _camera_step(
    hub: LiveHub, store: CaseStore, jobs: Jobs, config: Config, defaults: SetupDefaults
) -> CameraStep:
    return CameraStep(
        hub=hub,
        store=store,
        jobs=jobs,
        gate=config.calibration,
        source=defaults.source,
        same_sensor_area=config.camera.same_sensor_area,
    )


def _certificate_steps(
    hub: LiveHub,
    store: CaseStore,
    config: Config,
    defaults: SetupDefaults,
    *,
    markers: MarkerStep,
    latencies: LatencyFile,
) -> tuple[CertificateStep, AccuracyStep]:
    """Return the steps that compare certificates with what is in use, and that issue them."""
    installed = InstalledCertificates(store.home.folder)
    cameras = CalibratedCameraFinder(store, source=defaults.source, calibration=config.camera.calibration)
    return (
        CertificateStep(hub=hub, installed=installed, markers=markers, software_version=product_version()),
        AccuracyStep(
            hub=hub, store=store, installed=installed, markers=markers, latencies=latencies, cameras=cameras
        ),
    )


def _latency(latencies: LatencyFile, camera: str) -> MeasuredLatency | None:
    """Return the last measurement; None if there is none, or it cannot be read."""
    try:
        result = latencies.of(camera)
    except StoreError as error:
        log.warning(error.message, code=error.code, remedy=error.remedy)
        return None
    return None if result is None else result.measured


def _tool_step(hub: LiveHub, store: CaseStore, config: Config, markers: MarkerStep) -> ToolStep:
    return ToolStep(
        hub=hub,
        store=store,
        gate=ToolGate(**config.tool_calibration.model_dump()),
        markers=markers,
        tools=config.tools,
    )


def _publish_changes(setup_publisher: SetupPublisher, store: CaseStore) -> None:
    """Publish each change of the store, and the present state, because a case stays open over a restart."""
    store.add_commit_listener(setup_publisher.refresh)
    setup_publisher.refresh()


def defaults_from_config(config: Config) -> SetupDefaults:
    """Return the part of the setup that the settings provide, independent of the case."""
    source = source_from_text(config.camera.source)
    is_rehearsal = source.kind is SourceKind.REHEARSAL
    knows_itself = _knows_itself(config)
    rehearsed = REHEARSED_REFERENCE if is_rehearsal and config.rehearsal.reference else ""
    return SetupDefaults(
        source=source.name,
        max_rms_px=config.calibration.max_rms_px,
        reference=config.reference.marker or rehearsed,
        has_camera=config.camera.calibration is not None or knows_itself,
        has_images=source.kind is not SourceKind.OPENIGTLINK,
        has_plan=knows_itself,
        tools=frozenset(config.tools) | (frozenset({REHEARSED_TOOL}) if knows_itself else frozenset()),
    )


def _bodies(config: Config) -> Sequence[str]:
    """Return the names of the rigid bodies of an external tracker; empty for a camera."""
    is_external = source_from_text(config.camera.source).kind is SourceKind.OPENIGTLINK
    return config.external_tracker.transforms if is_external and config.external_tracker is not None else ()


def _knows_itself(config: Config) -> bool:
    """Return whether the source is a rehearsal that provides its own setup."""
    source = source_from_text(config.camera.source)
    return source.kind is SourceKind.REHEARSAL and config.rehearsal.provides_setup


def new_run() -> str:
    """Return a unique name for this run of the server."""
    return secrets.token_hex(8)

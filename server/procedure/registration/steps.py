"""All registration steps, created together for one server."""

from dataclasses import dataclass

from server.config import RegistrationConfig
from server.live import LiveHub
from server.procedure.plan import PlanRepository
from server.procedure.registration.check import CheckStep
from server.procedure.registration.context import RegistrationContextFinder
from server.procedure.registration.monitor import RegistrationMonitor
from server.procedure.registration.needles import NeedleStep
from server.procedure.registration.nudges import NudgeStep
from server.procedure.registration.points import PointsStep
from server.procedure.registration.repository import RegistrationRepository
from server.procedure.registration.sweep import SweepStep
from server.procedure.state import Procedure, SetupDefaults
from server.procedure.surface import SurfaceStep
from server.store import CaseStore


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationSteps:
    """The steps that register the vertebra on the patient.

    Attributes:
        repository: the stored registrations.
        points: registration by captured landmarks.
        check: check on a landmark that was not used.
        needles: registration by three needles in the image.
        sweep: refinement on the bone surface.
        nudge: manual correction in small steps.
        monitor: withdraws a registration after a move of camera or reference.
    """

    repository: RegistrationRepository
    points: PointsStep
    check: CheckStep
    needles: NeedleStep
    sweep: SweepStep
    nudge: NudgeStep
    monitor: RegistrationMonitor

    @classmethod
    def of(
        cls,
        *,
        hub: LiveHub,
        store: CaseStore,
        plans: PlanRepository,
        surfaces: SurfaceStep,
        procedure: Procedure,
        defaults: SetupDefaults,
        gate: RegistrationConfig,
    ) -> "RegistrationSteps":
        """Create the steps, and start to monitor moves of camera and reference."""
        contexts = RegistrationContextFinder(
            store, hub=hub, plans=plans, procedure=procedure, defaults=defaults
        )
        repository = RegistrationRepository(store, procedure=procedure, defaults=defaults)
        return cls(
            repository=repository,
            points=PointsStep(hub=hub, contexts=contexts, repository=repository, gate=gate),
            check=CheckStep(
                hub=hub, store=store, contexts=contexts, repository=repository, procedure=procedure, gate=gate
            ),
            needles=NeedleStep(hub=hub, contexts=contexts, repository=repository),
            sweep=SweepStep(
                hub=hub,
                contexts=contexts,
                repository=repository,
                procedure=procedure,
                surfaces=surfaces,
                gate=gate,
            ),
            nudge=NudgeStep(contexts=contexts, repository=repository, gate=gate),
            monitor=RegistrationMonitor(hub, store=store, procedure=procedure, after_s=gate.moved_after_s),
        )

    def close(self) -> None:
        """Stop all active collections and the monitor."""
        self.points.end()
        self.check.end()
        self.sweep.end()
        self.monitor.stop()

"""All ways to register, and the check, made for one server."""

from dataclasses import dataclass

from server.config import RegistrationConfig
from server.live import LiveHub
from server.procedure.plan import PlanRepository
from server.procedure.registration.check import CheckStep
from server.procedure.registration.ground import GroundFinder
from server.procedure.registration.needles import NeedleStep
from server.procedure.registration.nudging import NudgeStep
from server.procedure.registration.points import PointsStep
from server.procedure.registration.repository import RegistrationRepository
from server.procedure.registration.sweep import SweepStep
from server.procedure.registration.watch import MoveWatch
from server.procedure.state import Brought, Procedure
from server.procedure.surface import SurfaceStep
from server.store import CaseStore


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationSteps:
    """The steps that find the vertebra on the patient.

    Attributes:
        shelf: where registrations lie.
        points: by landmarks that are touched.
        check: on a landmark that was not used.
        needles: by three needles in the image.
        sweep: refines it on the bone's surface.
        nudge: by hand, in small steps.
        watch: withdraws a registration when camera or reference were moved.
    """

    repository: RegistrationRepository
    points: PointsStep
    check: CheckStep
    needles: NeedleStep
    sweep: SweepStep
    nudge: NudgeStep
    watch: MoveWatch

    @classmethod
    def of(
        cls,
        *,
        hub: LiveHub,
        store: CaseStore,
        plans: PlanRepository,
        surfaces: SurfaceStep,
        procedure: Procedure,
        brought: Brought,
        gate: RegistrationConfig,
    ) -> "RegistrationSteps":
        """The steps; from here on a move of camera or reference withdraws what was registered before."""
        grounds = GroundFinder(store, hub=hub, plans=plans, procedure=procedure, brought=brought)
        repository = RegistrationRepository(store, procedure=procedure, brought=brought)
        return cls(
            repository=repository,
            points=PointsStep(hub=hub, grounds=grounds, repository=repository, gate=gate),
            check=CheckStep(
                hub=hub, store=store, grounds=grounds, repository=repository, procedure=procedure, gate=gate
            ),
            needles=NeedleStep(hub=hub, grounds=grounds, repository=repository),
            sweep=SweepStep(
                hub=hub,
                grounds=grounds,
                repository=repository,
                procedure=procedure,
                surfaces=surfaces,
                gate=gate,
            ),
            nudge=NudgeStep(grounds=grounds, repository=repository, gate=gate),
            watch=MoveWatch(hub, store=store, procedure=procedure, after_s=gate.moved_after_s),
        )

    def close(self) -> None:
        """Look no more."""
        self.points.end()
        self.check.end()
        self.sweep.end()
        self.watch.stop()

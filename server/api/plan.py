"""The plan: vertebrae, pedicles, channels and screws; each change creates a version; export and import."""

import json

from anyio import to_thread
from fastapi import APIRouter, Request, Response

from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.api.plan_files import add_markups
from server.api.plan_messages import (
    ActiveChannelRequest,
    CatalogueMessage,
    ChannelRequest,
    ClearancesMessage,
    CorrectionsRequest,
    ExpectedVersion,
    LandmarksRequest,
    PlanMessage,
    PlanRequest,
    ReferenceRequest,
    ScrewProposalMessage,
    ScrewRangeMessage,
    ScrewRequest,
    SeedRequest,
    SliceProposalMessage,
    VertebraRequest,
    clearances_message,
    plan_message,
    proposal_message,
)
from server.api.requester import MadeByQuery
from server.api.slice_images import HU, PNG_ANSWER, WindowHu, picture, window_from_query
from server.api.uploads import received
from server.procedure.ct import CtProvider
from server.procedure.plan import Author, PlanStep, export_plan, import_plan, reference_picture
from server.store import Home
from tracker.errors import InvalidInput
from tracker.plan import plan_from_mapping
from tracker.plan.document.changes import vertebra_named
from tracker.plan.pedicle import Side

MAX_PLAN_BYTES = 8 * 2**20
JSON = "application/json"
CHANGE_ERRORS = rejections(404, 409, 422, 503, 507)


def plan_router(step: PlanStep, opened: CtProvider, home: Home, *, min_landmarks: int) -> APIRouter:
    """Return the router of `/api/plan`. Its routes are synchronous because they wait for the disk."""
    router = APIRouter(prefix="/api/plan", tags=["plan"])
    _add_whole(router, step, min_landmarks)
    _add_files(router, step, opened, home)
    add_markups(router, step, home)
    _add_vertebrae(router, step)
    _add_pedicles(router, step)
    _add_channels(router, step)
    _add_reference(router, step, opened)
    _add_landmarks(router, step)
    _add_active(router, step)
    return router


def _add_whole(router: APIRouter, step: PlanStep, min_landmarks: int) -> None:
    @router.get("", responses=rejections(409, 503))
    def plan() -> PlanMessage:
        """Return the newest plan of the open case with its validity."""
        return plan_message(step.repository.latest())

    @router.put("", responses=CHANGE_ERRORS)
    def replace(requested: PlanRequest) -> PlanMessage:
        """Store a complete plan as the next version, on the present CT.

        Grades, clearances, bone densities, tolerances and lines are recomputed.
        """
        return plan_message(step.replace(plan_from_mapping(requested.plan), requested.author))

    @router.get("/catalogue")
    def catalogue() -> CatalogueMessage:
        """Return the screw sizes and the minimum number of landmarks of the settings."""
        return CatalogueMessage(
            diameters_mm=list(step.catalogue.diameters_mm),
            lengths_mm=list(step.catalogue.lengths_mm),
            ranges=[ScrewRangeMessage.model_validate(one, from_attributes=True) for one in step.screw_ranges],
            min_landmarks=min_landmarks,
        )

    @router.get("/clearances", responses=rejections(409, 503))
    def clearances() -> ClearancesMessage:
        """Return the clearance of each planned screw to the wall, by depth."""
        return clearances_message(*step.clearances(), margin_mm=step.wall_margin_mm)


def _add_files(router: APIRouter, step: PlanStep, opened: CtProvider, home: Home) -> None:
    @router.get(
        "/export", response_class=Response, responses={200: {"content": {JSON: {}}}, **rejections(409, 503)}
    )
    def write() -> Response:
        """Export the plan as JSON with author, time and CT, without the identity of the patient."""
        stored, ct = step.repository.latest(), opened.current()
        on_it = ct if ct.document.id in stored.document.depends_on else None
        return Response(
            json.dumps(export_plan(stored, on_it), indent=1, allow_nan=False),
            media_type=JSON,
            headers={"Content-Disposition": f'attachment; filename="plan-{stored.document.version}.json"'},
        )

    @router.post(
        "/import",
        status_code=201,
        responses=rejections(409, 413, 422, 503, 507),
        openapi_extra={"requestBody": {"required": True, "content": {JSON: {}}}},
    )
    async def read(
        request: Request,
        made_by: MadeByQuery,
        expected_version: ExpectedVersion = None,
        *,
        for_other_ct: bool = False,
    ) -> PlanMessage:
        """Import a plan from a file in the request body as the next version.

        It must have been made on the CT of the open case, unless `for_other_ct` is set.
        """
        async with received(request, home, max_bytes=MAX_PLAN_BYTES) as path:
            content = await to_thread.run_sync(path.read_bytes)

        def take() -> PlanMessage:
            found = import_plan(content, opened.current(), is_for_other_ct=for_other_ct)
            return plan_message(
                step.replace(found, Author(made_by=made_by, expected_version=expected_version))
            )

        return await to_thread.run_sync(take)


def _add_vertebrae(router: APIRouter, step: PlanStep) -> None:
    @router.post("/vertebrae", status_code=201, responses=CHANGE_ERRORS)
    def add(requested: VertebraRequest) -> PlanMessage:
        """Add a vertebra; the first one creates the plan."""
        return plan_message(step.add_vertebra(requested.name, requested.author))

    @router.delete("/vertebrae/{name}", responses=CHANGE_ERRORS)
    def remove(name: str, made_by: MadeByQuery, expected_version: ExpectedVersion = None) -> PlanMessage:
        """Remove a vertebra from the plan."""
        return plan_message(
            step.remove_vertebra(name, Author(made_by=made_by, expected_version=expected_version))
        )


def _add_pedicles(router: APIRouter, step: PlanStep) -> None:
    @router.post("/vertebrae/{name}/pedicles/{side}", status_code=202, responses=CHANGE_ERRORS)
    def measure(name: str, side: Side, requested: SeedRequest) -> JobMessage:
        """Measure the pedicle at a seed point in a job and add it to the plan.

        Its channel, unless set by hand, and its screw are recomputed; corrections are removed.
        """
        return job_message(step.measure(name, side, requested.seed_lps_mm, requested.author))

    @router.put("/vertebrae/{name}/pedicles/{side}/corrections", responses=CHANGE_ERRORS)
    def correct(name: str, side: Side, requested: CorrectionsRequest) -> PlanMessage:
        """Correct measured values; both are stored."""
        return plan_message(step.correct(name, side, requested.corrected, requested.author))


def _add_channels(router: APIRouter, step: PlanStep) -> None:
    @router.put("/vertebrae/{name}/channels/{side}", responses=CHANGE_ERRORS)
    def lay(name: str, side: Side, requested: ChannelRequest) -> PlanMessage:
        """Place the channel along the measured pedicle with its minimum width, or set it by hand.

        Along the pedicle it gets the proposed screw, if one fits.
        """
        hand = requested.by_hand
        ends = None if hand is None else (hand.entry_lps_mm, hand.target_lps_mm, hand.diameter_mm)
        return plan_message(step.lay_channel(name, side, ends, requested.author))

    @router.delete("/vertebrae/{name}/channels/{side}", responses=CHANGE_ERRORS)
    def remove(
        name: str, side: Side, made_by: MadeByQuery, expected_version: ExpectedVersion = None
    ) -> PlanMessage:
        """Remove a channel and its screw."""
        by = Author(made_by=made_by, expected_version=expected_version)
        return plan_message(step.remove_channel(name, side, by))

    @router.get("/proposals/screw", responses=rejections(409, 422, 503))
    def propose(vertebra: str, side: Side) -> ScrewProposalMessage:
        """Return the thickest and longest screw that keeps its margins in this channel."""
        diameter_mm, length_mm = step.propose_screw(vertebra, side)
        return ScrewProposalMessage(diameter_mm=diameter_mm, length_mm=length_mm)

    @router.put("/vertebrae/{name}/channels/{side}/screw", responses=CHANGE_ERRORS)
    def choose(name: str, side: Side, requested: ScrewRequest) -> PlanMessage:
        """Choose a screw of the catalogue; clearance, grade, bone density and tolerance are computed."""
        if (requested.diameter_mm is None) != (requested.length_mm is None):
            raise InvalidInput(
                "SCREW_INCOMPLETE",
                "only one of diameter_mm and length_mm was given",
                "Give both, or none for the proposed screw.",
            )
        size = None
        if requested.diameter_mm is not None and requested.length_mm is not None:
            size = requested.diameter_mm, requested.length_mm
        return plan_message(step.choose_screw(name, side, size, requested.author))

    @router.delete("/vertebrae/{name}/channels/{side}/screw", responses=CHANGE_ERRORS)
    def remove_screw(
        name: str, side: Side, made_by: MadeByQuery, expected_version: ExpectedVersion = None
    ) -> PlanMessage:
        """Remove the screw of a channel."""
        by = Author(made_by=made_by, expected_version=expected_version)
        return plan_message(step.remove_screw(name, side, by))


def _add_reference(router: APIRouter, step: PlanStep, opened: CtProvider) -> None:
    @router.get("/proposals/slice", responses=rejections(409, 422, 503))
    def propose(vertebra: str) -> SliceProposalMessage:
        """Return the slice nearest to the isthmuses of a vertebra, and the midpoint between them."""
        return proposal_message(step.propose_slice(vertebra))

    @router.put("/vertebrae/{name}/reference", responses=CHANGE_ERRORS)
    def choose(name: str, requested: ReferenceRequest) -> PlanMessage:
        """Set the reference slice of a vertebra and its three lines."""
        stored = step.choose_slice(
            name,
            slice_index=requested.slice_index,
            middle_lps_mm=requested.middle_lps_mm,
            apart_mm=requested.apart_mm,
            by=requested.author,
        )
        return plan_message(stored)

    @router.get(
        "/vertebrae/{name}/reference.png",
        response_class=Response,
        responses={**PNG_ANSWER, **rejections(409, 422, 503)},
    )
    def reference(
        request: Request,
        name: str,
        window: WindowHu | None = None,
        level: HU | None = None,
        preset: str | None = None,
    ) -> Response:
        """Return the reference slice as PNG with its lines and trajectories from entry to target (ring)."""
        grey = window_from_query(window, level, preset)
        stored, ct = step.repository.latest_valid(), opened.current()
        vertebra = vertebra_named(stored.plan, name)
        return picture(request, stored.document.id, lambda: reference_picture(vertebra, ct.volume, grey))


def _add_landmarks(router: APIRouter, step: PlanStep) -> None:
    @router.put("/vertebrae/{name}/landmarks", responses=CHANGE_ERRORS)
    def put(name: str, requested: LandmarksRequest) -> PlanMessage:
        """Set all landmarks of a vertebra, for registration by needles or by the tip.

        They replace the previous ones; an empty list removes all.
        """
        return plan_message(step.set_landmarks(name, requested.records, requested.author))


def _add_active(router: APIRouter, step: PlanStep) -> None:
    @router.post("/active-channel", responses=rejections(409, 422, 503, 507))
    def activate(requested: ActiveChannelRequest) -> PlanMessage:
        """Set the active channel; navigation uses it from the next image on.

        It stays active when the plan changes without changing this channel.
        """
        return plan_message(
            step.repository.activate(requested.vertebra, requested.side, made_by=requested.made_by)
        )

    @router.delete("/active-channel", responses=rejections(409, 422, 503, 507))
    def deactivate(made_by: MadeByQuery) -> PlanMessage:
        """Unset the active channel."""
        return plan_message(step.repository.deactivate(made_by=made_by))

"""The plan: vertebrae, pedicles, channels, screws, each change a new version; written and read as a file."""

import json
from typing import Annotated, TypeAlias

from anyio import to_thread
from fastapi import APIRouter, Query, Request, Response

from server.api.doing import MadeByQuery
from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.api.pictures import HU, PNG_ANSWER, WindowHu, asked_window, picture
from server.api.plan_messages import (
    ActiveChannelRequest,
    CatalogueMessage,
    ChannelRequest,
    CorrectionsRequest,
    LandmarksRequest,
    PlanMessage,
    PlanRequest,
    ReferenceRequest,
    ScrewProposalMessage,
    ScrewRequest,
    SeedRequest,
    SliceProposalMessage,
    Version,
    VertebraRequest,
    plan_message,
    proposal_message,
)
from server.api.uploads import received
from server.procedure.ct import OpenedCt
from server.procedure.plan import Author, PlanStep, plan_in, plan_out, reference_picture
from server.store import Home
from tracker.errors import InvalidInput
from tracker.plan import plan_from_mapping
from tracker.plan.document.changes import vertebra_named
from tracker.plan.pedicle import Side

LARGEST_PLAN_BYTES = 8 * 2**20
JSON = "application/json"
CHANGED = rejections(404, 409, 422, 503, 507)
On: TypeAlias = Annotated[Version | None, Query(alias="expected_version")]


def plan_router(step: PlanStep, opened: OpenedCt, home: Home, *, min_landmarks: int) -> APIRouter:
    """Everything under `/api/plan`. Plain functions: they wait for the disk, in threads."""
    router = APIRouter(prefix="/api/plan", tags=["plan"])
    _add_whole(router, step, min_landmarks)
    _add_files(router, step, opened, home)
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
        """The newest plan of the open case, and whether it still holds."""
        return plan_message(step.repository.latest())

    @router.put("", responses=CHANGED)
    def replace(asked: PlanRequest) -> PlanMessage:
        """Store a whole plan as the next version, on the CT that is there now.

        Grades, clearances, bone, tolerances and lines in it are not believed but worked out anew.
        """
        return plan_message(step.replace(plan_from_mapping(asked.plan), asked.author))

    @router.get("/catalogue")
    def catalogue() -> CatalogueMessage:
        """The screws of the settings, and how many landmarks they want."""
        return CatalogueMessage(
            diameters_mm=list(step.catalogue.diameters_mm),
            lengths_mm=list(step.catalogue.lengths_mm),
            min_landmarks=min_landmarks,
        )


def _add_files(router: APIRouter, step: PlanStep, opened: OpenedCt, home: Home) -> None:
    @router.get(
        "/export", response_class=Response, responses={200: {"content": {JSON: {}}}, **rejections(409, 503)}
    )
    def write() -> Response:
        """The plan as a file: JSON with who made it, when, and on which CT; nothing names the patient."""
        kept, ct = step.repository.latest(), opened.current()
        on_it = ct if ct.document.id in kept.document.stands_on else None
        return Response(
            json.dumps(plan_out(kept, on_it), indent=1, allow_nan=False),
            media_type=JSON,
            headers={"Content-Disposition": f'attachment; filename="plan-{kept.document.version}.json"'},
        )

    @router.post(
        "/import",
        status_code=201,
        responses=rejections(409, 413, 422, 503, 507),
        openapi_extra={"requestBody": {"required": True, "content": {JSON: {}}}},
    )
    async def read(
        request: Request, made_by: MadeByQuery, expected_version: On = None, *, for_other_ct: bool = False
    ) -> PlanMessage:
        """Take a plan in from its file, which is the body of the request, as the next version.

        It must have been made on the CT of the open case; `for_other_ct` takes it all the same.
        """
        async with received(request, home, max_bytes=LARGEST_PLAN_BYTES) as path:
            content = await to_thread.run_sync(path.read_bytes)

        def take() -> PlanMessage:
            found = plan_in(content, opened.current(), is_for_other_ct=for_other_ct)
            return plan_message(
                step.replace(found, Author(made_by=made_by, expected_version=expected_version))
            )

        return await to_thread.run_sync(take)


def _add_vertebrae(router: APIRouter, step: PlanStep) -> None:
    @router.post("/vertebrae", status_code=201, responses=CHANGED)
    def add(asked: VertebraRequest) -> PlanMessage:
        """Plan one vertebra more; the first one begins the plan."""
        return plan_message(step.add_vertebra(asked.name, asked.author))

    @router.delete("/vertebrae/{name}", responses=CHANGED)
    def remove(name: str, made_by: MadeByQuery, expected_version: On = None) -> PlanMessage:
        """Take a vertebra out of the plan."""
        return plan_message(
            step.remove_vertebra(name, Author(made_by=made_by, expected_version=expected_version))
        )


def _add_pedicles(router: APIRouter, step: PlanStep) -> None:
    @router.post("/vertebrae/{name}/pedicles/{side}", status_code=202, responses=CHANGED)
    def measure(name: str, side: Side, asked: SeedRequest) -> JobMessage:
        """Measure the pedicle that was clicked on, in a job, and put it into the plan.

        Its channel, if it is not set by hand, and the screw in it are worked out anew; corrections are gone.
        """
        return job_message(step.measure(name, side, asked.seed_lps_mm, asked.author))

    @router.put("/vertebrae/{name}/pedicles/{side}/corrections", responses=CHANGED)
    def correct(name: str, side: Side, asked: CorrectionsRequest) -> PlanMessage:
        """Put numbers in place of the measured ones; both are kept."""
        return plan_message(step.correct(name, side, asked.corrected, asked.author))


def _add_channels(router: APIRouter, step: PlanStep) -> None:
    @router.put("/vertebrae/{name}/channels/{side}", responses=CHANGED)
    def lay(name: str, side: Side, asked: ChannelRequest) -> PlanMessage:
        """Lay the channel along the measured pedicle, as wide as it at its narrowest; or set it by hand."""
        hand = asked.by_hand
        ends = None if hand is None else (hand.entry_lps_mm, hand.target_lps_mm, hand.diameter_mm)
        return plan_message(step.lay_channel(name, side, ends, asked.author))

    @router.delete("/vertebrae/{name}/channels/{side}", responses=CHANGED)
    def remove(name: str, side: Side, made_by: MadeByQuery, expected_version: On = None) -> PlanMessage:
        """Take a channel out of the plan, with its screw."""
        by = Author(made_by=made_by, expected_version=expected_version)
        return plan_message(step.remove_channel(name, side, by))

    @router.get("/proposals/screw", responses=rejections(409, 422, 503))
    def propose(vertebra: str, side: Side) -> ScrewProposalMessage:
        """The thickest and longest screw of the catalogue that keeps its margins in this channel."""
        diameter_mm, length_mm = step.propose_screw(vertebra, side)
        return ScrewProposalMessage(diameter_mm=diameter_mm, length_mm=length_mm)

    @router.put("/vertebrae/{name}/channels/{side}/screw", responses=CHANGED)
    def choose(name: str, side: Side, asked: ScrewRequest) -> PlanMessage:
        """Choose a screw of the catalogue; clearance, grade, bone along it and tolerance come with it."""
        if (asked.diameter_mm is None) != (asked.length_mm is None):
            raise InvalidInput(
                "SCREW_INCOMPLETE",
                "only one of diameter_mm and length_mm was given",
                "Give both, or none for the proposed screw.",
            )
        size = None
        if asked.diameter_mm is not None and asked.length_mm is not None:
            size = asked.diameter_mm, asked.length_mm
        return plan_message(step.choose_screw(name, side, size, asked.author))

    @router.delete("/vertebrae/{name}/channels/{side}/screw", responses=CHANGED)
    def remove_screw(name: str, side: Side, made_by: MadeByQuery, expected_version: On = None) -> PlanMessage:
        """Take the screw out of a channel."""
        by = Author(made_by=made_by, expected_version=expected_version)
        return plan_message(step.remove_screw(name, side, by))


def _add_reference(router: APIRouter, step: PlanStep, opened: OpenedCt) -> None:
    @router.get("/proposals/slice", responses=rejections(409, 422, 503))
    def propose(vertebra: str) -> SliceProposalMessage:
        """The slice nearest to the isthmuses of a vertebra, and the point half-way between them."""
        return proposal_message(step.propose_slice(vertebra))

    @router.put("/vertebrae/{name}/reference", responses=CHANGED)
    def choose(name: str, asked: ReferenceRequest) -> PlanMessage:
        """Choose the slice that stands for a vertebra, and lay its three lines."""
        kept = step.choose_slice(
            name,
            slice_index=asked.slice_index,
            middle_lps_mm=asked.middle_lps_mm,
            apart_mm=asked.apart_mm,
            by=asked.author,
        )
        return plan_message(kept)

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
        """The reference slice with its three lines and the paths, from entry to target (a ring)."""
        grey = asked_window(window, level, preset)
        kept, ct = step.repository.latest_that_holds(), opened.current()
        vertebra = vertebra_named(kept.plan, name)
        return picture(request, kept.document.id, lambda: reference_picture(vertebra, ct.volume, grey))


def _add_landmarks(router: APIRouter, step: PlanStep) -> None:
    @router.put("/vertebrae/{name}/landmarks", responses=CHANGED)
    def put(name: str, asked: LandmarksRequest) -> PlanMessage:
        """Set all landmarks of a vertebra: where needles stand in the bone, or the tip is held to register.

        They take the place of those that were there, so an empty list takes them all out.
        """
        return plan_message(step.set_landmarks(name, asked.records, asked.author))


def _add_active(router: APIRouter, step: PlanStep) -> None:
    @router.post("/active-channel", responses=rejections(409, 422, 503, 507))
    def activate(asked: ActiveChannelRequest) -> PlanMessage:
        """Say which channel is to be drilled now; navigation works with it from the next image on.

        A change of the plan that leaves this channel as it is leaves it active.
        """
        return plan_message(step.repository.activate(asked.vertebra, asked.side, made_by=asked.made_by))

    @router.delete("/active-channel", responses=rejections(409, 422, 503, 507))
    def deactivate(made_by: MadeByQuery) -> PlanMessage:
        """Have no channel to be drilled now."""
        return plan_message(step.repository.deactivate(made_by=made_by))

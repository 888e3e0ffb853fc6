"""Export of a plan to files of 3D Slicer, and import of landmarks and channels from them."""

from pathlib import Path
from typing import Annotated

from anyio import to_thread
from fastapi import APIRouter, Query, Request, Response

from server.api.errors import rejections
from server.api.plan_messages import ExpectedVersion, PlanMessage, plan_message
from server.api.requester import MadeByQuery
from server.api.uploads import received
from server.errors import SetupOrderError
from server.procedure.plan import Author, PlanStep
from server.slicer_file import (
    Markup,
    landmarks_from_markups,
    line_from_markups,
    markups_from_bytes,
    markups_to_bytes,
    plan_markups,
)
from server.store import Home
from tracker.plan.pedicle import Side

MAX_MARKUPS_BYTES = 2 * 2**20
JSON = "application/json"
SENT = {"requestBody": {"required": True, "content": {JSON: {}}}}
IMPORT_ERRORS = rejections(404, 409, 413, 422, 503, 507)
# The server does not know the name of the uploaded file.
FILE = "the file"


def add_markups(router: APIRouter, step: PlanStep, home: Home) -> None:
    """Add the routes of the plan's markups to the router of `/api/plan`."""

    @router.get(
        "/markups", response_class=Response, responses={200: {"content": {JSON: {}}}, **rejections(409, 503)}
    )
    def write() -> Response:
        """Export landmarks, channels and screws as markups of 3D Slicer, in LPS of the plan's CT.

        A plan that is out of date is rejected, because its CT is no longer the CT of the case.
        """
        stored = step.repository.latest_valid()
        markups = plan_markups(stored.plan)
        if not markups:
            raise SetupOrderError(
                "PLAN_EMPTY",
                f"the plan has {len(stored.plan.vertebrae)} vertebrae, but no landmark and no channel",
                "Set landmarks or place a channel first.",
                {"vertebrae": len(stored.plan.vertebrae)},
            )
        return Response(
            markups_to_bytes(markups),
            media_type=JSON,
            headers={
                "Content-Disposition": f'attachment; filename="plan-{stored.document.version}.mrk.json"'
            },
        )

    @router.post(
        "/vertebrae/{name}/landmarks/import",
        status_code=201,
        responses=IMPORT_ERRORS,
        openapi_extra=SENT,
    )
    async def read_landmarks(
        request: Request, name: str, made_by: MadeByQuery, expected_version: ExpectedVersion = None
    ) -> PlanMessage:
        """Set all landmarks of a vertebra from the point list of a markups file in the request body.

        They replace the previous ones. The file does not state its CT: verify each point on this CT.
        """
        markups = await _markups(request, home)
        by = Author(made_by=made_by, expected_version=expected_version)

        def take() -> PlanMessage:
            return plan_message(step.set_landmarks(name, landmarks_from_markups(markups, name=FILE), by))

        return await to_thread.run_sync(take)

    @router.post(
        "/vertebrae/{name}/channels/{side}/import",
        status_code=201,
        responses=IMPORT_ERRORS,
        openapi_extra=SENT,
    )
    async def read_channel(
        request: Request,
        name: str,
        side: Side,
        diameter_mm: Annotated[float, Query(gt=0.0, le=20.0, allow_inf_nan=False)],
        made_by: MadeByQuery,
        expected_version: ExpectedVersion = None,
    ) -> PlanMessage:
        """Set a channel by hand from the line of a markups file in the request body.

        It runs from the first point to the second, or from the one labelled `entry` to the one labelled
        `target`. The file does not state its CT: verify the channel on this CT.
        """
        markups = await _markups(request, home)
        by = Author(made_by=made_by, expected_version=expected_version)

        def take() -> PlanMessage:
            entry_lps_mm, target_lps_mm = line_from_markups(markups, name=FILE)
            ends = entry_lps_mm.tolist(), target_lps_mm.tolist(), diameter_mm
            return plan_message(step.lay_channel(name, side, ends, by))

        return await to_thread.run_sync(take)


async def _markups(request: Request, home: Home) -> tuple[Markup, ...]:
    async with received(request, home, max_bytes=MAX_MARKUPS_BYTES) as path:
        return await to_thread.run_sync(_read, path)


def _read(path: Path) -> tuple[Markup, ...]:
    return markups_from_bytes(path.read_bytes(), name=FILE)

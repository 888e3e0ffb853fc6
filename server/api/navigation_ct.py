"""The CT around the navigated vertebra, from which the theatre's page cuts the planes of the drill."""

from collections.abc import Mapping

from fastapi import APIRouter, Request, Response

from server.api.ct_messages import WindowMessage, preset_messages
from server.api.errors import rejections
from server.api.revalidation import unless_known
from server.procedure.navigation_ct import BeingScanned, NavigationCt, NavigationCtProvider
from server.stream.messages import Message

VOXELS = "application/octet-stream"
VOLUME_PLACE = "Volume-Place"


class VolumeMessage(Message):
    """Geometry of the voxels of a response, and the display windows by name."""

    ct_id: str
    """Id of the CT as in the channel of the live message; voxels of another CT do not fit its pose."""
    size_ijk: list[int]
    lps_from_ijk: list[list[float]]
    """4x4 matrix from voxel indices to LPS in mm, which is the vertebra frame."""
    presets: dict[str, WindowMessage]


def navigation_ct_router(provider: NavigationCtProvider) -> APIRouter:
    """Return the router of `/api/navigation`. Its route is synchronous because it reads from the disk."""
    router = APIRouter(prefix="/api/navigation", tags=["ct"])

    @router.get(
        "/ct",
        response_class=Response,
        responses={
            200: {
                "content": {VOXELS: {}},
                "headers": {
                    VOLUME_PLACE: {
                        "description": "As JSON: ct_id; size_ijk; lps_from_ijk, a 4x4 matrix in mm; presets, "
                        "display windows in HU by name.",
                        "required": True,
                        "schema": {"type": "string"},
                    }
                },
            },
            204: {
                "description": "The CT of the rehearsal is being simulated; try again after a few seconds."
            },
            **rejections(409, 422, 503),
        },
    )
    def voxels(request: Request) -> Response:
        """Return the CT around the channels of the navigated vertebra, about 100 mm a side.

        Voxels are Hounsfield units as int16, little-endian, i fastest, at most 16 MB uncompressed.
        """
        found = provider.current()
        if isinstance(found, BeingScanned):
            # 204 instead of 404, because an early request is no error.
            return Response(status_code=204)
        return _answer(request, found)

    return router


def _answer(request: Request, found: NavigationCt) -> Response:
    packed = "gzip" in request.headers.get("accept-encoding", "")

    def respond(headers: Mapping[str, str]) -> Response:
        place = VolumeMessage(
            ct_id=found.ct_id,
            size_ijk=list(found.volume.shape_ijk),
            lps_from_ijk=found.volume.lps_from_ijk.tolist(),
            presets=preset_messages(),
        )
        headers = {**headers, VOLUME_PLACE: place.model_dump_json()}
        if packed:
            return Response(found.gzipped, media_type=VOXELS, headers={**headers, "Content-Encoding": "gzip"})
        voxels = found.volume.hu.astype("<i2", copy=False).tobytes()
        return Response(voxels, media_type=VOXELS, headers=headers)

    tag = f"{found.digest}-gzip" if packed else found.digest
    return unless_known(request, tag, respond, headers={"Vary": "Accept-Encoding"})

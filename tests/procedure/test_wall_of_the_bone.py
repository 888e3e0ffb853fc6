"""The drill is compared with the bone of the case as soon as the distances to it are computed."""

from typing import Any

import numpy as np
import pytest

from server.procedure.drill_reference import WALL_SD_MM
from tests.procedure.conftest import Server
from tests.procedure.test_ct_step import BY
from tests.procedure.test_plan_step import planned
from tests.procedure.uploads import dicom_zip

WORK = "measuring the distances to the bone"


def test_the_surface_of_the_case_becomes_the_wall(server: Server) -> None:
    planned(server, dicom_zip())
    for side in ("left", "right"):
        server.ask("PUT", f"/api/plan/vertebrae/L3/channels/{side}/screw", 200, json=BY)
    by_outline = clearances(server)
    assert [one["against"] for one in by_outline.values()] == ["pedicle", "pedicle"]
    job = server.ask("POST", "/api/surface/from-ct", 202, json=BY)
    assert server.done(job)["state"] == "done"
    server.ask("POST", "/api/plan/active-channel", 200, json={**BY, "vertebra": "L3", "side": "left"})
    measuring = next(one for one in server.ask("GET", "/api/jobs", 200)["jobs"] if one["title"] == WORK)
    done = server.done(measuring)
    assert done["state"] == "done", done["problem"]
    assert done["result"]["in_use"]
    assert done["result"]["against"] == "bone", done["result"]
    drill_reference = server.adopted[-1].drill_reference
    assert drill_reference is not None
    assert drill_reference.wall.against == "bone"
    # The probability of a breach includes this surface's uncertainty, not a default.
    surface = server.ask("GET", "/api/surface", 200)["content"]
    assert drill_reference.wall_sd_mm == surface["sd_mm"]
    assert 0.05 < surface["sd_mm"] < 1.0
    before = server.adopted[0].drill_reference
    assert before is not None
    assert before.wall_sd_mm == WALL_SD_MM != surface["sd_mm"]

    # The bone is also what the planned screw of this channel is drawn against, along all of it.
    by_bone = clearances(server)
    assert (by_bone["left"]["against"], by_bone["right"]) == ("bone", by_outline["right"])
    length_mm = by_bone["left"]["depth_mm"][-1]
    assert length_mm > by_outline["left"]["depth_mm"][-1] + 10.0
    in_pedicle = np.interp(
        by_outline["left"]["depth_mm"], by_bone["left"]["depth_mm"], by_bone["left"]["clearance_mm"]
    )
    assert in_pedicle.min() == pytest.approx(by_outline["left"]["min_mm"], abs=0.6)


def clearances(server: Server) -> dict[str, Any]:
    """Clearance of each screw by the side of its channel."""
    channels = server.ask("GET", "/api/plan/clearances", 200)["channels"]
    return {one["side"]: one["clearance"] for one in channels}

"""The drill is compared with the bone of the case as soon as the distances to it are computed."""

from server.procedure.drill_reference import WALL_SD_MM
from tests.procedure.conftest import Server
from tests.procedure.test_ct_step import BY
from tests.procedure.test_plan_step import planned
from tests.procedure.uploads import dicom_zip

WORK = "measuring the distances to the bone"


def test_the_surface_of_the_case_becomes_the_wall(server: Server) -> None:
    planned(server, dicom_zip())
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

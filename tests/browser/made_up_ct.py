"""A CT around the channel of the fake theatre, given to a page in place of the server's answer."""

import json
from functools import cache

import numpy as np
from playwright.sync_api import Route

CT_ID = "ct-of-l3"


@cache
def ct_answer() -> tuple[dict[str, str], bytes]:
    """Header and voxels of a CT around the channel: a vertebral body of 40 mm with a denser cortex."""
    spacing_mm, origin_mm, size = 2.0, np.array([-60.0, -60.0, -50.0]), (60, 60, 60)
    places = origin_mm + spacing_mm * np.moveaxis(np.indices(size), 0, -1)
    away_mm = np.linalg.norm(places - [0.0, 0.0, 20.0], axis=-1)
    hu = np.where(away_mm < 30.0, np.where(away_mm < 26.0, 300, 1100), -50).astype("<i2")
    lps_from_ijk = np.diag([spacing_mm] * 3 + [1.0])
    lps_from_ijk[:3, 3] = origin_mm
    place = {
        "ct_id": CT_ID,
        "size_ijk": size,
        "lps_from_ijk": lps_from_ijk.tolist(),
        "presets": {"bone": {"window_hu": 1800, "level_hu": 400}},
    }
    # The first index varies fastest.
    return {"volume-place": json.dumps(place)}, hu.tobytes(order="F")


def answer_ct(route: Route) -> None:
    """Answer the request of a page for the CT; the case of the server has none."""
    headers, voxels = ct_answer()
    route.fulfill(headers=headers, body=voxels, content_type="application/octet-stream")

"""Prepares a case with camera, tool, CT and plan in a folder before a server is started there."""

from pathlib import Path
from typing import Literal

import numpy as np

from server.config import RehearsalConfig
from server.store import CaseStore, DocumentKind, Home
from server.theatre import theatre_from_config
from tests.procedure.patient import tool_content
from tracker.plan import Landmark, PlanDocument, draw_reference, plan_to_mapping
from tracker.plan.document import PlannedChannel, VertebraPlan
from tracker.rehearsal import Theatre
from tracker.rehearsal.ct import rehearsal_ct

# Coarser than a scanner's, since the tests need positions, not detail.
SPACING_MM = (1.2, 1.2, 1.5)
APART_MM = 20.0
SIDES: tuple[Literal["left", "right"], ...] = ("left", "right")


def prepared(home: Path, rehearsal: RehearsalConfig) -> Theatre:
    """Store an open case that is ready for registration in this folder; return its theatre."""
    theatre = theatre_from_config(rehearsal)
    camera = theatre.camera
    with Home(home) as folder, CaseStore(folder) as store:
        case = store.create("L3, left")
        store.open(case.id)
        values = {
            "matrix": camera.matrix.tolist(),
            "distortion": camera.distortion.tolist(),
            "size_wh_px": list(camera.size_wh_px),
            "source": "rehearsal",
        }
        calibration = store.put(case.id, DocumentKind.CAMERA, "main", {"camera": values}, made_by="test")
        store.put(
            case.id, DocumentKind.TOOL, "drill", tool_content(), made_by="test", depends_on=[calibration.id]
        )
        volume = rehearsal_ct(spacing_mm=SPACING_MM)
        with store.new_file(case.id, ".npy") as new:
            np.save(new.path, volume.hu)
        ct = store.put(
            case.id,
            DocumentKind.CT,
            "main",
            {"lps_from_ijk": volume.lps_from_ijk.tolist()},
            made_by="test",
            files=[new.stored.id],
        )
        entries = [channel.entry_in_vertebra_mm for channel in theatre.channels]
        middle = np.mean(entries, axis=0)
        landmarks = {one.name: one.point_in_vertebra_mm for one in theatre.landmarks}
        landmarks[theatre.check_landmark.name] = theatre.check_landmark.point_in_vertebra_mm
        for number, needle in enumerate(theatre.needles, start=1):
            landmarks[f"needle {number}"] = needle.tip_in_vertebra_mm
        reference = draw_reference(
            volume,
            slice_index=round(float(volume.index_from_lps(middle)[2])),
            middle_lps_mm=middle,
            apart_mm=APART_MM,
            channels=theatre.channels,
        )
        plan = PlanDocument(
            vertebrae=(
                VertebraPlan(
                    name="L3",
                    references=(reference,),
                    channels=tuple(
                        PlannedChannel(side=side, channel=channel)
                        for side, channel in zip(SIDES, theatre.channels, strict=True)
                    ),
                    landmarks=tuple(
                        Landmark(name=name, point_lps_mm=point) for name, point in landmarks.items()
                    ),
                ),
            )
        )
        store.put(
            case.id, DocumentKind.PLAN, "main", plan_to_mapping(plan), made_by="test", depends_on=[ct.id]
        )
    return theatre

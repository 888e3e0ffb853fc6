"""A case that is ready for navigation, made from the ground truth of the rehearsal."""

from pathlib import Path
from typing import Any

import numpy as np

from server.config import Config
from server.procedure.registration_record import (
    CheckRecord,
    RegistrationEvidence,
    RegistrationRecord,
    check_name,
)
from server.store import CaseStore, DocumentKind, Home
from server.theatre import theatre_from_config
from tests.procedure.real_server import BUSY_MACHINE
from tracker.plan import Landmark, PlanDocument, plan_to_mapping
from tracker.plan.document import PlannedChannel, VertebraPlan
from tracker.registration import Method, Registration
from tracker.rehearsal import Theatre

VERTEBRA = "L3"
EARLIER = "a run before"


def settings_of(*, reference: bool) -> dict[str, Any]:
    """Ground truth of a rehearsing server, with or without a patient marker."""
    return {
        **BUSY_MACHINE,
        "rehearsal": {
            "seed": 3,
            "provides_setup": False,
            "reference": reference,
            "width": 960,
            "height": 540,
            "rate_hz": 12,
        },
        "reference": {"marker": "reference" if reference else None},
    }


def prepare(home_folder: Path, config: Config) -> None:
    """Create this case in a folder and open it."""
    theatre = theatre_from_config(config.rehearsal)
    with Home(home_folder) as home, CaseStore(home) as store:
        case_id = store.create("prepared").id
        store.open(case_id)

        def put(kind: DocumentKind, name: str, content: dict[str, Any], *depends_on: str) -> str:
            return store.put(case_id, kind, name, content, made_by="test", depends_on=depends_on).id

        camera = put(DocumentKind.CAMERA, "main", {"camera": _camera(theatre)})
        tool = put(DocumentKind.TOOL, theatre.tool.name, _tool(theatre), camera)
        ct = put(DocumentKind.CT, "main", {})
        plan = put(DocumentKind.PLAN, "main", _plan(theatre), ct)
        registration = put(DocumentKind.REGISTRATION, VERTEBRA, _registration(theatre), plan, camera, tool)
        put(DocumentKind.CHECK, check_name(VERTEBRA), _check(theatre), registration)


def _camera(theatre: Theatre) -> dict[str, Any]:
    camera = theatre.camera
    return {
        "matrix": camera.matrix.tolist(),
        "distortion": camera.distortion.tolist(),
        "size_wh_px": list(camera.size_wh_px),
        "source": "rehearsal",
    }


def _tool(theatre: Theatre) -> dict[str, Any]:
    return {
        "marker": theatre.tool.marker,
        "side_mm": theatre.marker.side_mm,
        "pivot": {
            "tip_in_marker_mm": theatre.tool.marker_from_tool.translation_mm.tolist(),
            "covariance_mm2": (0.1**2 * np.eye(3)).tolist(),
            "rms_3d_mm": 0.3,
            "used": 40,
            "rejected": 0,
            "tilt_range_deg": 40.0,
            "made_at": "2026-11-21T10:00:00Z",
        },
        "axis_in_marker": [0.0, -1.0, 0.0],
        "radius_mm": 2.0,
        "length_mm": 118.0,
    }


def _plan(theatre: Theatre) -> dict[str, Any]:
    left, right = theatre.channels
    channels = (PlannedChannel(side="left", channel=left), PlannedChannel(side="right", channel=right))
    landmarks = tuple(
        Landmark(name=one.name, point_lps_mm=np.asarray(one.point_in_vertebra_mm))
        for one in (*theatre.landmarks, theatre.check_landmark)
    )
    return plan_to_mapping(
        PlanDocument(vertebrae=(VertebraPlan(name=VERTEBRA, channels=channels, landmarks=landmarks),))
    )


def _registration(theatre: Theatre) -> dict[str, Any]:
    has_reference = theatre.reference is not None
    known = (
        Registration.known_to_reference(theatre.reference_from_vertebra)
        if has_reference
        else Registration.known_to_camera(theatre.camera_from_vertebra)
    )
    registration = Registration(
        method=Method.POINTS,
        anchored_to=known.anchored_to,
        anchor_from_vertebra=known.anchor_from_vertebra,
        covariance=np.diag([0.04, 0.04, 0.04, 1e-5, 1e-5, 1e-5]),
    )
    return RegistrationRecord.of(
        registration,
        RegistrationEvidence(from_s=0.0),
        vertebra=VERTEBRA,
        reference=theatre.reference.name if theatre.reference is not None else "",
        run=EARLIER,
    ).model_dump(mode="json")


def _check(theatre: Theatre) -> dict[str, Any]:
    return CheckRecord(
        vertebra=VERTEBRA,
        landmark=theatre.check_landmark.name,
        tool=theatre.tool.name,
        distance_mm=0.3,
        max_mm=2.0,
        passed=True,
        run=EARLIER,
        from_s=0.0,
        off_lps_mm=[0.3, 0.0, 0.0],
        sd_mm=0.3,
        images=15,
    ).model_dump(mode="json")

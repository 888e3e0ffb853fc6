"""Writes samples of today's stored forms, which every later version must read; those that exist are kept.

    PYTHONPATH=. .venv/bin/python -m tests.procedure.keep_samples

home-SCHEMA            a home folder with its database as SQL, and the figures of a drill
case-VERSION.zip       the same case as an archive; from version 2 on without a damaged document
recording-FORMAT.mcap  some images of a drilling
settings-RELEASE.yaml  config.yaml of a release, kept by `make release`
"""

import json
import shutil
import sqlite3
import tempfile
from collections.abc import Mapping
from contextlib import closing
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import cv2
import numpy as np

from server.image_file import decoded
from server.recording_file.topics import FORMAT_VERSION
from server.security.audit import AuditLog
from server.security.people.file import write_people
from server.security.people.records import Invitation, Session
from server.security.people.service import PEOPLE_FILE
from server.security.person import Person, Role
from server.store import DocumentKind
from server.store.archive.schema import COMPLETE_VERSION, VERSION
from server.store.database import CURRENT_REVISION
from server.store.latency_file import LatencyFile
from server.supervision.hold_storage import HoldRequest, HoldRequestFile
from tests.procedure.conftest import Server, serving
from tests.procedure.patient import CAMERA_FROM_VERTEBRA, Patient, drill_at, ready
from tests.server.cli.test_latency_command import result
from tests.server.recording.recorded import RecordedTheatre, made_config, rendered
from tests.server.store.test_damaged_rows import damage
from tracker.geometry import Camera, Marker, Rigid
from tracker.navigation import Deviation, DrillReference
from tracker.navigation.clearance import channel_distance_field
from tracker.plan import Channel

SAMPLES = Path(__file__).parent / "samples"
DATABASE, SQL, FIGURES = "coaxial.sqlite3", "coaxial.sql", "figures.json"
# What of a home is made again.
NOT_KEPT = (f"{DATABASE}*", "*.lock", "*reserve*", "temporary", "backups")
PERSON = Person(id="1" * 16, name="Dr Sato", role=Role.SUPERVISOR, invited_by="M. Ito")
AT = datetime(2026, 11, 29, 8, 0, tzinfo=UTC)
INVITATION = Invitation(
    id="2" * 16,
    person=PERSON,
    made_by="M. Ito",
    made_at=AT,
    expires_at=AT + timedelta(hours=1),
    single_use=True,
    for_machine=False,
    session_lasts=timedelta(hours=12),
    token_sum="3" * 64,
    uses=1,
)
SESSION = Session(
    id="4" * 16,
    person=PERSON,
    invitation_id=INVITATION.id,
    started_at=AT,
    expires_at=AT + timedelta(hours=12),
    for_machine=False,
    token_sum="5" * 64,
)
HOLD = HoldRequest(person_id=PERSON.id, name=PERSON.name, at="2026-11-29T08:00:00.000Z")
SETTINGS = {"reference": {"marker": "reference"}}
CAMERA_FROM_REFERENCE: Rigid[Camera, Marker] = Rigid.from_vector([3.0, 0.1, 0.2], [60.0, 20.0, 430.0])
# 3 mm beside the axis of the channel, 5 mm below its entry.
NEAR_ENTRY = drill_at(CAMERA_FROM_VERTEBRA.move_points(np.array([17.0, 9.0, 4.0])))
IMAGES = 3


def patient_of(server: Server) -> Patient:
    """The patient with a marker, so that a registration is valid after a restart."""
    return Patient(server=server, camera_from_reference=CAMERA_FROM_REFERENCE)


def figures_of(server: Server) -> Mapping[str, float]:
    """What is shown of the drill near the entry."""
    shown = patient_of(server).show(NEAR_ENTRY).deviations["drill"]
    assert isinstance(shown, Deviation), shown
    return {
        "entry_lateral_mm": shown.entry_lateral_mm,
        "entry_cranial_mm": shown.entry_cranial_mm,
        "depth_mm": shown.depth_mm,
        "angle_deg": shown.angle_deg,
    }


def sql_of(database: Path) -> str:
    """The database as SQL, and its schema as SQLite has it."""
    with closing(sqlite3.connect(database)) as raw:
        return "\n".join(raw.iterdump()) + "\n"


def restore(sample: Path, folder: Path) -> None:
    """Make the home folder of a sample again."""
    shutil.copytree(sample, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns(SQL, FIGURES))
    with closing(sqlite3.connect(folder / DATABASE)) as raw:
        raw.executescript((sample / SQL).read_text(encoding="utf-8"))


def made_home(folder: Path) -> Mapping[str, float]:
    """Make a home with an open case that is registered, checked and logged; return the drill's figures."""
    LatencyFile(folder).put(result())
    HoldRequestFile(folder).write([HOLD])
    (folder / "security").mkdir()
    write_people(folder / "security" / PEOPLE_FILE, [INVITATION], [SESSION])
    with serving(folder, SETTINGS) as server:
        server.store.set_change_listener(AuditLog(folder / "security").record_change)
        case_id = ready(server)
        with server.store.new_file(case_id, ".npy") as new:
            np.save(new.path, np.arange(24, dtype=np.int16).reshape(2, 3, 4))
        server.store.put(case_id, DocumentKind.SURFACE, "spare", {}, made_by="test", files=[new.stored.id])
        patient = patient_of(server)
        patient.register()
        patient.check()
        return figures_of(server)


def keep_home(sample: Path) -> None:
    """Keep a home folder."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        figures = made_home(folder)
        shutil.copytree(folder, sample, ignore=shutil.ignore_patterns(*NOT_KEPT))
        (sample / SQL).write_text(sql_of(folder / DATABASE), encoding="utf-8")
    (sample / FIGURES).write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")


def keep_archive(version: int, file: Path) -> None:
    """Keep the case of the sample home as an archive."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        restore(SAMPLES / f"home-{CURRENT_REVISION}", folder)
        with serving(folder, SETTINGS) as server:
            case = server.store.get_open_case()
            assert case is not None
            if version > COMPLETE_VERSION:
                damage(server.store.home, "UPDATE documents SET content = '{}' WHERE kind = 'check'")
            archive = server.store.export_case(case.id, without_damaged=version > COMPLETE_VERSION)
            shutil.copyfile(archive.path, file)


def keep_recording(file: Path) -> None:
    """Keep a few images of a drilling, as JPEGs and with a coarse wall, so that the file is small."""
    config = made_config()
    preparation, images = rendered(config, IMAGES)
    assert preparation.setup is not None
    assert isinstance(preparation.setup.channel, Channel)
    wall = channel_distance_field(preparation.setup.channel, step_mm=2.0)
    preparation = replace(preparation, drill_reference=DrillReference(wall=wall))
    theatre = RecordedTheatre(path=file, images=images, preparation=preparation, config=config)
    theatre.begin()
    for number, image in enumerate(images):
        jpeg = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, 75])[1].tobytes()
        theatre.track(number, image=decoded(jpeg), jpeg=jpeg)
    theatre.end()


def main() -> None:
    """Keep what is missing."""
    if not (home := SAMPLES / f"home-{CURRENT_REVISION}").exists():
        keep_home(home)
    for version in range(1, VERSION + 1):
        if not (archive := SAMPLES / f"case-{version}.zip").exists():
            keep_archive(version, archive)
    if not (recording := SAMPLES / f"recording-{FORMAT_VERSION}.mcap").exists():
        keep_recording(recording)


if __name__ == "__main__":
    main()

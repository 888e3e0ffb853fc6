"""The tracking process gets what is valid in the open case, once for each change."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import cast

import numpy as np
import pytest
import structlog

from server.alarms import ProcedureFacts
from server.config import RegistrationConfig
from server.jobs import Jobs
from server.procedure.camera import MAIN_CAMERA
from server.procedure.drill_reference import DrillReferenceBuilder
from server.procedure.labels import LabelProvider
from server.procedure.markers import MarkerStep
from server.procedure.plan import ACTIVE_CHANNEL
from server.procedure.registration_record import RegistrationEvidence, RegistrationRecord
from server.procedure.setup_publisher import SetupPublisher, TrackingLink
from server.procedure.state import Procedure, SetupDefaults
from server.setup import CaseSetup
from server.store import CaseStore, Document, DocumentKind, Home
from tracker.geometry import Rigid
from tracker.navigation import AbsentReason
from tracker.plan import Channel
from tracker.plan.document import plain
from tracker.registration import AnchoredTo, Method, Registration

CAMERA = {
    "matrix": [[1400.0, 0.0, 960.0], [0.0, 1400.0, 540.0], [0.0, 0.0, 1.0]],
    "distortion": [-0.1, 0.02, 0.0, 0.0, 0.0],
    "size_wh_px": [1920, 1080],
    "source": "camera 0",
}
CHANNEL = Channel(
    name="L3 left",
    entry_in_vertebra_mm=np.array([10.0, 20.0, 30.0]),
    target_in_vertebra_mm=np.array([10.0, -20.0, 30.0]),
    radius_mm=3.0,
)
REGISTRATION = Registration(
    method=Method.POINTS,
    anchored_to=AnchoredTo.CAMERA,
    anchor_from_vertebra=Rigid(rotation=np.eye(3), translation_mm=np.array([0.0, 0.0, 500.0])),
    covariance=0.01 * np.eye(6),
)
RUN = "this run"


class Published:
    """A case, and what is published of it."""

    def __init__(self, store: CaseStore) -> None:
        self.store = store
        self.case_id = store.create("one").id
        store.open(self.case_id)
        self.setups: list[CaseSetup] = []
        self.facts: list[ProcedureFacts] = []
        defaults = SetupDefaults(source="camera 0", max_rms_px=1.0)
        publisher = SetupPublisher(
            store,
            TrackingLink(publish_setup=self.setups.append, publish_facts=self.facts.append),
            procedure=Procedure(
                store, labels=LabelProvider(store), defaults=defaults, gate=RegistrationConfig(), run=RUN
            ),
            # The cases have no bone surface, so that no job starts.
            drill_references=DrillReferenceBuilder(store=store, jobs=cast("Jobs", None)),
            defaults=defaults,
            markers=MarkerStep(store=store, defaults=()),
        )
        store.add_commit_listener(publisher.refresh)
        self.refresh = publisher.refresh

    def put(self, kind: DocumentKind, name: str, content: dict[str, object], *on: Document) -> Document:
        return self.store.put(
            self.case_id, kind, name, content, made_by="ito", depends_on=[one.id for one in on]
        )

    def put_camera(self, *, rms_px: float = 0.3, source: str = "camera 0") -> Document:
        content: dict[str, object] = {"camera": {**CAMERA, "source": source}, "report": {"rms_px": rms_px}}
        return self.put(DocumentKind.CAMERA, MAIN_CAMERA, content)

    def put_plan(self) -> Document:
        """Store a CT and a plan, and make its channel active; return the CT."""
        ct = self.put(DocumentKind.CT, "main", {})
        plan = self.put(DocumentKind.PLAN, "main", {}, ct)
        active = {"vertebra": "L3", "side": "left", "channel": plain(CHANNEL)}
        self.put(DocumentKind.PLAN, ACTIVE_CHANNEL, active, plan)
        return ct

    @property
    def newest(self) -> CaseSetup:
        return self.setups[-1]


@pytest.fixture
def published(tmp_path: Path) -> Iterator[Published]:
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        yield Published(store)


def test_a_setup_is_published_for_each_change_and_not_again(published: Published) -> None:
    camera = published.put_camera()
    count = len(published.setups)
    assert published.newest.camera is not None
    published.refresh()
    published.put(DocumentKind.COMMENT, "main", {"text": "it is late"})
    assert len(published.setups) == count
    published.store.withdraw(camera, by="ito", reason="blurred")
    assert len(published.setups) == len(published.facts) == count + 1
    assert published.newest.camera is None


def test_a_calibration_of_another_camera_is_not_published(published: Published) -> None:
    published.put_camera()
    with structlog.testing.capture_logs() as lines:
        published.put_camera(source="camera 1")
    assert published.newest.camera is None
    assert "CAMERA_DIFFERS" in [line.get("code") for line in lines]


def test_a_doubtful_calibration_is_warned_of_once(published: Published) -> None:
    with structlog.testing.capture_logs() as lines:
        published.put_camera(rms_px=2.31)
        count = len(published.setups)
        published.put_plan()
        assert len(published.setups) > count
        doubtful = [line for line in lines if line.get("code") == "CAMERA_DOUBTFUL"]
        assert len(doubtful) == 1
        published.put_camera(rms_px=2.31)
    events = [line["event"] for line in lines if line.get("code") == "CAMERA_DOUBTFUL"]
    assert ["version 1" in events[0], "version 2" in events[1], len(events)] == [True, True, 2]


def test_a_channel_is_published_with_its_ct_until_the_ct_is_replaced(published: Published) -> None:
    ct = published.put_plan()
    channel = published.newest.channel
    assert channel is not None
    assert (channel.name, published.newest.ct_id) == ("L3 left", ct.id)
    published.put(DocumentKind.CT, "main", {})
    assert (published.newest.channel, published.newest.ct_id) == (None, "")


def test_a_registration_is_published_without_numbers_until_it_is_checked(published: Published) -> None:
    published.put_plan()
    record = RegistrationRecord.of(
        REGISTRATION, RegistrationEvidence(from_s=12.5), vertebra="L3", reference="", run=RUN
    )
    document = published.put(DocumentKind.REGISTRATION, "L3", record.model_dump(mode="json"))
    assert published.newest.registration is not None
    assert published.newest.registered_from_s == 12.5
    assert published.newest.withheld is AbsentReason.NOT_CHECKED
    published.store.withdraw(document, by="ito", reason="slipped")
    after = published.newest
    assert (after.registration, after.withheld) == (None, None)


def test_with_a_damaged_calibration_no_registration_is_published(published: Published) -> None:
    camera = published.put_camera()
    published.put_plan()
    record = RegistrationRecord.of(
        REGISTRATION, RegistrationEvidence(from_s=12.5), vertebra="L3", reference="", run=RUN
    )
    published.put(DocumentKind.REGISTRATION, "L3", record.model_dump(mode="json"))
    assert published.newest.registration is not None
    # It does not depend on this camera, so that the settings' one would replace it.
    with closing(sqlite3.connect(published.store.home.database)) as raw:
        raw.execute("UPDATE documents SET checksum = 'damaged' WHERE id = ?", (camera.id,))
        raw.commit()
    published.store.close()
    published.store.open(published.store.create("other").id)
    published.store.open(published.case_id)
    assert (published.newest.camera, published.newest.registration) == (None, None)


def test_nothing_of_a_closed_case_stays_published(published: Published) -> None:
    published.put_camera()
    published.put_plan()
    published.store.close()
    assert (published.newest.camera, published.newest.channel) == (None, None)

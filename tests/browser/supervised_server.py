"""The real web server with a case that lacks only a co-signature, users without keys, and synthetic images.

Standard output gets the port on one line. Standard input selects what is published, as in `fake_server.py`.
The process ends with its standard input.

"""

import os
import socket
import sys
import tempfile
import threading
from pathlib import Path

import numpy as np
import uvicorn

from server.alarms import AlarmService, StoredAlarmLog
from server.app import AppParts, create_app
from server.config import Config
from server.jobs import Jobs
from server.live import LiveHub
from server.logs import LogSettings
from server.procedure import Steps, TrackingLink
from server.procedure.plan import ACTIVE_CHANNEL, ActiveChannel
from server.procedure.registration_record import (
    CheckRecord,
    RegistrationEvidence,
    RegistrationRecord,
    check_name,
)
from server.store import CaseStore, DocumentKind, Home
from tests.browser.fake_server import Feeder, setup
from tests.browser.made_up_ct import CT_ID
from tests.procedure.patient import CAMERA_FROM_VERTEBRA, plan_content
from tests.server.recording.no_recorder import recordings_without_process
from tests.server.recording.reviewed import DRILLED, write_drilling
from tests.server.supervision.signed_in_people import sign_people_in
from tracker.plan import plan_from_mapping
from tracker.plan.document import plain
from tracker.plan.document.changes import channel_of, vertebra_named
from tracker.registration import Registration

# A busy machine delays images, and marks need live images.
PATIENT = {"pose_stale_after_ms": 10_000, "video_stale_after_ms": 10_000, "scene_stale_after_ms": 10_000}
SUPERVISION = {"cosign": {"plan": "required"}, "drawings_fade_after_s": 600}
RECORDING = {"min_free_gb": 0.0}
# No test depends on the rate, and each image takes processor time of server and pages.
RATE_HZ = 4.0
CONFIG = Config.model_validate({"supervision": SUPERVISION, "limits": PATIENT, "recording": RECORDING})


def fill(store: CaseStore, run: str) -> None:
    """A case ready for navigation; camera and tool are the rehearsal's."""
    case = store.create("L3, rehearsal")
    store.open(case.id)
    ct = store.put(case.id, DocumentKind.CT, "main", {}, made_by="ito")
    content = plan_content("L3")
    plan = store.put(case.id, DocumentKind.PLAN, "main", content, made_by="ito", depends_on=[ct.id])
    vertebra = vertebra_named(plan_from_mapping(content), "L3")
    active = ActiveChannel(vertebra="L3", side="left", channel=channel_of(vertebra, "left").channel)
    chosen = store.put(
        case.id, DocumentKind.PLAN, ACTIVE_CHANNEL, dict(plain(active)), made_by="ito", depends_on=[plan.id]
    )
    stored = RegistrationRecord.of(
        Registration.known_to_camera(CAMERA_FROM_VERTEBRA),
        RegistrationEvidence(
            numbers={
                "points": 4,
                "fre_rms_mm": 0.41,
                "max_fre_mm": 1.5,
                "tre_at_entry_mm": 0.87,
                "max_tre_mm": 2.0,
            },
            from_s=0.0,
        ),
        vertebra="L3",
        reference="",
        run=run,
    )
    registration = store.put(
        case.id,
        DocumentKind.REGISTRATION,
        "L3",
        stored.model_dump(mode="json"),
        made_by="ito",
        depends_on=[chosen.id],
    )
    check = CheckRecord(
        vertebra="L3",
        landmark="left lamina",
        tool="drill",
        distance_mm=0.6,
        max_mm=2.0,
        passed=True,
        run=run,
        from_s=0.0,
        off_lps_mm=np.zeros(3).tolist(),
        sd_mm=0.4,
        images=20,
    )
    store.put(
        case.id,
        DocumentKind.CHECK,
        check_name("L3"),
        check.model_dump(mode="json"),
        made_by="ito",
        depends_on=[registration.id],
    )


# Begins 0.3 s later than the other recording: its breach and its hidden drill come earlier.
SECOND = DRILLED[3:]


def put_recordings(store: CaseStore) -> None:
    """Add two recordings of earlier days to the open case."""
    case = store.get_open_case()
    assert case is not None
    folder = store.home.cases / case.id / "recordings"
    folder.mkdir(parents=True)
    write_drilling(folder / "20260101T000000Z-0000.mcap")
    write_drilling(folder / "20260102T000000Z-0000.mcap", SECOND, has_setup=True)


def main() -> None:
    """Serve until standard input ends."""
    hub = LiveHub()
    door = socket.create_server(("127.0.0.1", 0), reuse_port=False)
    with (
        tempfile.TemporaryDirectory() as folder,
        Home(Path(folder) / "home") as home,
        CaseStore(home) as store,
    ):
        log = StoredAlarmLog(store)
        alarms = AlarmService(CONFIG, log=log)
        jobs = Jobs(log=LogSettings(as_json=True))
        steps = Steps.of(
            hub=hub,
            store=store,
            jobs=jobs,
            config=CONFIG,
            markers=(),
            tracking=TrackingLink(publish_setup=lambda _: None),
        )
        fill(store, steps.procedure.run)
        put_recordings(store)
        app = create_app(
            AppParts(
                hub=hub,
                config=CONFIG,
                setup=setup(),
                alarms=alarms,
                store=store,
                jobs=jobs,
                steps=steps,
                recordings=recordings_without_process(store, CONFIG, alarms),
            )
        )
        sign_people_in(app)
        server = uvicorn.Server(uvicorn.Config(app, log_level="error", lifespan="on"))
        serving = threading.Thread(target=server.run, args=([door],), name="web server", daemon=True)
        serving.start()
        feeder = Feeder(hub, alarms, rate_hz=RATE_HZ, ct_id=CT_ID)
        feeder.start()
        sys.stdout.write(f"{door.getsockname()[1]}\n")
        sys.stdout.flush()
        for line in sys.stdin:
            feeder.mode = line.strip()
        server.should_exit = True
        serving.join(10)
        jobs.close()
        log.stop()
    # The feeder may be in the middle of an image and is not joined.
    os._exit(0)


if __name__ == "__main__":
    main()

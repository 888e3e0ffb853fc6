"""Fixtures: a server with store, jobs and the set-up steps, and images published by the test."""

import dataclasses
import math
import socket
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient

from server.app import AppParts, create_app
from server.config import Config
from server.dicom_receiver import DicomReceiver
from server.jobs import Jobs
from server.live import CameraStatus, Instant, LiveHub, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.logs import LogSettings
from server.procedure import Steps, TrackingLink
from server.setup import CaseSetup, Preparation, build_setup
from server.store import CaseStore, Home
from tests.server.recording.no_recorder import recordings_without_process
from tests.shared_validators import share_validators
from tracker.navigation import Absent, AbsentReason, NavigationSnapshot, navigate
from tracker.pose import Seen, Unseen, UnseenReason
from tracker.rehearsal import Theatre

share_validators()

DEADLINE_S = 120.0
# Most conditions are a request to the server, which itself takes milliseconds of the processor.
LOOK_AGAIN_S = 0.01


@dataclass(slots=True, kw_only=True)
class Server:
    """Internals of the server, and a client of its API."""

    door: TestClient
    hub: LiveHub
    store: CaseStore
    jobs: Jobs
    preparation: Preparation
    adopted: list[CaseSetup]
    tracked_from_s: list[float]
    steps: Steps
    dicom: DicomReceiver | None = None
    number: int = field(default=0)

    def ask(self, method: str, path: str, status: int, **sent: Any) -> Any:  # noqa: ANN401  JSON
        """Return the answer, which must have this status."""
        answer = self.door.request(method, path, **sent)
        assert answer.status_code == status, answer.text
        return answer.json() if answer.content else None

    def done(self, job: dict[str, Any]) -> dict[str, Any]:
        """Wait for a job and return it."""
        self.jobs.wait_for(job["id"], timeout_s=DEADLINE_S)
        over: dict[str, Any] = self.ask("GET", f"/api/jobs/{job['id']}", 200)
        return over

    def show(
        self,
        *,
        at_s: float,
        image: np.ndarray | None = None,
        seen: Seen | None = None,
        beside: Mapping[str, Seen] | None = None,
        moved: AbsentReason | None = None,
        camera: CameraStatus | None = None,
        rate_hz: float = 0.0,
    ) -> NavigationSnapshot:
        """Publish an image, or markers seen in it, as the tracking process would; return its message."""
        self.number += 1
        preparation = self.preparation.with_case(self.adopted[-1]) if self.adopted else self.preparation
        setup = preparation.setup or preparation.setup_for((1280, 720))
        unseen = Unseen(reason=UnseenReason.NO_CANDIDATE)
        snapshot = navigate(
            setup=setup,
            sightings={"drill": seen or unseen, **(beside or {})},
            image_number=self.number,
            captured_at_s=at_s,
            size_wh_px=setup.camera.size_wh_px,
            stage_ms={},
            skipped_images=0,
        )
        if moved is not None:
            snapshot = dataclasses.replace(snapshot, vertebra=Absent(reason=moved))
        self.hub.publish(
            Instant(
                sequence=self.number,
                source=SourceStatus(
                    name="rehearsal", state=SourceState.RUNNING, rate_hz=rate_hz, camera=camera
                ),
                process=ProcessStatus(state=ProcessState.RUNNING),
                snapshot=snapshot,
                image=image,
            )
        )
        return snapshot

    def until(self, true: Callable[[], bool]) -> None:
        """Wait until this is true."""
        deadline_s = time.monotonic() + DEADLINE_S
        while not true():
            assert time.monotonic() < deadline_s, "it did not become true"
            time.sleep(LOOK_AGAIN_S)


@cache
def _prepared(config: str) -> Preparation:
    """State before the first image, cached because it takes a third of a second."""
    return build_setup(Config.model_validate_json(config))


def _receiver(config: Config, home: Home) -> DicomReceiver:
    listener = socket.create_server(("127.0.0.1", 0))
    log = LogSettings(as_json=True)
    receiver = DicomReceiver.of(config.dicom, listener, home=home.folder, certificate=None, log_settings=log)
    receiver.start()
    return receiver


def _captured_at_s(hub: LiveHub) -> float:
    """Time of the newest image, which the tests set."""
    snapshot = None if hub.newest is None else hub.newest.snapshot
    return 0.0 if snapshot is None else snapshot.captured_at_s


@contextmanager
def serving(home_folder: Path, settings: Mapping[str, object] | None = None) -> Iterator[Server]:
    """All parts of a server with this home folder."""
    # Few images per capture, to save half a second per landmark.
    few = {"rehearsal": {"provides_setup": False}, "registration": {"capture_images": 4, "capture_s": 0.06}}
    config = Config.model_validate({**few, **(settings or {})})
    hub, adopted, tracked_from_s = LiveHub(), list[CaseSetup](), [-math.inf]
    jobs = Jobs(log=LogSettings(as_json=True))
    preparation = _prepared(config.model_dump_json())
    with Home(home_folder) as home, CaseStore(home) as store:
        steps = Steps.of(
            hub=hub,
            store=store,
            jobs=jobs,
            config=config,
            markers=preparation.models,
            tracking=TrackingLink(
                publish_setup=adopted.append,
                tracked_from_s=lambda: tracked_from_s[-1],
                age_clock=lambda: _captured_at_s(hub),
            ),
        )
        recordings = recordings_without_process(store, config)
        dicom = _receiver(config, home) if config.dicom.receive.port is not None else None
        app = create_app(
            AppParts(
                hub=hub,
                config=config,
                store=store,
                jobs=jobs,
                steps=steps,
                recordings=recordings,
                dicom=dicom,
            )
        )
        with TestClient(app, base_url="http://127.0.0.1:8000", raise_server_exceptions=False) as door:
            yield Server(
                door=door,
                hub=hub,
                store=store,
                jobs=jobs,
                preparation=preparation,
                adopted=adopted,
                tracked_from_s=tracked_from_s,
                steps=steps,
                dicom=dicom,
            )
        if dicom is not None:
            dicom.stop()
        jobs.close()


@pytest.fixture
def turns() -> Iterator[ExitStack]:
    """Holds the running server."""
    with ExitStack() as stack:
        yield stack


@pytest.fixture
def server(tmp_path: Path, turns: ExitStack) -> Server:
    return turns.enter_context(serving(tmp_path / "home"))


@pytest.fixture
def restarted(tmp_path: Path, turns: ExitStack) -> Callable[[], Server]:
    """Restarts the server with the same folder."""

    def restart() -> Server:
        turns.close()
        return turns.enter_context(serving(tmp_path / "home"))

    return restart


def sighting(theatre: Theatre, at_s: float, random: np.random.Generator) -> Seen:
    """Poses of the drill's marker from a good tracker: the truth with a hundredth of the noise."""
    truth = theatre.truth_at(at_s)
    sd = np.array([0.02, 0.02, 0.1, 0.001, 0.001, 0.0004])
    noise = random.normal(0.0, sd)
    pose = truth.camera_from_marker
    return Seen(
        camera_from_marker=pose.displaced(noise),
        pose_covariance=np.diag(sd**2),
        corners_px=truth.corners_px,
        score_ratio=0.95,
        target_score_ratio=0.9,
        model_coverage_ratio=0.95,
        target_coverage_ratio=0.9,
        fit_error_px2=0.1,
        found_by="track",
    )

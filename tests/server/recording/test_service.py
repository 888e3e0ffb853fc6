"""Recordings of the open case: when they start and stop, and which actions are allowed."""

from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

import pytest

from server.alarms import AlarmService, ProcedureFacts
from server.config import Config, RecordingConfig
from server.errors import RecordingError, SetupOrderError
from server.live import Problem
from server.logs import LogSettings
from server.recording.consent import ConsentState
from server.recording.process import RecordingStatus
from server.recording.recorder import Recorder
from server.recording.service import RecordingService
from server.recording_file import Topic
from server.store import CaseStore, Change, DocumentKind, NotFound, StoreConflict
from server.store.home import Home
from tests.server.recording.no_recorder import NoImages, NoRecorder
from tracker.navigation.alarms import Condition, Presence

FULL = Problem(code="RECORDING_DISK_FULL", message="the disk is full", remedy="Free it.")


class Theatre:
    """A store with a case, alarms and recordings."""

    def __init__(self, store: CaseStore, settings: RecordingConfig) -> None:
        self.store = store
        config = Config(recording=settings)
        self.alarms = AlarmService(config)
        self.recorders: list[NoRecorder] = []
        self.service = RecordingService(
            tracked=NoImages(),
            alarms=self.alarms,
            store=store,
            config=config,
            log_settings=LogSettings(as_json=True),
            product_version="0",
            make_recorder=self._make,
        )

    def _make(self, *given: object, **named: object) -> Recorder:
        self.recorders.append(NoRecorder(*given, **named))  # pyrefly: ignore[bad-argument-type]
        return self.recorders[-1]

    def open_a_case(self) -> str:
        case = self.store.create("L4")
        self.store.open(case.id)
        return case.id

    def navigate(self, *, on: bool) -> None:
        self.alarms.set_facts(ProcedureFacts(navigating=on))
        self.service.poll()

    @property
    def conditions(self) -> set[Condition]:
        """Alarms in sight; one that is over stays until it is acknowledged."""
        alarms = self.alarms.picture.alarms
        return {one.condition for one in alarms if one.presence is Presence.YES}


@pytest.fixture
def store(tmp_path: Path) -> Iterator[CaseStore]:
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        yield store


def made(store: CaseStore, **settings: object) -> Theatre:
    return Theatre(
        store, RecordingConfig.model_validate({"min_free_gb": 0.0, "consent": "not_required", **settings})
    )


def test_a_recording_is_a_file_of_the_open_case_until_it_is_stopped(store: CaseStore) -> None:
    theatre = made(store)
    with pytest.raises(SetupOrderError, match="no case is open"):
        theatre.service.start()
    case_id = theatre.open_a_case()
    state = theatre.service.start()
    assert theatre.recorders[0].path.parent == store.home.cases / case_id / "recordings"
    assert theatre.service.start().name == state.name
    (running,) = theatre.service.list()
    assert (running.name, running.is_running, running.size_bytes) == (state.name, True, 8)
    with pytest.raises(StoreConflict):
        store.delete(case_id, confirm="L4")
    stopped = theatre.service.stop()
    assert stopped.name == ""
    assert stopped.status is not None
    assert stopped.status.is_ended
    assert not theatre.service.list()[0].is_running
    assert len(theatre.recorders) == 1


def test_only_an_unprotected_recording_that_has_ended_is_deleted(store: CaseStore) -> None:
    theatre = made(store)
    theatre.open_a_case()
    name = theatre.service.start().name
    with pytest.raises(RecordingError, match="is being written"):
        theatre.service.delete(name)
    theatre.service.stop()
    theatre.service.protect(name, is_protected=True)
    assert theatre.service.list()[0].is_protected
    with pytest.raises(RecordingError, match="is protected"):
        theatre.service.delete(name)
    theatre.service.protect(name, is_protected=False)
    theatre.service.delete(name)
    assert theatre.service.list() == []
    for other in (name, "../../coaxial.sqlite3", "..", ""):
        with pytest.raises(NotFound):
            theatre.service.path(other)


def test_rotation_deletes_the_oldest_unprotected_recordings_of_all_cases(store: CaseStore) -> None:
    theatre = made(store, rotate=True, max_total_gb=1e-6)
    theatre.open_a_case()
    case = store.get_open_case()
    assert case is not None
    names = [f"2026010{day}T000000Z-0000.mcap" for day in (1, 2, 3, 4)]
    folders = [store.home.cases / one / "recordings" for one in (case.id, store.create("another").id)]
    for number, name in enumerate(names):
        folders[number % 2].mkdir(parents=True, exist_ok=True)
        (folders[number % 2] / name).write_bytes(b"x" * 300)
    theatre.service.protect(names[0], is_protected=True)
    changes: list[Change] = []
    store.set_change_listener(changes.append)
    theatre.service.start()
    assert [(one.kind, one.name) for one in changes] == [("rotation", name) for name in names[1:3]]
    left = {path.name for folder in folders for path in folder.glob("2026010*.mcap")}
    # The second and the third are the oldest without protection; 0.8 kB may stay.
    assert left == {names[0], names[3]}


def test_a_clock_that_was_set_back_does_not_make_the_newest_recording_the_oldest(
    store: CaseStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    theatre = made(store, rotate=True, max_total_gb=1e-6)
    folder = store.home.cases / theatre.open_a_case() / "recordings"
    folder.mkdir(parents=True)
    # Of a version that did not number them.
    (folder / "20260301T000000Z-0000.mcap").write_bytes(b"x" * 300)
    for month in (12, 1, 6):
        now = datetime(2026, month, 1, tzinfo=UTC)
        monkeypatch.setattr("server.recording.service.utc_now", lambda now=now: now)
        name = theatre.service.start().name
        theatre.service.stop()
        (folder / name).write_bytes(b"x" * 300)
    # The one without a number had to make room, and not the one of January.
    assert [one.name[:15] for one in theatre.service.list()] == [
        "20261201T000000",
        "20260101T000000",
        "20260601T000000",
    ]


def test_rotation_deletes_nothing_where_protected_recordings_take_the_budget(store: CaseStore) -> None:
    theatre = made(store, rotate=True, max_total_gb=1e-6)
    theatre.open_a_case()
    case = store.get_open_case()
    assert case is not None
    folder = store.home.cases / case.id / "recordings"
    folder.mkdir(parents=True)
    names = [f"2026010{day}T000000Z-0000.mcap" for day in (1, 2)]
    for name, size in zip(names, (850, 100), strict=True):
        (folder / name).write_bytes(b"x" * size)
    theatre.service.protect(names[0], is_protected=True)
    theatre.service.start()
    assert all((folder / name).exists() for name in names)


def test_without_rotation_a_used_up_budget_rejects_a_recording(store: CaseStore) -> None:
    theatre = made(store, max_total_gb=1e-6)
    theatre.open_a_case()
    case = store.get_open_case()
    assert case is not None
    folder = store.home.cases / case.id / "recordings"
    folder.mkdir(parents=True)
    (folder / "20260101T000000Z-0000.mcap").write_bytes(b"x" * 1001)
    with pytest.raises(RecordingError, match="have reached"):
        theatre.service.start()
    assert (folder / "20260101T000000Z-0000.mcap").exists()


def test_a_recording_that_cannot_go_on_raises_an_alarm_until_it_is_stopped(store: CaseStore) -> None:
    theatre = made(store)
    theatre.open_a_case()
    theatre.service.start()
    theatre.navigate(on=True)
    assert Condition.RECORDING_STOPPED not in theatre.conditions
    theatre.recorders[0].fail(FULL)
    theatre.service.poll()
    assert Condition.RECORDING_STOPPED in theatre.conditions
    state = theatre.service.state
    assert (state.name, state.problem) == ("", FULL)
    theatre.service.start()
    assert Condition.RECORDING_STOPPED not in theatre.conditions
    assert theatre.service.state.problem is None


def test_a_recording_follows_navigation_where_the_settings_say_so(store: CaseStore) -> None:
    theatre = made(store, when="navigating")
    theatre.open_a_case()
    theatre.navigate(on=False)
    assert theatre.recorders == []
    theatre.navigate(on=True)
    theatre.service.poll()
    assert len(theatre.recorders) == 1
    theatre.navigate(on=False)
    assert theatre.recorders[0].reason == "navigation ended"
    theatre.navigate(on=True)
    theatre.service.stop()
    theatre.service.poll()
    # Stopped by a user: it does not start before the next navigation.
    assert len(theatre.recorders) == 2
    assert theatre.service.state.name == ""


def test_a_recording_ends_with_its_case(store: CaseStore) -> None:
    theatre = made(store)
    theatre.open_a_case()
    theatre.service.start()
    store.close()
    theatre.service.poll()
    assert theatre.recorders[0].reason == "its case was closed"


@pytest.mark.parametrize(
    ("settings", "code"),
    [
        ({"when": "never"}, "RECORDING_SWITCHED_OFF"),
        ({"max_total_gb": 1e-9}, "RECORDING_BUDGET_EXCEEDED"),
        ({"min_free_gb": 100_000.0}, "RECORDING_DISK_FULL"),
    ],
)
def test_what_forbids_a_recording_is_said(store: CaseStore, settings: dict[str, object], code: str) -> None:
    theatre = made(store, **settings)
    case_id = theatre.open_a_case()
    folder = store.home.cases / case_id / "recordings"
    folder.mkdir(parents=True)
    (folder / "20260101T000000Z-0000.mcap").write_bytes(b"an older one")
    with pytest.raises(RecordingError) as rejected:
        theatre.service.start()
    assert rejected.value.code == code


def test_documents_in_use_are_recorded_with_their_hash_and_again_when_they_change(store: CaseStore) -> None:
    theatre = made(store)
    case_id = theatre.open_a_case()
    store.put(case_id, DocumentKind.TOOL, "drill", {"tip": 1}, made_by="Anna")
    store.put(case_id, DocumentKind.PATIENT, "patient", {"name": "Erika Muster"}, made_by="Anna")
    theatre.service.start()
    theatre.service.poll()
    store.put(case_id, DocumentKind.TOOL, "drill", {"tip": 2}, made_by="Anna")
    theatre.service.poll()
    theatre.service.put_mark('{"by": "Ben"}')
    texts = theatre.recorders[0].texts
    assert [topic for topic, _ in texts] == [Topic.DOCUMENTS, Topic.DOCUMENTS, Topic.MARKS]
    assert '"tip":2' in texts[1][1]
    assert not any("Muster" in text for _, text in texts)


def test_without_consent_nothing_is_recorded_by_hand_or_by_itself(store: CaseStore) -> None:
    theatre = made(store, consent="required", when="navigating")
    case_id = theatre.open_a_case()
    assert theatre.service.consent.state is ConsentState.NOT_ANSWERED
    for is_given in (None, False):
        if is_given is not None:
            theatre.service.answer_consent(case_id, is_given=is_given, made_by="Anna")
        with pytest.raises(SetupOrderError) as rejected:
            theatre.service.start()
        assert rejected.value.code == "RECORDING_CONSENT_MISSING"
        theatre.navigate(on=True)
        # An operation without consent is no failure.
        assert Condition.RECORDING_STOPPED not in theatre.conditions
        assert theatre.recorders == []
    theatre.service.answer_consent(case_id, is_given=True, made_by="Ben")
    assert theatre.service.consent.answered_by == "Ben"
    theatre.service.poll()
    assert len(theatre.recorders) == 1


def test_consent_that_is_taken_back_ends_the_recording(store: CaseStore) -> None:
    theatre = made(store, consent="required")
    case_id = theatre.open_a_case()
    theatre.service.answer_consent(case_id, is_given=True, made_by="Anna")
    theatre.service.start()
    theatre.service.answer_consent(case_id, is_given=False, made_by="Ben")
    assert theatre.recorders[0].reason == "the patient does not consent to recordings"
    theatre.service.answer_consent(case_id, is_given=True, made_by="Anna")
    theatre.service.start()
    (document,) = store.all(case_id, DocumentKind.CONSENT)
    store.withdraw(document, by="Ben", reason="the patient changed his mind")
    theatre.service.poll()
    assert theatre.recorders[1].reason == "the consent to it was withdrawn"


def test_consent_is_of_one_case(store: CaseStore) -> None:
    theatre = made(store, consent="required")
    first = theatre.open_a_case()
    theatre.service.answer_consent(first, is_given=True, made_by="Anna")
    theatre.open_a_case()
    assert theatre.service.consent.state is ConsentState.NOT_ANSWERED
    with pytest.raises(SetupOrderError, match="another case"):
        theatre.service.answer_consent(first, is_given=True, made_by="Anna")


def test_a_recording_is_neither_read_nor_deleted_before_its_file_is_closed(
    store: CaseStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    theatre = made(store, when="manual")
    theatre.open_a_case()
    name = theatre.service.start().name
    stop = NoRecorder.stop
    codes: list[str] = []

    def stop_slowly(recorder: NoRecorder, reason: str = "") -> RecordingStatus:
        for act in (theatre.service.ended_path, theatre.service.delete):
            with pytest.raises(RecordingError) as caught:
                act(name)
            codes.append(caught.value.code)
        return stop(recorder, reason)

    monkeypatch.setattr(NoRecorder, "stop", stop_slowly)
    theatre.service.stop()
    assert codes == ["RECORDING_RUNS"] * 2
    assert theatre.service.ended_path(name).is_file()

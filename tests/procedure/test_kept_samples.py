"""Every stored form of a release is read by this version; a new form has a number and a sample of its own."""

import json
import re
import sqlite3
import zipfile
from collections import Counter
from contextlib import closing
from pathlib import Path
from typing import cast

import pytest

from server.clock import utc_now
from server.config_file import fate_of_key, load_config
from server.errors import ConfigError
from server.recording.messages import SessionMessage, TrackedMessage
from server.recording.replay import check_recording
from server.recording_file import RecordingReader, Topic
from server.recording_file.codec import Json
from server.recording_file.topics import FORMAT_VERSION
from server.security.audit import AuditLog, mark_lost_changes
from server.security.people.file import read_people
from server.security.people.service import PEOPLE_FILE
from server.store import CaseStore, Home
from server.store.archive.schema import VERSION
from server.store.database import CURRENT_REVISION, open_database
from server.store.latency_file import LatencyFile
from server.stream.messages import SnapshotMessage
from server.supervision.hold_storage import HoldRequestFile
from tests.procedure.conftest import serving
from tests.procedure.keep_samples import (
    DATABASE,
    FIGURES,
    HOLD,
    INVITATION,
    SAMPLES,
    SESSION,
    SETTINGS,
    SQL,
    figures_of,
    patient_of,
    restore,
)
from tests.procedure.patient import states
from tests.server.cli.test_latency_command import result

ROOT = Path(__file__).parents[2]
FIRST_REVISION = 3
HOMES = [SAMPLES / f"home-{number}" for number in range(FIRST_REVISION, int(CURRENT_REVISION) + 1)]
ARCHIVES = [SAMPLES / f"case-{number}.zip" for number in range(1, VERSION + 1)]
KEEP = (
    "A released form never changes. Give the new one the next number, and keep its sample: "
    "PYTHONPATH=. .venv/bin/python -m tests.procedure.keep_samples"
)


def definitions(sql: str) -> list[str]:
    """The statements of a dump that make tables, indexes and triggers."""
    words = " ".join(sql.split())
    return sorted(re.findall(r"CREATE .+?(?=; (?:CREATE|INSERT|DELETE|COMMIT))", words))


def test_each_number_has_its_sample() -> None:
    needed = [*HOMES, *ARCHIVES, SAMPLES / f"recording-{FORMAT_VERSION}.mcap"]
    assert [one.name for one in needed if not one.exists()] == [], KEEP


def test_the_schema_of_the_database_is_that_of_its_sample(tmp_path: Path) -> None:
    with Home(tmp_path) as home:
        open_database(home, now=utc_now).dispose()
        with closing(sqlite3.connect(home.database)) as raw:
            made = "\n".join(raw.iterdump())
    assert definitions(made) == definitions((HOMES[-1] / SQL).read_text(encoding="utf-8")), KEEP


@pytest.mark.parametrize("sample", HOMES, ids=lambda path: path.name)
def test_a_kept_home_opens_with_intact_documents_and_log_and_shows_the_same_figures(
    sample: Path, tmp_path: Path
) -> None:
    restore(sample, tmp_path)
    with closing(sqlite3.connect(tmp_path / DATABASE)) as raw:
        (count,) = raw.execute("SELECT count(*) FROM documents").fetchone()
    assert LatencyFile(tmp_path).results() == (result(),)
    assert HoldRequestFile(tmp_path).read() == (HOLD,)
    assert read_people(tmp_path / "security" / PEOPLE_FILE) == ([INVITATION], [SESSION])
    with serving(tmp_path, SETTINGS) as server:
        audit = AuditLog(tmp_path / "security")
        assert audit.verify().fault is None
        assert audit.head.count > count
        assert mark_lost_changes(server.store, audit) == 0
        case = server.store.get_open_case()
        assert case is not None
        entries = server.store.outline(case.id)
        assert len(entries) == count
        assert not any(one.heading.is_damaged for one in entries)
        assert all(server.store.is_current(one.heading) for one in entries)
        assert server.store.verify(case.id) == ()
        patient_of(server).show(None)
        needed = server.ask("GET", "/api/procedure", 200)["confirmation"]["registration_id"]
        server.ask("POST", "/api/procedure/confirmation", 200, json={"registration_id": needed})
        # The check on anatomy is as old as the sample.
        assert {step for step, state in states(server).items() if state != "done"} <= {"check"}
        kept = json.loads((sample / FIGURES).read_text(encoding="utf-8"))
        assert figures_of(server) == pytest.approx(kept, abs=1e-6)


def keys(content: Json) -> Json:
    """The keys of the JSON objects of a document or part, without its values."""
    if isinstance(content, list):
        return [keys(one) for one in content]
    return {key: keys(value) for key, value in content.items()} if isinstance(content, dict) else None


def keys_of_archive(file: Path) -> Json:
    with zipfile.ZipFile(file) as archive:
        texts = {name: archive.read(name).decode() for name in archive.namelist() if ".json" in name}
    return {
        name: [keys(json.loads(one)) for one in (text.splitlines() if name.endswith("l") else [text])]
        for name, text in texts.items()
    }


@pytest.mark.parametrize("sample", ARCHIVES, ids=lambda path: path.name)
def test_a_kept_archive_is_imported_completely_and_written_in_the_same_form(
    sample: Path, tmp_path: Path
) -> None:
    with zipfile.ZipFile(sample) as archive:
        documents = archive.read("documents.jsonl").count(b"\n")
        manifest = json.loads(archive.read("manifest.json"))
    missing = len(manifest.get("missing", {"documents": ()})["documents"])
    with Home(tmp_path) as home, CaseStore(home) as store:
        case = store.import_archive(sample, by="M. Ito")
        headings = [one.heading for one in store.outline(case.id)]
        assert sum(not one.is_damaged for one in headings) == documents
        assert sum(one.is_damaged for one in headings) == missing
        again = store.export_case(case.id, without_damaged=missing > 0)
        assert keys_of_archive(again.path) == keys_of_archive(sample), KEEP


@pytest.mark.parametrize("sample", sorted(SAMPLES.glob("recording-*.mcap")), ids=lambda path: path.name)
def test_a_kept_recording_is_read_without_losing_a_value(sample: Path) -> None:
    forms = {Topic.SESSION: SessionMessage, Topic.TRACKED: TrackedMessage, Topic.SNAPSHOT: SnapshotMessage}
    reader, read_messages = RecordingReader(sample), Counter[Topic]()
    for message in reader.messages():
        if message.topic in forms:
            recorded = message.json()
            read = forms[message.topic].model_validate(recorded).model_dump(mode="json")
            assert without_new_keys(read, recorded) == recorded
            read_messages[message.topic] += 1
        if message.topic is Topic.IMAGE:
            assert message.image is not None
            read_messages[message.topic] += 1
    assert reader.is_whole
    assert read_messages == {Topic.SESSION: 1, Topic.TRACKED: 3, Topic.SNAPSHOT: 3, Topic.IMAGE: 3}
    # Equal results are promised for the version that recorded it only.
    report = check_recording(sample)
    assert report.images + report.unchecked_images == 3


def without_new_keys(read: Json, recorded: Json) -> Json:
    if isinstance(read, list) and isinstance(recorded, list) and len(read) == len(recorded):
        return [without_new_keys(*pair) for pair in zip(read, recorded, strict=True)]
    if isinstance(read, dict) and isinstance(recorded, dict):
        return {key: without_new_keys(read[key], recorded[key]) for key in recorded if key in read}
    return read


def test_settings_of_each_release_are_read_or_refused_by_the_name_of_their_successor() -> None:
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    for version in re.findall(r"^## \[(\d.*)\]", changelog, re.MULTILINE):
        unread = mistakes_in(SAMPLES / f"settings-{version}.yaml")
        assert {key: why for key, why in unread.items() if fate_of_key(key) is None} == {}, (
            "FORMER_KEYS in server/config_file.py must say what became of each key"
        )


def mistakes_in(settings: Path) -> Json:
    """What is not read, by its key."""
    try:
        load_config(settings, environment={})
    except ConfigError as error:
        return {one["key"]: one["message"] for one in cast("list[Json]", error.context["mistakes"])}
    return {}

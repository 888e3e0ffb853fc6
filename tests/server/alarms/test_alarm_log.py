"""The alarm log: append-only, and on disk when it is reported as logged."""

import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from server.alarms.entries import Entry
from server.alarms.log import FILE_NAME, StoredAlarmLog, append_lines, lines_of
from server.store import CaseStore, DocumentKind, Home, StoreError

CHECKOUT = Path(__file__).resolve().parents[3]


def entry(number: int, by: str = "") -> Entry:
    return Entry(line={"number": number, "change": "raised", "value": float(number)}, by=by)


@pytest.fixture
def store(tmp_path: Path) -> Iterator[CaseStore]:
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        yield store


@pytest.fixture
def log(store: CaseStore) -> Iterator[StoredAlarmLog]:
    log = StoredAlarmLog(store)
    yield log
    log.stop()


def numbers(log: StoredAlarmLog, count: int = 100) -> list[object]:
    return [line["number"] for line in log.newest(count)]


def test_without_a_case_it_is_a_file_of_the_home(store: CaseStore, log: StoredAlarmLog) -> None:
    for number in range(5):
        log.append([entry(number)])
    log.flush()
    assert numbers(log) == [0, 1, 2, 3, 4]
    assert numbers(log, 2) == [3, 4]
    assert len((store.home.folder / FILE_NAME).read_text(encoding="utf-8").splitlines()) == 5


def test_with_a_case_it_belongs_to_the_case_and_names_the_person(
    store: CaseStore, log: StoredAlarmLog
) -> None:
    log.append([entry(1)])
    log.flush()
    case = store.open(store.create("L3").id)
    log.append([entry(2, by="M. Ito")])
    log.flush()
    log.append([entry(3)])
    log.flush()
    assert numbers(log) == [2, 3]
    documents = store.history(case.id, DocumentKind.ALARM, "log")
    assert [document.made_by for document in documents] == ["M. Ito", "Coaxial"]
    store.close()
    assert numbers(log) == [1], "of the time without a case"


def test_lines_that_came_in_with_an_archive_say_so_of_who_did_what(
    store: CaseStore, log: StoredAlarmLog
) -> None:
    first = store.open(store.create("L3").id)
    log.append([Entry(line={"by": "Dr Sato", "change": "acknowledged"}, by="Dr Sato"), entry(1)])
    log.flush()
    taken = store.import_archive(store.export_case(first.id).path, by="M. Ito")
    store.open(taken.id)
    log.append([Entry(line={"by": "Dr Sato", "change": "acknowledged"}, by="Dr Sato")])
    log.flush()
    assert [line.get("by") for line in log.newest(10)] == ["Dr Sato, says the archive", None, "Dr Sato"]


@pytest.mark.parametrize("name", ["\u202eDr. Ito", "\u200b"])
def test_a_name_that_the_store_does_not_take_holds_no_alarm_up(
    store: CaseStore, log: StoredAlarmLog, name: str
) -> None:
    case = store.open(store.create("L3").id)
    log.append([entry(1, by=name)])
    log.flush()
    log.append([entry(2, by="M. Ito")])
    log.flush()
    assert numbers(log) == [1, 2]
    documents = store.history(case.id, DocumentKind.ALARM, "log")
    assert [document.made_by for document in documents] == ["Coaxial", "M. Ito"]


def test_what_has_no_word_in_json_is_null(store: CaseStore, log: StoredAlarmLog) -> None:
    store.open(store.create("L3").id)
    log.append([Entry(line={"number": 1, "value": float("inf"), "limit": float("nan")}, by="")])
    log.flush()
    assert log.newest(1) == [{"number": 1, "value": None, "limit": None}]


def test_a_line_that_was_cut_spoils_no_other(tmp_path: Path) -> None:
    file = tmp_path / "alarms.jsonl"
    append_lines(file, [{"number": 1}])
    with file.open("ab") as cut:
        cut.write(b'{"number": 2, "cond')
    append_lines(file, [{"number": 3}])
    assert lines_of(file) == [{"number": 1}, {"number": 3}]
    assert lines_of(tmp_path / "none.jsonl") == []


def test_a_disk_that_fails_is_reported_and_written_when_it_is_back(
    log: StoredAlarmLog, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken = [True]

    def append(file: Path, lines: list[object]) -> None:
        if broken[0]:
            raise OSError(28, "No space left on device")
        file.write_text("".join(json.dumps(line) + "\n" for line in lines), encoding="utf-8")

    monkeypatch.setattr("server.alarms.log.append_lines", append)
    monkeypatch.setattr("server.alarms.log.TRY_AGAIN_S", 0.01)
    log.append([entry(1)])
    with pytest.raises(StoreError) as rejected:
        log.flush()
    assert rejected.value.code == "STORE_FULL"
    assert not log.is_well
    broken[0] = False
    with log._changed:
        assert log._changed.wait_for(lambda: log.is_well, 60.0)
    assert numbers(log) == [1]


KILLED = """
import os, signal, sys
from pathlib import Path
from server.alarms.entries import Entry
from server.alarms.log import StoredAlarmLog
from server.store import CaseStore, Home
home = Home(Path(sys.argv[1]))
store = CaseStore(home)
if sys.argv[2] == "case":
    store.open(store.create("L3").id)
log = StoredAlarmLog(store)
for number in range(7):
    log.append([Entry(line={"number": number}, by="M. Ito")])
    log.flush()
os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.parametrize("place", ["case", "home"])
def test_what_was_flushed_outlasts_a_kill(tmp_path: Path, place: str) -> None:
    folder = tmp_path / "home"
    ended = subprocess.run(
        [sys.executable, "-c", KILLED, str(folder), place], cwd=CHECKOUT, check=False, env={"PYTHONPATH": "."}
    )
    assert ended.returncode == -signal.SIGKILL
    with Home(folder) as home, CaseStore(home) as store:
        log = StoredAlarmLog(store)
        assert numbers(log) == list(range(7))
        log.stop()

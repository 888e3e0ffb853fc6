"""The audit log: every modification is detected, and a crash or a full disk leaves it intact."""

import errno
import json
import os
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner

from server.cli.commands import app
from server.security.audit import AuditLog, Entry, Verdict, collect_changes, note, verification, verify
from server.security.person import LOCAL_USER
from server.store import Change, StoreError
from tests.server.security.guarded_app import Clock

LINES = 6


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "security"


@pytest.fixture
def log(folder: Path) -> AuditLog:
    written = AuditLog(folder, clock=Clock().now)
    for number in range(LINES):
        written.append(Entry(who=LOCAL_USER, what=f"POST /api/thing/{number}", status=200))
    return written


def changed(lines: list[bytes]) -> list[bytes]:
    return [line.replace(b"thing/2", b"thing/9") for line in lines]


def shorter(lines: list[bytes]) -> list[bytes]:
    return [*lines[:2], *lines[3:]]


def swapped(lines: list[bytes]) -> list[bytes]:
    return [*lines[:1], lines[2], lines[1], *lines[3:]]


@pytest.mark.parametrize(
    ("hurt", "line"),
    [
        pytest.param(changed, 3, id="a line is changed"),
        pytest.param(shorter, 3, id="a line is missing"),
        pytest.param(swapped, 2, id="two lines are swapped"),
        pytest.param(lambda lines: lines[1:], 1, id="the beginning is missing"),
        pytest.param(lambda lines: lines[:-2], 5, id="the end is missing"),
        pytest.param(lambda _: [], 1, id="all is missing"),
        pytest.param(
            lambda lines: [*lines[:-1], lines[-1].replace(b"200", b"201")], 6, id="the last is changed"
        ),
        pytest.param(lambda lines: [*lines, lines[-1]], 7, id="one is there twice"),
        pytest.param(lambda lines: [*lines[:2], b"nonsense", *lines[3:]], 3, id="one is no line any more"),
        pytest.param(lambda lines: [*lines[:2], b"", *lines[2:]], 3, id="an empty line is put in"),
    ],
)
def test_every_change_is_found_with_the_number_of_its_line(
    log: AuditLog,
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    hurt: Callable[[list[bytes]], list[bytes]],
    line: int,
) -> None:
    monkeypatch.setenv("COAXIAL_HOME", str(folder.parent))
    whole = CliRunner().invoke(app, ["audit", "verify"])
    assert whole.exit_code == 0
    assert f"{LINES} lines, unchanged" in whole.output
    lines = hurt(log.file.read_bytes().splitlines())
    log.file.write_bytes(b"".join(one + b"\n" for one in lines))
    found = CliRunner().invoke(app, ["audit", "verify"])
    assert found.exit_code == 1
    assert found.output.startswith(f"Line {line}: ")
    fault = log.verify().fault
    assert fault is not None
    assert fault.line == line


def test_a_start_does_not_cover_what_somebody_took_away(log: AuditLog, folder: Path) -> None:
    log.file.write_bytes(b"".join(one + b"\n" for one in log.file.read_bytes().splitlines()[:-2]))
    for _ in range(2):
        again = AuditLog(folder, clock=Clock().now)
        again.append(Entry(who=LOCAL_USER, what="after"))
        fault = again.verify().fault
        assert fault is not None
        assert fault.line == 5
    assert again.file.read_bytes().count(b"AUDIT_BROKEN") == 1


@pytest.mark.parametrize("rest", ["the lines", "nothing"])
def test_without_its_end_beside_it_a_log_is_not_called_whole(
    log: AuditLog, folder: Path, monkeypatch: pytest.MonkeyPatch, rest: str
) -> None:
    monkeypatch.setenv("COAXIAL_HOME", str(folder.parent))
    if rest == "nothing":
        log.file.write_bytes(b"")
        (folder / "audit-head.json").unlink()
    else:
        (folder / "audit-head.json").write_text("{")
    found = CliRunner().invoke(app, ["audit", "verify"])
    assert found.exit_code == 1
    assert "where the log ended is not known" in found.output


def test_a_reader_does_not_wait_for_a_writer(log: AuditLog) -> None:
    with log._lock:
        requested = threading.Thread(
            target=lambda: reported.extend(
                [
                    log.is_writable,
                    log.head.count,
                    log.verify().fault,
                    len(log.newest(3)),
                    log.complete_lines().count(b"\n"),
                ]
            ),
            daemon=True,
        )
        reported: list[object] = []
        requested.start()
        requested.join(20.0)
        assert reported == [True, LINES, None, 3, LINES]


def test_what_was_verified_is_not_read_again_unless_it_was_changed(
    log: AuditLog, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: list[int] = []

    def counting(lines: list[bytes], *, after: Verdict) -> Verdict:
        read.append(len(lines))
        return verify(lines, after=after)

    log.verify()
    monkeypatch.setattr(verification, "verify", counting)
    log.append(Entry(who=LOCAL_USER, what="one more"))
    assert log.verify().head.count == LINES + 1
    log.verify()
    assert read == [1, 0]
    log.file.write_bytes(log.complete_lines().replace(b"thing/2", b"thing/9"))
    assert [fault.line for fault in [log.verify().fault] if fault] == [3]


def test_an_exported_log_is_verified_by_itself_and_against_its_last_sum(
    log: AuditLog, tmp_path: Path
) -> None:
    exported = tmp_path / "taken-along.jsonl"
    exported.write_bytes(log.complete_lines())
    requested = ["audit", "verify", str(exported), "--sum", log.head.sum]
    assert CliRunner().invoke(app, requested).exit_code == 0
    exported.write_bytes(b"".join(one + b"\n" for one in log.complete_lines().splitlines()[:-1]))
    assert CliRunner().invoke(app, requested[:3]).exit_code == 0
    assert CliRunner().invoke(app, requested).exit_code == 1
    assert CliRunner().invoke(app, ["audit", "verify", str(tmp_path / "none")]).exit_code == 2


@pytest.mark.parametrize("cut", [1, 10, 60])
def test_a_line_that_a_crash_cut_is_taken_away_and_reported(log: AuditLog, folder: Path, cut: int) -> None:
    whole = log.file.read_bytes()
    # The next line was begun but its head never stored.
    log.file.write_bytes(whole + whole.splitlines()[-1][:cut])
    again = AuditLog(folder, clock=Clock().now)
    assert again.verify().fault is None
    reported = json.loads(again.newest(1)[0])
    assert reported["changes"] == [
        {"what": "audit log", "said": "the last line was truncated by a crash", "bytes": cut}
    ]


def test_a_line_whose_end_was_not_kept_beside_it_is_taken_as_it_is(log: AuditLog, folder: Path) -> None:
    head = (folder / "audit-head.json").read_bytes()
    log.append(Entry(who=LOCAL_USER, what="before the crash"))
    (folder / "audit-head.json").write_bytes(head)
    again = AuditLog(folder, clock=Clock().now)
    again.append(Entry(who=LOCAL_USER, what="after"))
    assert again.verify().fault is None
    assert again.head.count == LINES + 2


def test_a_full_disk_spends_the_reserve_first_and_then_keeps_what_waits(
    log: AuditLog, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    full = ["the disk"]
    write = os.write

    def writing(descriptor: int, content: bytes) -> int:
        if full:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(descriptor, content)

    monkeypatch.setattr(os, "write", writing)
    with pytest.raises(StoreError) as reported:
        log.append(Entry(who=LOCAL_USER, what="first"))
    assert reported.value.code == "STORE_FULL"
    assert [log.is_writable] == [False]
    assert not (folder / "audit-reserve").exists()
    with pytest.raises(StoreError):
        log.catch_up()
    assert log.verify().fault is None
    full.clear()
    log.append(Entry(who=LOCAL_USER, what="second"))
    assert [log.is_writable] == [True]
    assert [json.loads(line)["what"] for line in log.newest(2)] == ["first", "second"]
    assert log.verify().fault is None
    assert (folder / "audit-reserve").exists()


def test_a_line_that_the_disk_takes_in_many_parts_is_whole(
    log: AuditLog, monkeypatch: pytest.MonkeyPatch
) -> None:
    write = os.write
    monkeypatch.setattr(os, "write", lambda descriptor, content: write(descriptor, bytes(content)[:7]))
    log.append(Entry(who=LOCAL_USER, what="in parts"))
    assert json.loads(log.newest(1)[0])["what"] == "in parts"
    assert log.verify().fault is None


def test_half_a_letter_is_written_as_its_number_and_holds_nothing_up(log: AuditLog) -> None:
    log.append(Entry(who=LOCAL_USER, what="half \ud800 letter"))
    log.append(Entry(who=LOCAL_USER, what="after"))
    assert json.loads(log.newest(2)[0])["what"] == r"half \ud800 letter"
    assert log.verify().fault is None


def test_rejections_are_written_so_often_and_no_more(log: AuditLog) -> None:
    for _ in range(200):
        log.append_rejection(Entry(who=LOCAL_USER, what="POST /api/session", status=403))
    assert log.head.count == LINES + 60
    assert b"more requests were rejected" in log.newest(1)[0]


def test_what_is_changed_is_noted_in_its_request_and_else_has_a_line_of_its_own(log: AuditLog) -> None:
    change = Change(case_id="a", kind="plan", name="L3", before=3, after=4, by="Ito")
    with collect_changes() as changes:
        log.record_change(change)
    assert changes == [{"what": "plan", "case_id": "a", "name": "L3", "by": "Ito", "from": 3, "to": 4}]
    assert log.head.count == LINES
    log.record_change(change)
    assert json.loads(log.newest(1)[0])["changes"] == changes
    assert not note({"nobody": "listens"})
    # Patient data, and alarms, which have their own log.
    log.record_change(Change(case_id="a", kind="patient", name="Doe", before=None, after=1))
    log.record_change(Change(case_id="a", kind="alarm", name="log", before=1, after=2))
    assert log.head.count == LINES + 2
    assert b"Doe" not in log.complete_lines()


def test_a_page_back_in_the_log_ends_before_the_number_requested(log: AuditLog) -> None:
    assert [json.loads(line)["number"] for line in log.newest(2, before=4)] == [2, 3]
    assert log.newest(5, before=1) == []

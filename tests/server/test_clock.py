"""The clock that nobody can set."""

import json
from datetime import UTC, datetime, timedelta
from pathlib import Path

from server.clock import AgeClock, SteadyClock, elapsed_s
from server.security import AuditLog, PeopleService, Role
from server.security.audit import Entry
from server.security.people.service import NewInvitation
from server.security.person import SERVER


class ComputerClock:
    """The wall clock of a computer, and the time since its start."""

    def __init__(self) -> None:
        self.wall = datetime(2026, 11, 21, 8, tzinfo=UTC)
        self.elapsed_s = 100.0

    def steady(self) -> SteadyClock:
        return SteadyClock(wall=lambda: self.wall, elapsed_s=lambda: self.elapsed_s)

    def passes(self, gone: timedelta) -> None:
        self.wall += gone
        self.elapsed_s += gone.total_seconds()


def test_a_steady_clock_advances_by_elapsed_time_alone() -> None:
    computer = ComputerClock()
    steady = computer.steady()
    computer.passes(timedelta(minutes=5))
    computer.wall -= timedelta(hours=1)
    assert steady() == datetime(2026, 11, 21, 8, 5, tzinfo=UTC)
    computer.wall += timedelta(days=400)
    assert steady() == datetime(2026, 11, 21, 8, 5, tzinfo=UTC)
    assert elapsed_s() <= elapsed_s()


def test_the_clock_of_ages_is_that_of_images_and_counts_sleep() -> None:
    computer = ComputerClock()
    awake_s = 7.0
    ages = AgeClock(images_s=lambda: awake_s, elapsed_s=lambda: computer.elapsed_s)
    assert ages() == awake_s
    computer.passes(timedelta(hours=2))
    assert ages() == awake_s + 7200.0


def test_a_session_lasts_its_hours_while_the_clock_is_set(tmp_path: Path) -> None:
    computer = ComputerClock()
    people = PeopleService(
        tmp_path,
        audit=AuditLog(tmp_path, clock=lambda: computer.wall),
        session_lasts=timedelta(hours=12),
        clock=computer.steady(),
        seconds=lambda: computer.elapsed_s,
    )
    invited = NewInvitation(name="M. Ito", role=Role.OPERATOR, lasts=timedelta(hours=1))
    session, _ = people.sign_in(people.invite(invited, by="test")[1].text, address="here")
    for step in (timedelta(hours=13), -timedelta(hours=26)):
        computer.wall += step
        assert people.is_valid(session.id)
    computer.passes(timedelta(hours=12))
    assert not people.is_valid(session.id)


def test_the_audit_log_keeps_its_order_and_its_chain_while_the_clock_is_set(tmp_path: Path) -> None:
    computer = ComputerClock()
    audit = AuditLog(tmp_path, clock=lambda: computer.wall)
    for number in range(3):
        audit.append(Entry(who=SERVER, what=f"{number}"))
        computer.wall -= timedelta(hours=1)
    assert [json.loads(line)["what"] for line in audit.newest(3)] == ["0", "1", "2"]
    assert audit.verify().fault is None

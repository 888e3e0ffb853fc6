"""Index of a recording: positions of its images, figures as columns, and events.

A job computes it once and stores it beside the recording, so that any instant is found without a search.
"""

import json
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field, fields
from itertools import pairwise
from pathlib import Path
from typing import IO, Any, Literal, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt
from pydantic import TypeAdapter

from server.alarms.evaluation import AlarmCall
from server.numpy_file import BAD_NUMPY_FILE
from server.recording.drilling_course import DrillingCourse, DrillingCourses
from server.recording_file import Packing, Topic, rejecting_other_content
from server.recording_file.locations import Location, MessageLocations, read_content
from server.recording_file.reader import parsed_json
from tracker.navigation import Status
from tracker.navigation.alarms import AlarmState, Change

# Incremented by each change of the format; an index of another version is computed again.
VERSION = 4
SUFFIX = ".index.npz"
FIGURES = ("entry", "angle", "depth", "wall", "risk")
STATUSES = tuple(Status)
PACKINGS = tuple(Packing)
# Repeated losses of images, as on a machine that is too slow, are merged into one event.
MAX_NOTE_GAP_S = 5.0
# Notes after which images may have another setup.
STATE_ENDS = ("STATE_MISSING", "PROCESS_CHANGED")
# Figures withheld for a shorter time are a gap in the curves but not an event.
MIN_WITHHELD_S = 0.3

Floats: TypeAlias = npt.NDArray[np.float64]
Integers: TypeAlias = npt.NDArray[np.int64]
EventKind: TypeAlias = Literal["navigation", "withheld", "alarm", "acknowledgement", "mark", "step", "note"]
Report: TypeAlias = Callable[[float, str], None]
Json: TypeAlias = Any
Stored = TypeVar("Stored", "RecordingIndex", "RecordingSummary")


@dataclass(frozen=True, slots=True, kw_only=True)
class TimelineEvent:
    """An event or a period of a recording.

    Attributes:
        kind: navigation (it was on), withheld (no figures), alarm, acknowledgement, mark, step (a new
            document of the case), note (on the recording itself).
        from_s, to_s: Time since the first image; to_s is None for an event without duration.
        code: Condition of an alarm, reason of withheld figures, code of a note, shape of a mark, kind of a
            document.
        by: Person who caused it; empty if nobody did.
    """

    kind: EventKind
    from_s: float
    to_s: float | None = None
    code: str = ""
    by: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingIndex:
    """A recording of n images as columns.

    Attributes:
        begin_unix_s: Time of the first image.
        is_whole: Whether the file is complete.
        events: Events in the order of their start.
        courses: Course of each drilling.
        at_s: (n,) time since the first image.
        images, snapshots, alarms: (n, 2) offset and length; length 0 if absent.
        packings: (n,) index in `PACKINGS`.
        sizes_px: (n, 2) width, height.
        values, limits: (n, 5) values and limits of `FIGURES`, in mm, degrees or %; NaN if absent.
        statuses: (n, 5) index in `STATUSES`; -1 if absent.
        states, documents: (m, 3) first image to which a tracking state or the documents in use apply, offset
            and length; length 0 from the image on whose state is unknown.
    """

    begin_unix_s: float
    is_whole: bool
    events: tuple[TimelineEvent, ...]
    courses: tuple[DrillingCourse, ...]
    at_s: Floats
    images: Integers
    snapshots: Integers
    alarms: Integers
    packings: Integers
    sizes_px: Integers
    values: Floats
    limits: Floats
    statuses: Integers
    states: Integers
    documents: Integers

    def __len__(self) -> int:
        return len(self.at_s)


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingSummary:
    """What the report needs of a recording.

    Attributes:
        begin_unix_s: Time of the first image.
        is_whole: Whether the file is complete.
        courses: Course of each drilling.
    """

    begin_unix_s: float
    is_whole: bool
    courses: tuple[DrillingCourse, ...]


COURSE = TypeAdapter(DrillingCourse)
COLUMNS = tuple(one.name for one in fields(RecordingIndex))[4:]


def index_path(recording: Path) -> Path:
    """Return the path of the index of a recording."""
    return recording.with_name(recording.name + SUFFIX)


def store_index(report: Report, *, recording: str) -> dict[str, int]:
    """Job: compute the index of a recording and store it beside the recording."""
    path = Path(recording)
    index = make_index(path, report)
    about = {
        "version": VERSION,
        "file": _fingerprint(path),
        "begin_unix_s": index.begin_unix_s,
        "is_whole": index.is_whole,
        "events": [{one.name: getattr(event, one.name) for one in fields(event)} for event in index.events],
        "courses": [asdict(course) for course in index.courses],
    }
    target = index_path(path)
    unfinished = target.with_name(f"{target.name}.{os.getpid()}")
    try:
        with unfinished.open("wb") as file:
            text = np.frombuffer(json.dumps(about).encode(), dtype=np.uint8)
            np.savez(file, about=text, **{name: getattr(index, name) for name in COLUMNS})
        unfinished.replace(target)
    finally:
        unfinished.unlink(missing_ok=True)
    return {"images": len(index)}


def stored_index(recording: Path) -> RecordingIndex | None:
    """Return the stored index of a recording; None without an index of this file and version."""
    return _stored(
        recording,
        lambda about, columns: RecordingIndex(
            begin_unix_s=about["begin_unix_s"],
            is_whole=about["is_whole"],
            events=tuple(TimelineEvent(**one) for one in about["events"]),
            courses=_courses(about),
            **{name: columns[name] for name in COLUMNS},
        ),
    )


def stored_summary(recording: Path) -> RecordingSummary | None:
    """Return the drillings of the stored index, without reading its columns; None as for `stored_index`."""
    return _stored(
        recording,
        lambda about, _: RecordingSummary(
            begin_unix_s=about["begin_unix_s"], is_whole=about["is_whole"], courses=_courses(about)
        ),
    )


def _stored(recording: Path, make: Callable[[Json, Mapping[str, npt.NDArray[Any]]], Stored]) -> Stored | None:
    """Return what is made from the stored index, whose columns are read when they are used."""
    try:
        # Opened here, because NumPy leaves a damaged archive open.
        with index_path(recording).open("rb") as file, np.load(file, allow_pickle=False) as stored:
            about = _current(stored["about"], recording)
            return None if about is None else make(about, stored)
    except BAD_NUMPY_FILE:
        return None


def _current(about: npt.NDArray[np.uint8], recording: Path) -> Json | None:
    """Return the description of a stored index; None if it is of another version or file."""
    found = json.loads(about.tobytes())
    return found if found["version"] == VERSION and found["file"] == _fingerprint(recording) else None


def _courses(about: Json) -> tuple[DrillingCourse, ...]:
    return tuple(COURSE.validate_python(one) for one in about["courses"])


def make_index(path: Path, report: Report = lambda _ratio, _doing: None) -> RecordingIndex:
    """Compute the index of a recording, up to the end of an incomplete file.

    Raises:
        RecordingError: RECORDING_NOT_READABLE.
    """
    locations, rows, events = MessageLocations(path), _Rows(), _Events()
    with rejecting_other_content(path), path.open("rb") as file:
        for location in locations:
            match location.topic:
                case Topic.IMAGE:
                    rows.image = location
                    report(locations.position / max(1, locations.size_bytes), "reading the recording")
                case Topic.SNAPSHOT:
                    rows.add(location, _json(file, location))
                case Topic.ALARMS:
                    rows.alarms.append(location)
                case Topic.ALARM_STEP:
                    events.add_step(location.unix_s, _json(file, location))
                case Topic.MARKS:
                    events.add_mark(location.unix_s, _json(file, location))
                case Topic.NOTE:
                    note = _json(file, location)
                    events.add_note(location.unix_s, note)
                    if note.get("code") in STATE_ENDS:
                        rows.states.append((len(rows.pairs), 0, 0))
                case Topic.STATE:
                    rows.states.append((len(rows.pairs), location.offset, location.length))
                case Topic.DOCUMENTS:
                    rows.documents.append((len(rows.pairs), location.offset, location.length))
                    events.add_documents(location.unix_s, _json(file, location))
                case _:  # only a replay reads these
                    pass
        return rows.index(events, is_whole=locations.is_whole)


def _json(file: IO[bytes], location: Location) -> Json:
    """Return a message; an empty mapping if it is damaged."""
    try:
        content = parsed_json(read_content(file, location.offset, location.length))
    except (ValueError, RecursionError):
        return {}
    return content if isinstance(content, dict) else {}


@dataclass(slots=True)
class _Rows:
    """Columns under construction, with a row for each image that has a result."""

    image: Location | None = None
    alarms: list[Location] = field(default_factory=list)
    pairs: list[tuple[Location, Location]] = field(default_factory=list)
    values: list[list[float]] = field(default_factory=list)
    limits: list[list[float]] = field(default_factory=list)
    statuses: list[list[int]] = field(default_factory=list)
    reasons: list[str] = field(default_factory=list)
    courses: DrillingCourses = field(default_factory=DrillingCourses)
    states: list[tuple[int, int, int]] = field(default_factory=list)
    documents: list[tuple[int, int, int]] = field(default_factory=list)

    def add(self, snapshot: Location, content: Json) -> None:
        image = self.image
        if image is None or image.sequence != snapshot.sequence or "tools" not in content:
            return
        self.image = None
        assessment = _displayed_assessment(content)
        figures = assessment.get("figures", {})
        self.pairs.append((image, snapshot))
        self.courses.add(image.unix_s, content)
        self.reasons.append(assessment.get("reason", ""))
        self.values.append([_number(figures.get(name, {}).get("value")) for name in FIGURES])
        self.limits.append([_number(figures.get(name, {}).get("limit")) for name in FIGURES])
        self.statuses.append([_status(figures.get(name, {}).get("status")) for name in FIGURES])

    def index(self, events: "_Events", *, is_whole: bool) -> RecordingIndex:
        count = len(self.pairs)
        unix_s = np.array([image.unix_s for image, _ in self.pairs], dtype=np.float64)
        begin_s = float(unix_s[0]) if count else 0.0
        at_s = unix_s - begin_s
        end_s = float(at_s[-1]) if count else 0.0
        found = [*events.events(begin_s, end_s), *_withheld(at_s, self.reasons)]
        return RecordingIndex(
            begin_unix_s=begin_s,
            is_whole=is_whole,
            events=tuple(sorted(found, key=lambda event: event.from_s)),
            courses=self.courses.courses(),
            at_s=at_s,
            images=_places(image for image, _ in self.pairs),
            snapshots=_places(snapshot for _, snapshot in self.pairs),
            alarms=self._alarms_of(unix_s),
            packings=np.array(
                [PACKINGS.index(image.packing) for image, _ in self.pairs if image.packing is not None],
                dtype=np.int64,
            ),
            sizes_px=np.array([image.size_wh_px for image, _ in self.pairs], dtype=np.int64).reshape(-1, 2),
            values=np.array(self.values, dtype=np.float64).reshape(-1, len(FIGURES)),
            limits=np.array(self.limits, dtype=np.float64).reshape(-1, len(FIGURES)),
            statuses=np.array(self.statuses, dtype=np.int64).reshape(-1, len(FIGURES)),
            states=np.array(self.states, dtype=np.int64).reshape(-1, 3),
            documents=np.array(self.documents, dtype=np.int64).reshape(-1, 3),
        )

    def _alarms_of(self, unix_s: Floats) -> Integers:
        """Return the position of the alarms of each image: the newest before the next image."""
        if not self.alarms:
            return np.zeros((len(unix_s), 2), dtype=np.int64)
        places = np.vstack([np.zeros((1, 2), dtype=np.int64), _places(self.alarms)])
        changed_s = np.array([one.unix_s for one in self.alarms])
        next_s = np.append(unix_s[1:], np.inf)
        return places[np.searchsorted(changed_s, next_s, side="left")]


class _Events:
    """Events from alarm steps, marks and notes."""

    def __init__(self) -> None:
        self._moments: list[TimelineEvent] = []
        self._navigation: list[tuple[float, bool]] = []
        self._open: dict[int, tuple[float, str]] = {}
        self._alarms: list[tuple[float, float | None, str]] = []
        self._last_note_s: dict[str, float] = {}
        self._document_ids: set[str] | None = None
        self._has_steps = False

    def add_step(self, unix_s: float, step: Json) -> None:
        navigating = step.get("circumstances", {}).get("navigating")
        if navigating is not None and (not self._navigation or self._navigation[-1][1] != navigating):
            self._navigation.append((unix_s, navigating))
        if not self._has_steps:
            self._has_steps = True
            # Raised before the start of the recording.
            active = [one for one in step.get("alarms", []) if one.get("state") != AlarmState.LATCHED]
            self._open = {one["number"]: (unix_s, one["condition"]) for one in active}
        for event in step.get("events", []):
            number, change = event.get("number"), event.get("change")
            if number is None:
                continue
            if change == Change.RAISED:
                self._open[number] = (unix_s, event.get("condition") or "")
            elif change in (Change.CLEARED, Change.LATCHED) and number in self._open:
                begin_s, code = self._open.pop(number)
                self._alarms.append((begin_s, unix_s, code))
            if change == Change.ACKNOWLEDGED and step.get("call") == AlarmCall.ACKNOWLEDGE:
                self._moments.append(
                    TimelineEvent(
                        kind="acknowledgement",
                        from_s=unix_s,
                        code=event.get("condition") or "",
                        by=event.get("by") or "",
                    )
                )

    def add_mark(self, unix_s: float, mark: Json) -> None:
        drawn = mark.get("draw")
        if isinstance(drawn, Mapping):
            self._moments.append(
                TimelineEvent(
                    kind="mark", from_s=unix_s, code=str(drawn.get("shape", "")), by=str(mark.get("by", ""))
                )
            )

    def add_documents(self, unix_s: float, content: Json) -> None:
        """Add a step for each document that was not in use before; those at the start are none."""
        documents = [one for one in content.get("documents", []) if "id" in one]
        known = self._document_ids
        self._document_ids = {one["id"] for one in documents} | (known or set())
        if known is not None:
            self._moments += [
                TimelineEvent(
                    kind="step",
                    from_s=unix_s,
                    code=str(one.get("kind", "")),
                    by=str(one.get("made_by", "")),
                )
                for one in documents
                if one["id"] not in known
            ]

    def add_note(self, unix_s: float, note: Json) -> None:
        code = str(note.get("code", ""))
        before_s = self._last_note_s.get(code)
        self._last_note_s[code] = unix_s
        if before_s is None or unix_s - before_s > MAX_NOTE_GAP_S:
            self._moments.append(TimelineEvent(kind="note", from_s=unix_s, code=code))

    def events(self, begin_s: float, end_s: float) -> Iterable[TimelineEvent]:
        """Yield the events in seconds since `begin_s`; events in progress end at `end_s`."""
        for one in self._moments:
            yield TimelineEvent(kind=one.kind, from_s=one.from_s - begin_s, code=one.code, by=one.by)
        open_alarms = [(at_s, None, code) for at_s, code in self._open.values()]
        for from_s, to_s, code in [*self._alarms, *open_alarms]:
            yield TimelineEvent(
                kind="alarm",
                from_s=from_s - begin_s,
                to_s=end_s if to_s is None else to_s - begin_s,
                code=code,
            )
        for (from_s, is_on), (to_s, _) in pairwise([*self._navigation, (begin_s + end_s, False)]):
            if is_on:
                yield TimelineEvent(kind="navigation", from_s=from_s - begin_s, to_s=to_s - begin_s)


def _withheld(at_s: Floats, reasons: list[str]) -> Iterable[TimelineEvent]:
    begin = 0
    for place in range(1, len(reasons) + 1):
        if place < len(reasons) and reasons[place] == reasons[begin]:
            continue
        end_s = float(at_s[min(place, len(reasons) - 1)])
        if reasons[begin] and end_s - at_s[begin] >= MIN_WITHHELD_S:
            yield TimelineEvent(kind="withheld", from_s=float(at_s[begin]), to_s=end_s, code=reasons[begin])
        begin = place


def _displayed_assessment(snapshot: Json) -> Mapping[str, Any]:
    """Return the assessment of the displayed tool, otherwise that of the first tool, with its reason."""
    tools = snapshot["tools"]
    shown = [one for one in tools if one.get("name") == snapshot.get("displayed_tool")] or tools
    return shown[0].get("assessment", {}) if shown else {}


def _places(locations: Iterable[Location]) -> Integers:
    return np.array([(one.offset, one.length) for one in locations], dtype=np.int64).reshape(-1, 2)


def _number(value: object) -> float:
    return float(value) if isinstance(value, int | float) else np.nan


def _status(value: str | None) -> int:
    return STATUSES.index(Status(value)) if value in STATUSES else -1


def _fingerprint(path: Path) -> list[int]:
    found = path.stat()
    return [found.st_size, found.st_mtime_ns]

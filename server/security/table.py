"""Who may do what: the one table. What is not in it is refused to everybody.

A test compares it with the addresses that the application itself gives: a new one that is not put here does
not get in, neither into the table nor to anybody.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from server.security.person import Role

EVERYBODY = frozenset(Role)
WATCHERS = EVERYBODY - {Role.CAMERA}
OVERSEERS = frozenset({Role.OPERATOR, Role.SUPERVISOR})
THEATRE = frozenset({Role.OPERATOR, Role.SCREEN})
OPERATORS = frozenset({Role.OPERATOR})
CAMERAS = frozenset({Role.OPERATOR, Role.CAMERA})

SOCKET = "WS"

# Open to who is not signed in, too. Beside these: the page's own files, which hold nothing of a patient.
PUBLIC = """
GET     /health
POST    /api/session
"""

# Who one is oneself.
OWN = """
GET     /api/session
DELETE  /api/session
"""

# What is live.
SEEN_BY_WATCHERS = """
GET     /api/dashboard
GET     /api/live
GET     /api/alarms
GET     /api/alarms/sound/{priority}.wav
GET     /api/procedure
GET     /api/latency
GET     /video/{camera}.mjpg
GET     /api/supervision/room
GET     /api/supervision/signatures
WS      /ws/room
WS      /ws/live
WS      /ws/view
GET     /scene
GET     /scene/
WS      /scene
WS      /scene/
"""

# Everything that can be looked at; the documentation tells more of the server than a viewer needs.
SEEN_BY_OVERSEERS = """
GET     /metrics
GET     /api/docs
GET     /api/openapi.json
GET     /api/people
GET     /api/audit
GET     /api/audit/export
GET     /api/alarms/log
GET     /api/rehearsal
GET     /api/rehearsal/ct
GET     /api/cases
GET     /api/cases/{case_id}
GET     /api/cases/{case_id}/documents
GET     /api/cases/{case_id}/documents/{document_id}
GET     /api/cases/{case_id}/files
GET     /api/cases/{case_id}/files/{file_id}
GET     /api/cases/{case_id}/archive
GET     /api/jobs
GET     /api/jobs/{job_id}
GET     /api/gates
GET     /api/camera
GET     /api/camera/collection
GET     /api/camera/calibration
GET     /api/camera/readout
GET     /api/camera/readout/collection
GET     /api/latency/measurement
GET     /api/markers
GET     /api/markers/{name}/picture
GET     /api/tools
GET     /api/tools/collection
GET     /api/ct
GET     /api/ct/uploads/{upload_id}/preview.png
GET     /api/ct/slices/{plane}.png
GET     /api/ct/slices/{plane}
GET     /api/ct/oblique.png
GET     /api/ct/oblique
GET     /api/plan
GET     /api/plan/catalogue
GET     /api/plan/export
GET     /api/plan/proposals/screw
GET     /api/plan/proposals/slice
GET     /api/plan/vertebrae/{name}/reference.png
GET     /api/registration
GET     /api/registration/points
GET     /api/registration/running
GET     /api/registration/check
GET     /api/registration/nudges
GET     /api/registration/sweep
GET     /api/registration/needles/overlay.jpg
GET     /api/surface
GET     /api/surface.ply
"""

# People in theatre stand before the screen: they quiet it with a touch.
DONE_IN_THEATRE = """
POST    /api/alarms/acknowledgement
POST    /api/alarms/pause
POST    /api/alarms/resumption
POST    /api/alarms/screens
"""

# A colleague far away asks to hold, takes that back, and signs what was checked. Nothing moves by it.
DONE_BY_OVERSEERS = """
POST    /api/alarms/hold
POST    /api/alarms/release
POST    /api/supervision/signatures
DELETE  /api/supervision/signatures/{signature_id}
"""

DONE_BY_OPERATORS = """
POST    /api/people/invitations
DELETE  /api/people/invitations/{invitation_id}
DELETE  /api/people/sessions/{session_id}
PUT     /api/rehearsal
POST    /api/procedure/confirmation
POST    /api/cases
POST    /api/cases/archive
PATCH   /api/cases/{case_id}
POST    /api/cases/{case_id}/open
POST    /api/cases/{case_id}/close
POST    /api/cases/{case_id}/deletion
POST    /api/cases/{case_id}/documents/{document_id}/withdrawal
POST    /api/cases/{case_id}/verification
DELETE  /api/jobs/{job_id}
POST    /api/camera/collection
DELETE  /api/camera/collection
POST    /api/camera/collection/images
POST    /api/camera/calibration
POST    /api/camera/accuracy
POST    /api/camera/board
PUT     /api/camera/readout
POST    /api/camera/readout/collection
DELETE  /api/camera/readout/collection
POST    /api/camera/readout/measurement
POST    /api/latency/measurement
DELETE  /api/latency/measurement
POST    /api/latency/measurement/conclusion
POST    /api/markers
DELETE  /api/markers/{name}
POST    /api/tools/collection
DELETE  /api/tools/collection
POST    /api/tools/collection/conclusion
POST    /api/ct
POST    /api/ct/uploads/{upload_id}/series/{series}
POST    /api/ct/probe
PUT     /api/plan
POST    /api/plan/import
POST    /api/plan/vertebrae
DELETE  /api/plan/vertebrae/{name}
POST    /api/plan/vertebrae/{name}/pedicles/{side}
PUT     /api/plan/vertebrae/{name}/pedicles/{side}/corrections
PUT     /api/plan/vertebrae/{name}/channels/{side}
DELETE  /api/plan/vertebrae/{name}/channels/{side}
PUT     /api/plan/vertebrae/{name}/channels/{side}/screw
DELETE  /api/plan/vertebrae/{name}/channels/{side}/screw
PUT     /api/plan/vertebrae/{name}/reference
PUT     /api/plan/vertebrae/{name}/landmarks
POST    /api/plan/active-channel
DELETE  /api/plan/active-channel
POST    /api/registration/points
DELETE  /api/registration/points
POST    /api/registration/points/captures
DELETE  /api/registration/points/captures
PUT     /api/registration/points/use
POST    /api/registration/points/conclusion
POST    /api/registration/check
DELETE  /api/registration/check
POST    /api/registration/check/conclusion
POST    /api/registration/nudges
DELETE  /api/registration/nudges/last
PUT     /api/registration/sweep
POST    /api/registration/sweep
DELETE  /api/registration/sweep
POST    /api/registration/sweep/fit
POST    /api/registration/sweep/conclusion
POST    /api/registration/needles/proposal
POST    /api/registration/needles/overlay
POST    /api/registration/needles/conclusion
POST    /api/surface/from-ct
POST    /api/surface
"""

# A device that is invited as a camera can do this alone.
SENT_BY_CAMERAS = """
WS      /ws/camera
"""

# Nothing that a person does: a page says every two seconds that it is there. The alarm log has what changes.
UNWRITTEN = "POST    /api/alarms/screens"
# Nothing is changed, but a patient's pictures leave the server.
WRITTEN = """
GET     /api/cases/{case_id}/archive
GET     /api/audit/export
"""
# Done even when it cannot be written down: alarms, and what makes room on a full disk.
URGENT = """
POST    /api/session
DELETE  /api/session
DELETE  /api/people/sessions/{session_id}
DELETE  /api/people/invitations/{invitation_id}
POST    /api/alarms/acknowledgement
POST    /api/alarms/pause
POST    /api/alarms/resumption
POST    /api/alarms/screens
POST    /api/alarms/hold
POST    /api/alarms/release
POST    /api/cases/{case_id}/deletion
DELETE  /api/registration/points
DELETE  /api/registration/check
"""
# Answered even when it could not be written: without the answer nobody is in who could make room.
ANSWERED = "POST    /api/session"
# Goes on until somebody ends it, so it ends with its session.
LASTING = "GET     /video/{camera}.mjpg"


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """Who may do one thing.

    Attributes:
        method: of HTTP, or `SOCKET`.
        template: the path, with names in braces for parts without a slash.
        roles: who may; everybody who is signed in for `EVERYBODY`.
        is_public: who is not signed in may, too.
        is_written: into the audit log.
        is_urgent: done even when it cannot be written.
        is_answered: with its own answer even when it could not be written.
        lasts: it goes on until somebody ends it.
    """

    method: str
    template: str
    roles: frozenset[Role]
    is_public: bool = False
    is_written: bool = False
    is_urgent: bool = False
    is_answered: bool = False
    lasts: bool = False

    @property
    def name(self) -> str:
        """As it is written into the audit log: "POST /api/cases"."""
        return f"{self.method} {self.template}"


def _keys(lines: str) -> list[tuple[str, str]]:
    return [(method, path) for method, path in (line.split() for line in lines.strip().splitlines())]


def _rules() -> Iterable[Rule]:
    written, unwritten, urgent, answered, lasting = map(
        _keys, (WRITTEN, UNWRITTEN, URGENT, ANSWERED, LASTING)
    )
    for lines, roles in (
        (PUBLIC, EVERYBODY),
        (OWN, EVERYBODY),
        (SEEN_BY_WATCHERS, WATCHERS),
        (SEEN_BY_OVERSEERS, OVERSEERS),
        (DONE_IN_THEATRE, THEATRE),
        (DONE_BY_OVERSEERS, OVERSEERS),
        (DONE_BY_OPERATORS, OPERATORS),
        (SENT_BY_CAMERAS, CAMERAS),
    ):
        for key in _keys(lines):
            changes = key[0] not in {"GET", SOCKET}
            yield Rule(
                method=key[0],
                template=key[1],
                roles=roles,
                is_public=lines is PUBLIC,
                is_written=(changes and key not in unwritten) or key in written,
                is_urgent=key in urgent,
                is_answered=key in answered,
                lasts=key[0] == SOCKET or key in lasting,
            )


TABLE: tuple[Rule, ...] = tuple(_rules())


def _pattern(template: str) -> "re.Pattern[str]":
    parts = re.split(r"(\{[a-z_]+\})", template)
    return re.compile(
        "".join(f"(?P<{part[1:-1]}>[^/]+)" if part.startswith("{") else re.escape(part) for part in parts)
    )


_PATTERNS = tuple((_pattern(rule.template), rule) for rule in TABLE)


def rules_of(method: str, path: str) -> tuple[list[tuple[Rule, Mapping[str, str]]], bool]:
    """Every rule that may be meant by this, and whether the path is known with any method at all.

    Where an address fits two templates, what is allowed by both is allowed: which one the application takes
    is its business. `HEAD` is a `GET` without its body.
    """
    method = "GET" if method == "HEAD" else method
    found: list[tuple[Rule, Mapping[str, str]]] = [
        (rule, match.groupdict()) for pattern, rule in _PATTERNS if (match := pattern.fullmatch(path))
    ]
    fitting = [one for one in found if one[0].method == method]
    # The one with fewer open parts is the one that the application means, as far as names go.
    fitting.sort(key=lambda one: len(one[1]))
    return fitting, bool(found)

"""The table of permissions. Routes that are not in it are denied to everybody.

A test compares it with the routes of the application: a new route must be added here.
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

# Open without sign-in, like the page's own files, which contain no patient data.
PUBLIC = """
GET     /health
POST    /api/session
"""

# The own session.
OWN = """
GET     /api/session
DELETE  /api/session
"""

# Live data.
SEEN_BY_WATCHERS = """
GET     /api/dashboard
GET     /api/live
GET     /api/alarms
GET     /api/alarms/sound/{priority}.wav
GET     /api/procedure
GET     /api/navigation/ct
GET     /api/navigation/placements
GET     /api/latency
GET     /api/certificates
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

# Of the hub, which restricts each to the theatres that the account sees (`server/api/hub.py`).
SEEN_AT_THE_HUB = """
GET     /api/theatres
GET     /api/theatres/{theatre}/picture
GET     /at/{theatre}/api/dashboard
GET     /at/{theatre}/api/live
WS      /at/{theatre}/ws/live
WS      /at/{theatre}/ws/view
"""

# All read access; the documentation reveals more of the server than a viewer needs.
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
GET     /api/recordings
GET     /api/recordings/state
GET     /api/recordings/drillings
GET     /api/recordings/{name}/file
GET     /api/recordings/{name}/export/{table}.csv
GET     /api/recordings/{name}/timeline
GET     /api/recordings/{name}/nearest
GET     /api/recordings/{name}/images/{number}.jpg
GET     /api/recordings/{name}/instants/{number}
GET     /scene/review/{key}/
WS      /scene/review/{key}
GET     /api/recordings/{name}/exports
GET     /api/recordings/{name}/exports/{file}
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
GET     /api/certificates/plate.pdf
GET     /api/certificates/collection
GET     /api/certificates/{marker}/json
GET     /api/certificates/{marker}/pdf
GET     /api/markers
GET     /api/markers/{name}/picture
GET     /api/tools
GET     /api/tools/collection
GET     /api/ct
GET     /api/ct/received
GET     /api/ct/uploads/{upload_id}/preview.png
GET     /api/ct/slices/{plane}.png
GET     /api/ct/slices/{plane}
GET     /api/ct/oblique.png
GET     /api/ct/oblique
GET     /api/plan
GET     /api/plan/catalogue
GET     /api/plan/clearances
GET     /api/plan/export
GET     /api/plan/markups
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
GET     /api/labels
GET     /api/labels.nii.gz
GET     /api/labels/channels
GET     /api/labels/outlines
GET     /api/labels/starts/{level}
GET     /api/surface
GET     /api/surface.ply
"""

# People in theatre silence an alarm by a touch on the screen.
DONE_IN_THEATRE = """
POST    /api/alarms/acknowledgement
POST    /api/alarms/pause
POST    /api/alarms/resumption
POST    /api/alarms/screens
"""

# A remote colleague requests a hold, releases it, and co-signs. Nothing moves by it.
DONE_BY_OVERSEERS = """
PUT     /api/recordings/{name}/scenes/{key}
POST    /api/recordings/{name}/comments
POST    /api/alarms/hold
POST    /api/alarms/release
POST    /api/supervision/marks
POST    /api/supervision/signatures
DELETE  /api/supervision/signatures/{signature_id}
"""

DONE_BY_OPERATORS = """
POST    /api/ct/received/{series_id}
DELETE  /api/ct/received/{series_id}
POST    /api/people/invitations
DELETE  /api/people/invitations/{invitation_id}
DELETE  /api/people/sessions/{session_id}
PUT     /api/rehearsal
POST    /api/procedure/confirmation
POST    /api/navigation/placements
DELETE  /api/navigation/placements/{document_id}
POST    /api/recordings/consent
POST    /api/recordings/start
POST    /api/recordings/stop
POST    /api/recordings/{name}/video
POST    /api/recordings/{name}/cut
POST    /api/recordings/{name}/tables
POST    /api/recordings/{name}/sequence
PUT     /api/recordings/{name}/protection
DELETE  /api/recordings/{name}
POST    /api/cases
POST    /api/cases/archive
PATCH   /api/cases/{case_id}
POST    /api/cases/{case_id}/open
POST    /api/cases/{case_id}/close
POST    /api/cases/{case_id}/deletion
POST    /api/cases/{case_id}/documents/{document_id}/withdrawal
POST    /api/cases/{case_id}/documents/{document_id}/restoration
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
POST    /api/certificates
POST    /api/certificates/collection
DELETE  /api/certificates/collection
POST    /api/certificates/collection/captures
DELETE  /api/certificates/collection/captures/last
POST    /api/certificates/collection/conclusion
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
POST    /api/plan/vertebrae/{name}/landmarks/import
POST    /api/plan/vertebrae/{name}/channels/{side}/import
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
POST    /api/labels
POST    /api/surface/from-ct
POST    /api/surface
"""

# The only permission of a device that is invited as a camera.
SENT_BY_CAMERAS = """
WS      /ws/camera
"""

# What a supervisor of a theatre may also do through the hub, where the theatre allows it (`hub.requests`).
# The theatre applies the rules above to each; the hub passes them on below `/at/{theatre}`.
THROUGH_HUB = """
GET     /api/session
POST    /api/session
DELETE  /api/session
POST    /api/alarms/hold
POST    /api/alarms/release
GET     /api/supervision/room
POST    /api/supervision/marks
GET     /api/supervision/signatures
POST    /api/supervision/signatures
DELETE  /api/supervision/signatures/{signature_id}
GET     /api/plan
GET     /api/plan/vertebrae/{name}/reference.png
GET     /api/registration
"""

# Not an action of a person: a heartbeat of the page every two seconds (the alarm log has the changes), and
# the instant that a review shows. Marks change nothing, come many times a second, and drawings are logged.
NOT_AUDITED = """
POST    /api/supervision/marks
POST    /api/alarms/screens
PUT     /api/recordings/{name}/scenes/{key}
"""
# Reads, but patient images leave the server.
AUDITED = """
GET     /api/cases/{case_id}/archive
GET     /api/audit/export
GET     /api/recordings/{name}/file
GET     /api/recordings/{name}/export/{table}.csv
GET     /api/recordings/{name}/exports/{file}
"""
# Executed even if the audit log cannot be written: alarms, and what frees space on a full disk.
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
POST    /api/recordings/stop
DELETE  /api/recordings/{name}
DELETE  /api/registration/points
DELETE  /api/registration/check
"""
# The answer is sent even if it could not be written: otherwise nobody could sign in to free space.
KEEPS_ANSWER = "POST    /api/session"
# Streams that end with their session.
LONG_LIVED = "GET     /video/{camera}.mjpg"


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """Permission for one route.

    Attributes:
        method: HTTP method, or `SOCKET`.
        template: path with parameters in braces, each without a slash.
        roles: allowed roles; `EVERYBODY` for all signed-in people.
        is_public: whether it is open without sign-in.
        is_audited: whether it is written to the audit log.
        is_urgent: whether it is executed even if it cannot be written.
        keeps_answer: whether its answer is sent even if it could not be written.
        is_long_lived: whether the answer is an endless stream or socket.
    """

    method: str
    template: str
    roles: frozenset[Role]
    is_public: bool = False
    is_audited: bool = False
    is_urgent: bool = False
    keeps_answer: bool = False
    is_long_lived: bool = False

    @property
    def name(self) -> str:
        """Name in the audit log: "POST /api/cases"."""
        return f"{self.method} {self.template}"


def _keys(lines: str) -> list[tuple[str, str]]:
    return [(method, path) for method, path in (line.split() for line in lines.strip().splitlines())]


def _rules() -> Iterable[Rule]:
    written, unwritten, urgent, answered, lasting = map(
        _keys, (AUDITED, NOT_AUDITED, URGENT, KEEPS_ANSWER, LONG_LIVED)
    )
    for lines, roles in (
        (PUBLIC, EVERYBODY),
        (OWN, EVERYBODY),
        (SEEN_BY_WATCHERS, WATCHERS),
        (SEEN_AT_THE_HUB, WATCHERS),
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
                is_audited=(changes and key not in unwritten) or key in written,
                is_urgent=key in urgent,
                keeps_answer=key in answered,
                is_long_lived=key[0] == SOCKET or key in lasting,
            )


# The hub's own audit log has none of them: the theatre's log has, by whom it was done there.
THROUGH_HUB_KEYS = tuple(_keys(THROUGH_HUB))
ACCESS_RULES: tuple[Rule, ...] = (
    *_rules(),
    *(
        Rule(method=method, template=f"/at/{{theatre}}{path}", roles=OVERSEERS)
        for method, path in THROUGH_HUB_KEYS
    ),
    Rule(method=SOCKET, template="/at/{theatre}/ws/room", roles=OVERSEERS, is_long_lived=True),
)


def _pattern(template: str) -> "re.Pattern[str]":
    parts = re.split(r"(\{[a-z_]+\})", template)
    return re.compile(
        "".join(f"(?P<{part[1:-1]}>[^/]+)" if part.startswith("{") else re.escape(part) for part in parts)
    )


_PATTERNS = tuple((_pattern(rule.template), rule) for rule in ACCESS_RULES)


def rules_of(method: str, path: str) -> tuple[list[tuple[Rule, Mapping[str, str]]], bool]:
    """Return all rules that match a method and path, and whether the path is known with any method.

    Where a path matches two templates, both have to allow it: the application decides which one it takes.
    `HEAD` is a `GET` without its body.
    """
    method = "GET" if method == "HEAD" else method
    found: list[tuple[Rule, Mapping[str, str]]] = [
        (rule, match.groupdict()) for pattern, rule in _PATTERNS if (match := pattern.fullmatch(path))
    ]
    fitting = [one for one in found if one[0].method == method]
    # Most specific first: the template with the fewest parameters.
    fitting.sort(key=lambda one: len(one[1]))
    return fitting, bool(found)


def is_through_hub(method: str, path: str) -> bool:
    """Return whether a theatre performs this for a supervisor who asks through the hub."""
    return any((rule.method, rule.template) in THROUGH_HUB_KEYS for rule, _ in rules_of(method, path)[0])

"""Messages of errors of sign-in and access, by code."""

from collections.abc import Mapping

from server.texts.language import Text

ACCESS: Mapping[str, tuple[Text, ...]] = {
    "INVITATION_EXPIRED": ({"en": "this link has expired", "de": "dieser Link ist abgelaufen"},),
    "INVITATION_FULL": (
        {
            "en": "{sessions} sessions are signed in by this link, the maximum",
            "de": "mit diesem Link sind {sessions} Sitzungen angemeldet, das ist die Höchstzahl",
        },
    ),
    "INVITATION_REVOKED": ({"en": "this link was revoked", "de": "dieser Link wurde widerrufen"},),
    "INVITATION_UNKNOWN": (
        {
            "en": "this link is not an invitation of this server",
            "de": "dieser Link ist keine Einladung dieses Servers",
        },
    ),
    "INVITATION_USED": (
        {
            "en": "this link was for a single sign-in and has been used",
            "de": "dieser Link galt für eine einzige Anmeldung und wurde verwendet",
        },
    ),
    "METHOD_NOT_ALLOWED": (
        {"en": "{path} does not support {method}", "de": "{path} unterstützt {method} nicht"},
    ),
    "NOT_FOUND": ({"en": "{path} does not exist", "de": "{path} gibt es nicht"},),
    "ORIGIN_REJECTED": (
        {
            "en": "the browser does not state that this request comes from a page of this server",
            "de": "der Browser gibt nicht an, dass diese Anfrage von einer Seite dieses Servers kommt",
        },
    ),
    "SESSION_EXPIRED": (
        {
            "en": "this session has expired, was ended, or belongs to another server",
            "de": "diese Sitzung ist abgelaufen, wurde beendet oder gehört zu einem anderen Server",
        },
    ),
    "SESSION_NEEDED": ({"en": "sign-in is required", "de": "eine Anmeldung ist nötig"},),
    "SIGN_IN_OFF": (
        {"en": "sign-in is off on this server", "de": "die Anmeldung ist auf diesem Server ausgeschaltet"},
    ),
    "TOO_MANY_PEOPLE": (
        {
            "en": "{stored} open invitations and sessions would be stored, allowed are {allowed}",
            "de": "{stored} offene Einladungen und Sitzungen würden gespeichert, erlaubt sind {allowed}",
        },
    ),
    "TOO_MANY_SIGN_INS": (
        {
            "en": "this link was used for {sign_ins} sign-ins within {minutes} min; the next is possible in "
            "{left_min} min",
            "de": "mit diesem Link wurden {sign_ins} Anmeldungen in {minutes} min gemacht; die nächste ist "
            "in {left_min} min möglich",
        },
    ),
    "TOO_MANY_TRIES": (
        {
            "en": "too many unknown links or sessions were tried; the next attempt is possible in {wait_s} s",
            "de": "zu viele unbekannte Links oder Sitzungen wurden versucht; der nächste Versuch ist in "
            "{wait_s} s möglich",
        },
    ),
    "ROLE_REJECTED": (
        {
            "en": "this requires the role {may}, but {person} is signed in as {role}",
            "de": "dies erfordert die Rolle {may}, {person} ist aber als {role} angemeldet",
        },
    ),
    "BODY_TOO_SLOW": (
        {
            "en": "the request was not complete after {allowed_s:g} s",
            "de": "die Anfrage war nach {allowed_s:g} s nicht vollständig",
        },
        {
            "en": "{taken_kb:.1f} kB of the request arrived, the last {last_kb:.1f} kB in {allowed_s:g} s; "
            "the minimum is {min_kb:g} kB in this time",
            "de": "{taken_kb:.1f} kB der Anfrage kamen an, die letzten {last_kb:.1f} kB in {allowed_s:g} "
            "s; mindestens {min_kb:g} kB in dieser Zeit",
        },
    ),
    "TOO_MANY_VIEWERS": (
        {
            "en": "{watching} viewers are connected, the maximum is {max_watching}",
            "de": "{watching} Zuschauer sind verbunden, höchstens {max_watching}",
        },
        {
            "en": "{name} has {watching} open connections, the maximum per person is {max_watching}",
            "de": "{name} hat {watching} offene Verbindungen, höchstens {max_watching} je Person",
        },
    ),
    "CAMERA_UNKNOWN": (
        {
            "en": "there is no camera '{requested}', only {cameras}",
            "de": "es gibt keine Kamera „{requested}“, nur {cameras}",
        },
    ),
    "PEOPLE_DAMAGED": (
        {
            "en": "the file of people {file} cannot be read: {library_error}",
            "de": "die Datei der Personen {file} ist nicht lesbar: {library_error}",
        },
    ),
}

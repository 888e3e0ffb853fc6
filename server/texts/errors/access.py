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
}

"""Messages of errors of the hub, by code."""

from collections.abc import Mapping

from server.texts.language import Text

HUB: Mapping[str, tuple[Text, ...]] = {
    "HUB_NOT_CONFIRMED": (
        {
            "en": "{theatre} has not confirmed the request; it is not known whether it was done",
            "de": "{theatre} hat die Anforderung nicht bestätigt; ob sie ausgeführt wurde, ist nicht bekannt",
        },
    ),
    "HUB_REQUESTS_OFF": (
        {
            "en": "{theatre} takes no requests through the hub now",
            "de": "{theatre} nimmt jetzt keine Anforderungen über den Hub an",
        },
    ),
    "HUB_REQUEST_OLD": (
        {
            "en": "the request reached the theatre more than {allowed_s:g} s after it was announced, or was "
            "announced to another run of it; nothing was done",
            "de": "die Anforderung kam mehr als {allowed_s:g} s nach ihrer Ankündigung im OP an, oder sie "
            "wurde vor seinem Neustart angekündigt; es wurde nichts getan",
        },
    ),
    "HUB_REQUEST_REJECTED": (
        {
            "en": "{method} {path} is not possible through the hub",
            "de": "{method} {path} ist über den Hub nicht möglich",
        },
    ),
    "HUB_SUPERVISORS_ONLY": (
        {
            "en": "the role {role} cannot be used through the hub",
            "de": "die Rolle {role} kann über den Hub nicht benutzt werden",
        },
    ),
    "MARK_REJECTED": (
        {
            "en": "the mark was rejected: it is not valid, or there were too many",
            "de": "die Markierung wurde abgelehnt: sie ist ungültig, oder es waren zu viele",
        },
    ),
    "ROOM_FULL": (
        {
            "en": "as many pages of supervisors are open as is possible",
            "de": "es sind so viele Seiten der Aufsicht geöffnet, wie möglich sind",
        },
    ),
    "THEATRE_SILENT": (
        {
            "en": "nothing recent was received from {theatre}",
            "de": "von {theatre} wurde nichts Aktuelles empfangen",
        },
    ),
    "HUB_CREDENTIALS_UNUSABLE": (
        {
            "en": "{file} has not exactly one line of the form user:password",
            "de": "{file} hat nicht genau eine Zeile der Form user:password",
        },
    ),
    "HUB_FAILED": (
        {
            "en": "publishing to the hub failed: {library_error}",
            "de": "das Veröffentlichen an den Hub ist fehlgeschlagen: {library_error}",
        },
    ),
    "HUB_NAME_TAKEN": (
        {
            "en": "a theatre {theatre} publishes already, from {host} since {since}: two theatres with one "
            "name would be mixed up",
            "de": "ein OP {theatre} veröffentlicht schon, von {host} seit {since}: zwei OPs mit einem Namen "
            "würden verwechselt",
        },
    ),
    "HUB_NOT_SET": (
        {
            "en": "the settings name no NATS server",
            "de": "die Einstellungen nennen keinen NATS-Server",
        },
    ),
    "HUB_OUTBOX_UNUSABLE": (
        {
            "en": "the outbox of the hub in {folder} cannot be used: {library_error}",
            "de": "der Postausgang des Hubs in {folder} lässt sich nicht verwenden: {library_error}",
        },
    ),
    "HUB_THEATRE_MISSING": (
        {
            "en": "hub.url is {url}, but hub.theatre does not name this theatre",
            "de": "hub.url ist {url}, aber hub.theatre nennt diesen OP nicht",
        },
    ),
    "HUB_UNREACHABLE": (
        {
            "en": "the hub's NATS server {url} cannot be used: {library_error}",
            "de": "der NATS-Server {url} des Hubs lässt sich nicht verwenden: {library_error}",
        },
    ),
}

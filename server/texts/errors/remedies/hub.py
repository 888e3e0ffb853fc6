"""Remedies of errors of the hub."""

from server.texts.language import Text

HUB: tuple[Text, ...] = (
    {
        "en": "Close pages that are not needed.",
        "de": "Nicht benötigte Seiten schließen.",
    },
    {
        "en": "Draw less at once, or wait a second.",
        "de": "Weniger auf einmal zeichnen, oder eine Sekunde warten.",
    },
    {
        "en": "Ask the operator of the theatre for an invitation as supervisor.",
        "de": "Bei der Bedienung des OPs um eine Einladung als Aufsicht bitten.",
    },
    {
        "en": "Look at the state of the theatre, or call it, before you ask again.",
        "de": "Den Zustand des OPs ansehen oder dort anrufen, dann erst erneut versuchen.",
    },
    {
        "en": "Look at the state of the theatre, then ask again.",
        "de": "Den Zustand des OPs ansehen, dann erneut versuchen.",
    },
    {
        "en": "See its state in the list of theatres; the people in the theatre have their own screen.",
        "de": "Den Zustand in der Liste der OPs ansehen; im OP gibt es einen eigenen Bildschirm.",
    },
    {
        "en": "Use the theatre's own page, or call it. The theatre takes requests while it is connected and "
        "hub.requests is true in its settings.",
        "de": "Die eigene Seite des OPs benutzen oder dort anrufen. Der OP nimmt Anforderungen an, solange "
        "er verbunden ist und in seinen Einstellungen hub.requests true ist.",
    },
    {
        "en": "Use the theatre's own page.",
        "de": "Die eigene Seite des OPs benutzen.",
    },
    {
        "en": "Check the disk and the rights of this folder. A damaged outbox may be moved away while the "
        "server is stopped: what the hub has not stored yet is then in the theatre's own logs only.",
        "de": "Die Platte und die Rechte dieses Ordners prüfen. Ein beschädigter Postausgang darf bei "
        "angehaltenem Server verschoben werden: was der Hub noch nicht gespeichert hat, steht dann nur in "
        "den eigenen Protokollen des OPs.",
    },
    {
        "en": "Give this theatre another name in hub.theatre. After a crash of this server its own name "
        "is free again within {lease_s:g} s.",
        "de": "Diesem OP in hub.theatre einen anderen Namen geben. Nach einem Absturz dieses Servers ist "
        "sein eigener Name innerhalb von {lease_s:g} s wieder frei.",
    },
    {
        "en": "Set hub.theatre to a name that no other theatre has, or hub.url to null.",
        "de": "hub.theatre auf einen Namen setzen, den kein anderer OP hat, oder hub.url auf null.",
    },
    {
        "en": "Set hub.url to the address of the hospital's NATS server, as tls://host:4222.",
        "de": "hub.url auf die Adresse des NATS-Servers der Klinik setzen, etwa tls://host:4222.",
    },
    {
        "en": "The theatre works without it, and catches up. Check the network, the NATS server, and "
        "hub.url, hub.credentials and hub.tls in the settings.",
        "de": "Der OP arbeitet ohne ihn und holt nach. Das Netz, den NATS-Server sowie hub.url, "
        "hub.credentials und hub.tls in den Einstellungen prüfen.",
    },
    {
        "en": "The theatre works without it. See the server log.",
        "de": "Der OP arbeitet ohne ihn. Das Serverprotokoll ansehen.",
    },
    {
        "en": "Write the user of this theatre on the NATS server and its password into this file, readable "
        "by the server's user only.",
        "de": "Den Benutzer dieses OPs auf dem NATS-Server und sein Passwort in diese Datei schreiben, "
        "lesbar nur für den Benutzer des Servers.",
    },
)

"""Remedies of errors of access."""

from server.texts.language import Text

ACCESS: tuple[Text, ...] = (
    {
        "en": "Sign in with the link that the server printed at its start, or ask the operator for an "
        "invitation.",
        "de": "Mit dem Link anmelden, den der Server beim Start ausgab, oder die Bedienung um eine "
        "Einladung bitten.",
    },
    {
        "en": "Open the dashboard of this server; a program must send its token as 'Authorization: Bearer' "
        "instead of a cookie.",
        "de": "Die Seite dieses Servers öffnen; ein Programm muss sein Token als „Authorization: Bearer“ "
        "statt als Cookie senden.",
    },
    {"en": "See /api/docs for all addresses.", "de": "Alle Adressen stehen in /api/docs."},
    {
        "en": "Ask the operator for a new invitation; an operator starts the server with "
        "--new-operator-link.",
        "de": "Die Bedienung um eine neue Einladung bitten; die Bedienung selbst startet den Server mit "
        "--new-operator-link.",
    },
    {
        "en": "Sign out on unused devices, or ask the operator to end sessions or for another link.",
        "de": "Auf ungenutzten Geräten abmelden, oder die Bedienung bitten, Sitzungen zu beenden oder einen "
        "anderen Link zu geben.",
    },
    {
        "en": "Revoke invitations and end sessions that are not needed.",
        "de": "Nicht benötigte Einladungen widerrufen und Sitzungen beenden.",
    },
    {
        "en": "Wait {wait_s} s, then open the link again.",
        "de": "{wait_s} s warten, dann den Link neu öffnen.",
    },
    {
        "en": "Stay signed in, or ask the operator for another link.",
        "de": "Angemeldet bleiben, oder die Bedienung um einen anderen Link bitten.",
    },
    {
        "en": "Set security.sign_in to required in the settings, and start the server again.",
        "de": "In den Einstellungen security.sign_in auf required setzen und den Server neu starten.",
    },
    {
        "en": "Ask a person with this role to do it, or to invite you with this role.",
        "de": "Eine Person mit dieser Rolle darum bitten, oder um eine Einladung mit dieser Rolle.",
    },
    {
        "en": "Send it again over a faster connection.",
        "de": "Über eine schnellere Verbindung erneut senden.",
    },
    {
        "en": "Close an unused view, or raise video.max_viewers in the settings.",
        "de": "Eine ungenutzte Ansicht schließen, oder video.max_viewers in den Einstellungen erhöhen.",
    },
    {
        "en": "Close an unused page.",
        "de": "Eine ungenutzte Seite schließen.",
    },
    {
        "en": "Use one of these cameras, or configure another one in the settings.",
        "de": "Eine dieser Kameras verwenden, oder eine weitere in den Einstellungen angeben.",
    },
    {
        "en": "Move the file to another folder and start again; everybody then has to be invited again.",
        "de": "Die Datei in einen anderen Ordner verschieben und neu starten; alle müssen dann neu "
        "eingeladen werden.",
    },
)

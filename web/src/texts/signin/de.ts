import type { SignInTexts } from "./en";

export const signInDe: SignInTexts = {
  about: {
    title: "Was ist Coaxial?",
    drawing:
      "Eine Kamera sieht den Marker an einem Bohrer, dessen Spitze in einem Wirbel ist. Ein Bildschirm zeigt den Bohrer und den geplanten Kanal.",
    sentences: [
      "Coaxial hilft beim Bohren entlang eines geplanten Kanals in einem Wirbel.",
      "Eine Kamera sieht ein gedrucktes Quadrat am Bohrer; daraus berechnet Coaxial, wo Spitze und Achse sind.",
      "Der Bildschirm zeigt beides zusammen mit der Planung: im Live-Video, in Zahlen und im CT.",
    ],
    camera: "Kamera",
    marker: "Marker",
    drill: "Bohrer",
    channel: "geplanter Kanal",
    screen: "Bildschirm",
  },
  help: {
    title: "Wo ist mein Link?",
    started: {
      who: "Sie haben den Server gestartet",
      how: "Das Terminal, in dem er läuft, hat den Link für die Bedienung ausgegeben:",
    },
    invited: {
      who: "Sie wurden eingeladen",
      how: "Öffnen Sie den Link der Bedienung oder scannen Sie den Code mit diesem Gerät.",
    },
    lost: {
      who: "Der Link ist verloren oder verbraucht",
      how: "Bitten Sie die Bedienung um eine neue Einladung. Gibt es keine Bedienung, beenden Sie den Server (das unterbricht die Navigation) und starten Sie ihn mit einem dieser Befehle:",
    },
    guide: "Handbuch (englisch)",
  },
  needed: {
    title: "Anmelden",
    sentence: "Öffnen Sie den Link, den Sie erhalten haben. Damit wird dieses Gerät angemeldet.",
  },
  expired: {
    title: "Ihre Sitzung ist beendet",
    sentence:
      "Die Zeit ist abgelaufen, oder die Bedienung hat die Sitzung beendet. Es wird kein Live-Bild mehr gezeigt. Bitten Sie die Bedienung um eine neue Einladung.",
  },
  silent: {
    title: "Der Server antwortet nicht",
    sentence:
      "Der Versuch wird automatisch wiederholt. Prüfen Sie, ob dieses Gerät im richtigen Netz ist und Coaxial läuft.",
  },
  rejected: {
    INVITATION_UNKNOWN: {
      title: "Dieser Link gehört nicht zu diesem Server",
      sentence:
        "Prüfen Sie, ob er vollständig kopiert wurde und für diesen Server gilt. Sonst bitten Sie die Bedienung um einen neuen Link.",
    },
    INVITATION_USED: {
      title: "Dieser Link wurde bereits verwendet",
      sentence:
        "Er galt für eine einzige Anmeldung. Waren Sie das nicht, informieren Sie sofort die Bedienung und bitten Sie um einen neuen Link.",
    },
    INVITATION_EXPIRED: {
      title: "Dieser Link ist abgelaufen",
      sentence: "Bitten Sie die Bedienung um einen neuen.",
    },
    INVITATION_REVOKED: {
      title: "Dieser Link wurde zurückgezogen",
      sentence: "Bitten Sie die Bedienung um einen neuen.",
    },
    INVITATION_FULL: {
      title: "Über diesen Link sind zu viele Geräte angemeldet",
      sentence:
        "Melden Sie ein Gerät ab, das nicht gebraucht wird, oder bitten Sie die Bedienung um einen eigenen Link.",
    },
    TOO_MANY_TRIES: {
      title: "Zu viele Versuche mit falschen Links",
      sentence: "Warten Sie kurz und öffnen Sie den Link dann noch einmal.",
    },
    NO_ANSWER: {
      title: "Der Server antwortet nicht",
      sentence: "Prüfen Sie, ob dieses Gerät im richtigen Netz ist, und öffnen Sie den Link noch einmal.",
    },
  },
  entering: "Anmeldung läuft …",
  asking: "Einen Moment …",
  paste: "Oder den Link hier einfügen",
  pasteHint: "Den ganzen Link oder den Teil nach dem #.",
  noLink: "Das ist kein vollständiger Einladungslink.",
  signIn: "Anmelden",
  signedInAs: "Angemeldet als",
  goOn: "Weiter",
  role: {
    operator: "Bedienung",
    supervisor: "Aufsicht",
    viewer: "Betrachter",
    screen: "OP-Bildschirm",
    camera: "Kamera",
  },
  leaveTitle: "Abmelden?",
  leaveSentence:
    "Danach zeigt dieses Gerät nichts mehr. Für eine erneute Anmeldung brauchen Sie eine neue Einladung.",
  onlyTitle: "Sie sind die einzige Bedienung",
  onlySentence:
    "Danach kann niemand mehr einrichten, registrieren oder bestätigen. Einen neuen Link für die Bedienung gibt der Server erst nach einem Neustart aus; solange ist die Navigation unterbrochen.",
  onlyInvite: "Erst jemanden als Bedienung einladen",
  leaveAnyway: "Trotzdem abmelden",
  leave: "Abmelden",
  stay: "Bleiben",
};

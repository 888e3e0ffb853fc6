import type { SignInTexts } from "./en";

export const signInDe: SignInTexts = {
  needed: {
    title: "Anmelden",
    sentence:
      "Öffnen Sie den Link Ihrer Einladung oder scannen Sie den Code. Der erste Link für die Bedienung steht in dem Fenster, in dem der Server gestartet wurde.",
  },
  expired: {
    title: "Ihre Sitzung ist beendet",
    sentence:
      "Die Zeit ist abgelaufen, oder die Bedienung hat sie beendet. Es wird nichts Aktuelles mehr gezeigt. Bitten Sie die Bedienung um eine neue Einladung.",
  },
  silent: {
    title: "Der Server antwortet nicht",
    sentence:
      "Es wird von selbst weiter versucht. Prüfen Sie, ob dieses Gerät im richtigen Netz ist und ob Coaxial läuft.",
  },
  rejected: {
    INVITATION_UNKNOWN: {
      title: "Dieser Link gehört nicht zu diesem Server",
      sentence:
        "Prüfen Sie, ob er vollständig kopiert wurde und für diesen Server gilt. Sonst bitten Sie die Bedienung um einen neuen.",
    },
    INVITATION_USED: {
      title: "Dieser Link wurde schon benutzt",
      sentence:
        "Er galt für eine Anmeldung. Waren Sie das nicht, sagen Sie es sofort der Bedienung; bitten Sie dann um einen neuen Link.",
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
      title: "Über diesen Link sind schon zu viele angemeldet",
      sentence:
        "Melden Sie sich auf einem Gerät ab, das ihn nicht braucht, oder bitten Sie die Bedienung um einen eigenen Link.",
    },
    TOO_MANY_TRIES: {
      title: "Zu viele falsche Links",
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
  noLink: "Das ist kein vollständiger Link einer Einladung.",
  signIn: "Anmelden",
  signedInAs: "Angemeldet als",
  goOn: "Weiter",
  role: {
    operator: "Bedienung",
    supervisor: "Aufsicht",
    viewer: "Zuschauer",
    screen: "OP-Bildschirm",
    camera: "Kamera",
  },
  leaveTitle: "Abmelden?",
  leaveSentence: "Danach zeigt dieses Gerät nichts mehr. Zum Wiederkommen brauchen Sie eine neue Einladung.",
  onlyTitle: "Sie sind die einzige Bedienung",
  onlySentence:
    "Danach kann niemand mehr einrichten, registrieren oder bestätigen. Einen neuen Link für die Bedienung gibt der Server erst aus, wenn er beendet und neu gestartet wird; so lange steht die Navigation still.",
  onlyInvite: "Erst jemanden als Bedienung einladen",
  leaveAnyway: "Trotzdem abmelden",
  leave: "Abmelden",
  stay: "Bleiben",
};

import type { HubTexts } from "./en";

export const hubDe: HubTexts = {
  title: "OPs",
  nothingMoves: "Diese Seite steuert in keinem OP etwas.",
  all: "Alle OPs",
  presence: {
    live: "live",
    unmeasured: "Verzögerung noch nicht gemessen",
    unreadable: "nicht lesbar",
    stale: "veraltet",
    gone: "weg",
  },
  covered: {
    unmeasured: "Wie alt seine Nachrichten sind, ist noch nicht bekannt; darum wird nichts von ihm gezeigt.",
    unreadable:
      "Dieser Hub kann seinen Zustand nicht lesen; Alarme sind möglich. Hub und OP mit derselben Version betreiben.",
    stale: "Seine neueste Nachricht ist zu alt; darum wird nichts von ihm gezeigt.",
    gone: "Er hat seit mehr als zehn Sekunden nichts gesendet.",
  },
  lastHeard: "zuletzt gehört vor höchstens",
  atMost: "höchstens",
  picture: "Bild",
  noPicture: "Kein aktuelles Bild",
  newestImage: "Alter des neuesten Bildes",
  noImage: "kein Bild",
  silent:
    "Der Hub antwortet nicht. Bis er es tut, wird von keinem OP etwas gezeigt. Die OPs arbeiten ohne ihn weiter.",
  seesNothing:
    "Das Konto {name} sieht keinen OP. Wer den Hub betreibt, trägt es mit seinen OPs unter hub.sees in die " +
    "Einstellungen ein.",
  noneHeard: "Keiner der OPs, die dieses Konto sieht ({names}), wurde seit dem Start des Hubs gehört.",
  session: {
    title: "Handeln in diesem OP",
    signedIn: "Angemeldet im {theatre} als",
    leave: "Dort abmelden",
    needed:
      "Um einen Halt zu erbitten, zu zeigen oder zu unterschreiben, im {theatre} selbst anmelden: dessen Bedienung stellt " +
      "eine Einladung als Aufsicht aus. Der OP entscheidet über jede Handlung und protokolliert sie.",
    paste: "Einladungslink von {theatre}",
  },
  through: "Über den Hub: Werte sind hier älter als im OP. Ihr Alter steht daneben.",
};

import type { NavigateTexts } from "./en";

export const navigateDe: NavigateTexts = {
  title: "Navigation im Kanal",
  open: "Alle Schritte sind gültig.",
  checked: "Die Prüfung an {landmark} ist bestanden: {mm} mm, erlaubt {max} mm.",
  recheck: "Erneut prüfen",
  shutTitle: "Noch keine Navigation",
  dueTitle: "Wieder fällig; die Navigation läuft weiter",
  goTo: "Zu",
  cameraMoved: {
    title: "Die Kamera wurde bewegt",
    remedy:
      "Plan und Patient passen nicht mehr zusammen. Kamera am jetzigen Ort fixieren, dann neu registrieren.",
    go: "Neu registrieren",
  },
  referenceMoved: {
    title: "Der Patient oder sein Marker wurde bewegt",
    remedy:
      "Sitzt der Marker noch fest am Knochen, zeigt eine Prüfung an einem Punkt, ob alles passt. Sonst neu registrieren.",
    go: "An einem Punkt prüfen",
  },
  tip: "Spitze",
  lag: "Ruhe",
  steadied: "beruhigt, verzögert um",
  notSteadied: "jedes Bild für sich",
  markers: "Marker zuletzt gesehen",
  neverSeen: "nie",
  noChannel: "Kein Kanal gewählt",
  switchTo: "Anderer Kanal …",
  sameVertebra: "Gleicher Wirbel: Registrierung und Prüfung bleiben gültig.",
  otherVertebra:
    "Anderer Wirbel: {vertebra} braucht eine eigene Registrierung und Prüfung. Bis dahin gibt es keine Zahlen.",
  switchSure: "Ja, {channel} bohren",
};

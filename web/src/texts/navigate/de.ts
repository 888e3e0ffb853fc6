import type { NavigateTexts } from "./en";

export const navigateDe: NavigateTexts = {
  title: "Navigation im Kanal",
  open: "Alle Schritte sind gültig.",
  checked: "Prüfung an {landmark} bestanden: {mm} mm, erlaubt {max} mm.",
  recheck: "Erneut prüfen",
  shutTitle: "Noch keine Navigation",
  dueTitle: "Wieder fällig; die Navigation läuft weiter",
  goTo: "Öffnen:",
  cameraMoved: {
    title: "Die Kamera wurde bewegt",
    remedy:
      "Planung und Patient stimmen nicht mehr überein. Kamera am jetzigen Ort fixieren, dann neu registrieren.",
    go: "Neu registrieren",
  },
  referenceMoved: {
    title: "Der Patient oder der Patientenmarker wurde bewegt",
    remedy:
      "Sitzt der Marker noch fest am Knochen, zeigt eine Prüfung an einer Landmarke, ob alles stimmt. Sonst neu registrieren.",
    go: "An einer Landmarke prüfen",
  },
  tip: "Spitze",
  lag: "Glättung",
  steadied: "geglättet, verzögert um",
  notSteadied: "keine, jedes Bild einzeln",
  markers: "Marker zuletzt gesehen",
  neverSeen: "nie",
  noChannel: "Kein Kanal gewählt",
  switchTo: "Anderer Kanal …",
  sameVertebra: "Gleicher Wirbel: Registrierung und Prüfung bleiben gültig.",
  otherVertebra:
    "Anderer Wirbel: {vertebra} braucht eine eigene Registrierung und Prüfung. Bis dahin werden keine Werte angezeigt.",
  switchSure: "Ja, {channel} bohren",
};

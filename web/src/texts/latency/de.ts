import type { LatencyTexts } from "./en";

export const latencyDe: LatencyTexts = {
  title: "Verzögerung",
  lead: "Zeit vom Licht vor der Kamera bis zur Anzeige auf dieser Seite. Etwa 20 Sekunden lang zeigt dieser Bildschirm Codes, die die Kamera aufnimmt. Das Ergebnis gilt für diese Kamera mit diesem Bildschirm.",
  never: "Mit dieser Kamera noch nicht gemessen.",
  simulated:
    "Die Kamera ist simuliert und sieht keinen Bildschirm: gemessen wird nur die Latenz einer echten Kamera.",
  begin: "Messen",
  beginAgain: "Erneut messen",
  aim: "Die Kamera auf diesen Bildschirm richten, bis der Code einen guten Teil ihres Bildes füllt.",
  measuring: "Messung läuft: Kamera ruhig halten.",
  read: "Code gelesen in {read} von {looked} Bildern.",
  stop: "Abbrechen",
  codeAlt: "Ein Code, der etwa achtmal in der Sekunde wechselt",
  perSecond: "Bilder/s",
  median: "Licht bis Seite, Median",
  p99: "Licht bis Seite, 99 % innerhalb von",
  stage: {
    "screen and camera": "Bildschirm und Kamera",
    tracking: "Tracking",
    server: "Server",
    line: "Verbindung",
    page: "Seite",
  },
  resolution:
    "Codes: {samples}, Bilder: {images}, übersprungen: {skipped}. Die Kamera liefert alle {period} ms ein Bild; ein Code wird deshalb im Mittel {late} ms nach seinem Erscheinen aufgenommen. Diese Zeit ist in den Werten enthalten, ebenso die Verzögerung des Bildschirms. Der Bildschirm zeigt alle {screen} ms ein Bild. Die Uhren von Seite und Server stimmen auf {clocks} ms überein; das betrifft nur die Aufteilung auf die Abschnitte.",
  lightToPage: "Licht bis Seite",
  measured: "{median} ms Median, {p99} ms p99, gemessen {day}",
  notMeasured: "nicht gemessen",
  otherImages: "mit {size} bei {rate} Bildern/s gemessen, die Einstellung ist jetzt anders: neu messen",
};

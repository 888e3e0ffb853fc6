import type { LatencyTexts } from "./en";

export const latencyDe: LatencyTexts = {
  title: "Verzögerung",
  lead: "Wie alt das Bild ist, nach dem sich eine Hand richtet: vom Licht vor der Kamera bis auf diese Seite. Etwa 20 Sekunden lang füllen Codes diesen Bildschirm, während die Kamera darauf blickt; gemessen wird, was diese Kamera und dieser Bildschirm zusammen tun.",
  never: "Mit dieser Kamera noch nicht gemessen.",
  begin: "Messen",
  beginAgain: "Erneut messen",
  aim: "Die Kamera auf diesen Bildschirm richten, bis der Code einen guten Teil ihres Bildes füllt.",
  measuring: "Es wird gemessen: die Kamera ruhig halten.",
  read: "Gelesen in {read} von {looked} Bildern.",
  stop: "Abbrechen",
  codeAlt: "Ein Code, der etwa achtmal in der Sekunde wechselt",
  perSecond: "Bilder/s",
  median: "Licht bis Seite, Median",
  p99: "Licht bis Seite, 99 % innerhalb von",
  stage: {
    "screen and camera": "Bildschirm und Kamera",
    tracking: "Tracking",
    server: "Server",
    line: "Leitung",
    page: "Seite",
  },
  resolution:
    "{samples} Codes in {images} Bildern, {skipped} übersprungen. Alle {period} ms kommt ein Bild: ein Code, der zwischen zwei Bildern erscheint, wird im Mittel {late} ms zu spät gesehen; das ist in diesen Zahlen enthalten, ebenso einmal die Verzögerung des Bildschirms selbst. Der Bildschirm zeigt alle {screen} ms ein Bild. Die Uhren von Seite und Server stimmen auf {clocks} ms überein; das verschiebt nur Zeit zwischen den Abschnitten.",
  lightToPage: "Licht bis Seite",
  measured: "{median} ms Median, {p99} ms p99, gemessen {day}",
  notMeasured: "nicht gemessen",
  otherImages: "mit {size} bei {rate} Bildern/s gemessen, anders als jetzt: neu messen",
};

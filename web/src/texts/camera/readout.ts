export const readoutEn = {
  title: "Readout of the image",
  lead: "Many cameras read an image row by row (rolling shutter). Moving objects are then distorted, and a moving tip is shown in the wrong place. The time from the first row to the last corrects this.",
  field: "Readout, first row to last (ms)",
  fieldHint: "From the camera's data sheet. 0 is a global shutter; leave empty if unknown.",
  unknown: "not known",
  keep: "Save this readout",
  measure: "Measure with the board",
  versionHint:
    "It is saved as a new version of the calibration. Tools and registrations based on the previous version must be made again.",
  notKnown: "Not known: the value in the settings is used.",
  global: { measured: "Measured: no rolling shutter detected.", stated: "Stated: a global shutter." },
  rolling: {
    measured: "Measured: {ms} ms from the first row to the last.",
    stated: "Stated: {ms} ms from the first row to the last.",
  },
  spread: "Standard deviation {sd} ms.",
  stages: {
    show: "Show the board to the camera, near enough to fill half of the picture.",
    move: "Now move it quickly to and fro, sideways and up and down, about twice a second.",
    taking: "Images are being captured: keep moving the board.",
    reading: "Put the board down. The images are being searched for it.",
    ready: "The readout is being computed.",
  },
  progress: "{done} of {all} images · board found in {found}",
  end: "Stop measuring",
};

export type ReadoutTexts = typeof readoutEn;

export const readoutDe: ReadoutTexts = {
  title: "Auslesezeit der Kamera",
  lead: "Viele Kameras lesen ein Bild zeilenweise aus (Rolling Shutter). Bewegte Objekte werden dadurch verzerrt, und eine bewegte Spitze wird am falschen Ort gezeigt. Die Zeit von der ersten bis zur letzten Zeile korrigiert dies.",
  field: "Auslesezeit, erste bis letzte Zeile (ms)",
  fieldHint: "Aus dem Datenblatt der Kamera. 0 bedeutet Global Shutter; leer lassen, wenn sie unbekannt ist.",
  unknown: "nicht bekannt",
  keep: "Diese Auslesezeit speichern",
  measure: "Mit der Tafel messen",
  versionHint:
    "Sie wird als neue Version der Kalibrierung gespeichert. Instrumente und Registrierungen, die auf der vorigen beruhen, müssen neu erstellt werden.",
  notKnown: "Nicht bekannt: Es gilt der Wert aus den Einstellungen.",
  global: { measured: "Gemessen: kein Rolling Shutter erkannt.", stated: "Angegeben: ein Global Shutter." },
  rolling: {
    measured: "Gemessen: {ms} ms von der ersten bis zur letzten Zeile.",
    stated: "Angegeben: {ms} ms von der ersten bis zur letzten Zeile.",
  },
  spread: "Standardabweichung {sd} ms.",
  stages: {
    show: "Die Tafel der Kamera zeigen, so nah, dass sie das halbe Bild füllt.",
    move: "Jetzt schnell hin und her bewegen, seitwärts und auf und ab, etwa zweimal in der Sekunde.",
    taking: "Bilder werden aufgenommen: weiter bewegen.",
    reading: "Die Tafel kann abgelegt werden. Sie wird in den Bildern gesucht.",
    ready: "Die Auslesezeit wird berechnet.",
  },
  progress: "{done} von {all} Bildern · Tafel in {found} gefunden",
  end: "Messen beenden",
};

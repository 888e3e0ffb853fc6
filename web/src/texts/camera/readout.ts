export const readoutEn = {
  title: "Readout of the image",
  lead: "Many cameras read an image row by row (rolling shutter): what moves is sheared then, and a moving tip is shown beside its place. With the time from the first row to the last this is undone.",
  field: "Readout, first row to last (ms)",
  fieldHint: "From the camera's data sheet. 0 is a global shutter; leave it empty where it is not known.",
  unknown: "not known",
  keep: "Keep this readout",
  measure: "Measure it with the board",
  versionHint:
    "It is kept as a new version of the calibration: tools and registrations that depend on the previous one are to be made again.",
  notKnown: "Not known: what the settings say is used.",
  global: { measured: "Measured: no rolling shutter is seen.", stated: "Stated: a global shutter." },
  rolling: {
    measured: "Measured: {ms} ms from the first row to the last.",
    stated: "Stated: {ms} ms from the first row to the last.",
  },
  spread: "Standard deviation {sd} ms.",
  stages: {
    show: "Show the board to the camera, near enough to fill half of the picture.",
    move: "Now move it quickly to and fro, sideways and up and down, about twice a second.",
    taking: "Images are taken: go on moving it.",
    reading: "Put the board down: it is looked for in the images.",
    ready: "The readout is computed.",
  },
  progress: "{done} of {all} images · board found in {found}",
  end: "Stop measuring",
};

export type ReadoutTexts = typeof readoutEn;

export const readoutDe: ReadoutTexts = {
  title: "Auslesen des Bildes",
  lead: "Viele Kameras lesen ein Bild Zeile um Zeile (Rolling Shutter): Bewegtes wird dabei verzerrt, und eine bewegte Spitze wird neben ihrem Ort gezeigt. Mit der Zeit von der ersten bis zur letzten Zeile wird das rückgängig gemacht.",
  field: "Auslesezeit, erste bis letzte Zeile (ms)",
  fieldHint:
    "Aus dem Datenblatt der Kamera. 0 ist ein Global Shutter; leer lassen, wenn sie nicht bekannt ist.",
  unknown: "nicht bekannt",
  keep: "Diese Auslesezeit behalten",
  measure: "Mit der Tafel messen",
  versionHint:
    "Sie wird als neue Version der Kalibrierung behalten: Werkzeuge und Registrierungen, die auf der vorigen stehen, sind neu zu machen.",
  notKnown: "Nicht bekannt: es gilt, was in den Einstellungen steht.",
  global: { measured: "Gemessen: kein Rolling Shutter zu sehen.", stated: "Angegeben: ein Global Shutter." },
  rolling: {
    measured: "Gemessen: {ms} ms von der ersten bis zur letzten Zeile.",
    stated: "Angegeben: {ms} ms von der ersten bis zur letzten Zeile.",
  },
  spread: "Standardabweichung {sd} ms.",
  stages: {
    show: "Die Tafel der Kamera zeigen, so nah, dass sie das halbe Bild füllt.",
    move: "Jetzt schnell hin und her bewegen, seitwärts und auf und ab, etwa zweimal in der Sekunde.",
    taking: "Bilder werden aufgenommen: weiter bewegen.",
    reading: "Die Tafel kann ruhen: sie wird in den Bildern gesucht.",
    ready: "Die Auslesezeit wird berechnet.",
  },
  progress: "{done} von {all} Bildern · Tafel in {found} gefunden",
  end: "Messen beenden",
};

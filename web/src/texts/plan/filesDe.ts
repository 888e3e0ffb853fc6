import type { FilesTexts } from "./filesEn";

export const filesDe: FilesTexts = {
  surface: {
    title: "Oberfläche des Knochens",
    hint: "Ihr Umriss auf den Schichten soll der Knochenkante folgen. Bei der Navigation wird sie in 3-D gezeigt, und ein Abfahren mit der Spitze macht die Registrierung genauer.",
    none: "Es gibt noch keine Oberfläche.",
    make: "Aus dem CT machen",
    makeAnew: "Neu aus dem CT machen",
    outOfDate: "Diese Oberfläche ist veraltet",
    source: "Gemacht aus",
    fromCt: "dem CT dieses Falls",
    fromFile: "einer Datei",
    faces: "Dreiecke",
    size: "Größe",
    threshold: "Knochen ab",
    unit: "Einheit der Zahlen in der Datei",
    unitUnsaid: "Nicht gesagt: es müssen mm sein",
    units: {
      mm: "Millimeter",
      cm: "Zentimeter",
      m: "Meter",
      inch: "Zoll",
      um: "Mikrometer",
    },
    proposedUnit: "Ihre Größe würde passen in der Einheit",
    sayUnit:
      "Messen Sie den Knochen nach, wählen Sie unten die Einheit und senden Sie die Datei noch einmal. Ungefragt wird nichts skaliert.",
    send: "STL, OBJ oder PLY senden …",
    max: "höchstens",
  },
  file: {
    title: "Planung als Datei",
    hint: "Die Datei sagt, wer die Planung wann und auf welchem CT gemacht hat. Nichts darin nennt den Patienten.",
    none: "Es gibt noch keine Planung, die sich schreiben ließe.",
    out: "Planung in eine Datei schreiben",
    outForSlicer: "Für 3D Slicer schreiben",
    in: "Planung einlesen …",
    replaces: "Eine eingelesene Planung ersetzt die gezeigte; Zurück holt sie wieder.",
    otherCt: "Diese Planung entstand auf einem anderen CT",
    otherCtHint:
      "Ihre Kanäle können auf diesem irgendwo liegen. Nehmen Sie sie nur, wenn beide denselben Patienten in einer Lage zeigen, und prüfen Sie jeden Kanal.",
    takeAllTheSame: "Trotzdem nehmen",
  },
};

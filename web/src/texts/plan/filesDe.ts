import type { FilesTexts } from "./filesEn";

export const filesDe: FilesTexts = {
  surface: {
    title: "Knochenoberfläche",
    hint: "Ihr Umriss auf den Schichten soll der Knochenkante folgen. Sie wird bei der Navigation in 3-D gezeigt und zum Abfahren des Knochens verwendet.",
    none: "Es gibt noch keine Oberfläche.",
    make: "Aus dem CT erzeugen",
    makeAnew: "Neu aus dem CT erzeugen",
    outOfDate: "Diese Oberfläche ist veraltet",
    source: "Erzeugt aus",
    fromCt: "dem CT dieses Falls",
    fromFile: "einer Datei",
    faces: "Dreiecke",
    size: "Größe",
    threshold: "Knochen ab",
    unit: "Einheit der Zahlen in der Datei",
    unitUnsaid: "Nicht angegeben: Millimeter",
    units: {
      mm: "Millimeter",
      cm: "Zentimeter",
      m: "Meter",
      inch: "Zoll",
      um: "Mikrometer",
    },
    proposedUnit: "Passende Einheit für diese Größe",
    sayUnit:
      "Messen Sie den Knochen nach, wählen Sie unten die Einheit und senden Sie die Datei erneut. Die Datei wird nicht automatisch skaliert.",
    send: "STL, OBJ oder PLY senden …",
    max: "höchstens",
  },
  file: {
    title: "Planung als Datei",
    hint: "Die Datei enthält, wer die Planung wann und auf welchem CT erstellt hat, aber keine Patientendaten.",
    none: "Es gibt noch keine Planung.",
    out: "Planung als Datei speichern",
    outForSlicer: "Für 3D Slicer speichern",
    in: "Planung importieren …",
    replaces: "Eine importierte Planung ersetzt die angezeigte; „Rückgängig“ stellt sie wieder her.",
    otherCt: "Diese Planung entstand auf einem anderen CT",
    otherCtHint:
      "Ihre Kanäle können auf diesem CT falsch liegen. Importieren Sie die Planung nur, wenn beide CTs denselben Patienten in derselben Lage zeigen, und prüfen Sie jeden Kanal.",
    takeAllTheSame: "Trotzdem importieren",
  },
};

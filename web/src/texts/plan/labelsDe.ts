import type { labelsEn } from "./labelsEn";

export const labelsDe: typeof labelsEn = {
  labels: {
    title: "Labels der Wirbel",
    hint: "Eine Segmentierung dieses CTs durch TotalSegmentator oder ein anderes Programm zeigt die Höhen in den Schichten, zählt sie ein zweites Mal und misst beide Pedikel ohne Tippen.",
    buttons: { file: "Segmentierung wählen", folder: "Ordner wählen" },
    cut: "vom Rand des CTs abgeschnitten",
    show: "Labels in den Schichten zeigen",
    measureBoth: "Beide Pedikel messen",
  },
};

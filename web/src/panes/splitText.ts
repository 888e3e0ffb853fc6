// Components of offset and angle along the patient's directions, in words. Pure.
import type { Reading } from "../live/reading";
import { formatNumber } from "../live/rounding";
import type { Texts } from "../texts/en";

export type SplitPart = "entry" | "angle";

export function splitOf({ deviation }: Reading, part: SplitPart, texts: Texts): string[] {
  const { side } = texts.theatre;
  switch (part) {
    case "entry":
      return [
        signed(deviation.entry_lateral_mm, " mm", side.lateral, side.medial),
        signed(deviation.entry_cranial_mm, " mm", side.cranial, side.caudal),
      ];
    case "angle":
      return [
        signed(deviation.angle_medial_deg, "°", side.medial, side.lateral),
        signed(deviation.angle_cranial_deg, "°", side.cranial, side.caudal),
      ];
  }
}

/** A component's size with its direction; no direction if it rounds to zero. */
function signed(value: number | null, unit: string, positive: string, negative: string): string {
  if (value === null) return "";
  const size = formatNumber(Math.abs(value));
  if (Number(value.toFixed(1)) === 0) return `${size}${unit}`;
  return `${size}${unit} ${value > 0 ? positive : negative}`;
}

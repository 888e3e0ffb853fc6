import { NumberInput } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";

export interface ShapeMm {
  diameterMm: number | string;
  lengthMm: number | string;
}

/** Parses the shape; null if the numbers are not plausible. */
export function isShape({ diameterMm, lengthMm }: ShapeMm): { diameterMm: number; lengthMm: number } | null {
  if (typeof diameterMm !== "number" || typeof lengthMm !== "number") return null;
  return diameterMm > 0 && diameterMm <= 100 && lengthMm > 0 && lengthMm <= 1000
    ? { diameterMm, lengthMm }
    : null;
}

/** Diameter and length of the tool, which pivoting cannot measure. */
export function Shape({
  shape,
  onChange,
}: {
  shape: ShapeMm;
  onChange: (shape: ShapeMm) => void;
}): ReactNode {
  const texts = useTexts().tool;
  return (
    <div className="row">
      <NumberInput
        hideControls
        inputMode="decimal"
        className="grow"
        size="lg"
        label={`${texts.diameter} (mm)`}
        description={texts.diameterHint}
        min={0.1}
        max={100}
        step={0.5}
        decimalScale={2}
        value={shape.diameterMm}
        onChange={(diameterMm) => {
          onChange({ ...shape, diameterMm });
        }}
      />
      <NumberInput
        hideControls
        inputMode="decimal"
        className="grow"
        size="lg"
        label={`${texts.length} (mm)`}
        description={texts.lengthHint}
        min={1}
        max={1000}
        step={5}
        decimalScale={1}
        value={shape.lengthMm}
        onChange={(lengthMm) => {
          onChange({ ...shape, lengthMm });
        }}
      />
    </div>
  );
}

import type { ReactNode } from "react";
import type { AccuracyTestMessage } from "../../api";
import type { CertificateTexts } from "../../texts/certificate/en";
import { interpolate } from "../../texts/interpolate";

const POSTURES = 3;

interface PlatePictureProps {
  test: AccuracyTestMessage;
  texts: CertificateTexts["guided"];
}

/** The plate as it lies on the table, x right and y down, with the divot that is due. */
export function PlatePicture({ test, texts }: PlatePictureProps): ReactNode {
  const { divots, due } = test;
  const xs = divots.map((one) => one.x_mm);
  const ys = divots.map((one) => one.y_mm);
  const [left, top] = [Math.min(...xs), Math.min(...ys)];
  const [width, height] = [Math.max(...xs) - left, Math.max(...ys) - top];
  const size = Math.max(width, height);
  const pad = size / 6;
  const box = [left - pad, top - pad, width + 2 * pad, height + 2 * pad].map(String).join(" ");
  const label = due === null ? texts.plateDone : interpolate(texts.plate, { divot: due.divot });
  return (
    <svg className="plate-picture" viewBox={box} role="img" aria-label={label} data-testid="plate">
      {divots.map((one) => {
        const state = one.name === due?.divot ? "due" : one.taken >= POSTURES ? "done" : "open";
        return (
          <g key={one.name} data-state={state}>
            <circle cx={one.x_mm} cy={one.y_mm} r={size / (state === "due" ? 11 : 16)} />
            <text x={one.x_mm} y={one.y_mm} fontSize={size / 14}>
              {state === "done" ? "✓" : one.name}
            </text>
          </g>
        );
      })}
    </svg>
  );
}

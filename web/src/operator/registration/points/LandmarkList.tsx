import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { useTexts } from "../../../texts/TextsContext";
import type { Points } from "./PointsWork";

interface LandmarkListProps {
  points: Points;
  wanted: string | null;
  onPick: (landmark: string) => void;
  onUse: (landmark: string, used: boolean) => void;
  onForget: (landmark: string) => void;
}

/** Landmarks with their residuals; a tap selects one for capture. */
export function LandmarkList({ points, wanted, onPick, onUse, onForget }: LandmarkListProps): ReactNode {
  const texts = useTexts().registration.points;
  const outliers = new Set(points.missing.flatMap((one) => one.context["possible_outliers"] ?? []));
  return (
    <ul className="landmarks" aria-label={texts.landmarks}>
      {points.landmarks.map((one) => (
        <li
          key={one.name}
          data-touched={one.touched}
          data-used={one.used}
          data-strays={outliers.has(one.name) || undefined}
          data-testid={`landmark-${one.name}`}
        >
          <button
            type="button"
            className="landmark-name"
            aria-pressed={one.name === wanted}
            onClick={() => {
              onPick(one.name);
            }}
          >
            <span aria-hidden="true">{one.touched ? (one.used ? "✓" : "–") : "○"}</span>
            <span>
              {one.name}
              <small>{landmarkText(one, texts)}</small>
            </span>
          </button>
          {one.touched && (
            <span className="landmark-buttons">
              <Button
                size="md"
                variant="default"
                onClick={() => {
                  onUse(one.name, !one.used);
                }}
              >
                {one.used ? texts.leaveOut : texts.takeIn}
              </Button>
              <Button
                size="md"
                variant="default"
                aria-label={`${texts.forget}: ${one.name}`}
                onClick={() => {
                  onForget(one.name);
                }}
              >
                ✕
              </Button>
            </span>
          )}
        </li>
      ))}
    </ul>
  );
}

function landmarkText(
  one: Points["landmarks"][number],
  texts: { notTouched: string; residual: string; leftOutBy: string; noFit: string; notUsed: string },
): string {
  if (!one.touched) return texts.notTouched;
  const far =
    one.residual_mm === null ? texts.noFit : `${texts.residual} ${formatNumber(one.residual_mm, 2)} mm`;
  const others =
    one.leave_one_out_mm === null ? "" : ` · ${texts.leftOutBy} ${formatNumber(one.leave_one_out_mm, 2)} mm`;
  return one.used ? `${far}${others}` : `${texts.notUsed} · ${far}`;
}

import type { ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { useTexts } from "../../../texts/TextsContext";
import { LEVELS, levelOf } from "../drawing/clearance";
import { usePlanning } from "../state/PlanContext";
import type { Side } from "../state/shape";

/** Least clearance of the screw with its depth, and the legend of its parts on the slices. */
export function ClearanceNote({ vertebra, side }: { vertebra: string; side: Side }): ReactNode {
  const texts = useTexts().plan.screw;
  const { clearances } = usePlanning();
  const clearance = clearances?.of(vertebra, side) ?? null;
  if (clearances === null || clearance === null) return <p className="soft">{texts.clearanceWaiting}</p>;
  if (clearance.kind === "absent") {
    return (
      <p className="soft" data-testid="clearance">
        {texts.noClearance[clearance.reason]}
      </p>
    );
  }
  const margin = `${formatNumber(clearances.marginMm, 1)} mm`;
  return (
    <div className="clearance-note">
      <p data-testid="clearance" data-clearance={levelOf(clearance.min_mm, clearances.marginMm)}>
        {texts.minimum} <strong>{formatNumber(clearance.min_mm, 1)} mm</strong> {texts.atDepth}{" "}
        {formatNumber(clearance.min_depth_mm, 0)} mm, {texts.against[clearance.against]}
      </p>
      <ul className="clearance-legend" aria-label={texts.legend}>
        {LEVELS.map((level) => (
          <li key={level}>
            <svg aria-hidden="true" focusable="false" className="draw-screw" data-clearance={level}>
              <path d="M 4 10 H 40" />
            </svg>
            {texts.level[level]} {(level === "ample" || level === "low") && margin}
          </li>
        ))}
      </ul>
    </div>
  );
}

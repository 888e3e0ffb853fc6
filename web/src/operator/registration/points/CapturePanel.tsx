import type { ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";
import { CaptureProgress } from "../CaptureProgress";
import { interpolate } from "../../../texts/interpolate";
import { ToolSeen } from "../ToolSeen";
import type { Points } from "./PointsWork";

interface CapturePanelProps {
  points: Points;
  wanted: string | null;
}

/** The current landmark with the state of its capture. */
export function CapturePanel({ points, wanted }: CapturePanelProps): ReactNode {
  const texts = useTexts().registration;
  const { capture, limits } = points;
  const touched = points.landmarks.filter((one) => one.touched).length;
  return (
    <section className="card capture">
      <p>
        {interpolate(texts.points.count, {
          touched,
          all: points.landmarks.length,
          min: limits.min_points,
        })}
      </p>
      <h3 data-testid="wanted">{wanted ?? texts.points.enough}</h3>
      <ToolSeen tool={points.tool} />
      {capture !== null && <CaptureProgress capture={capture} maxSpreadMm={limits.max_spread_mm} />}
      <p className="quiet">{texts.points.hold}</p>
    </section>
  );
}

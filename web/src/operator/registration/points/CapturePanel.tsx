import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { Icon } from "../../../panes/Icon";
import { useTexts } from "../../../texts/TextsContext";
import { CaptureProgress } from "../CaptureProgress";
import { interpolate } from "../../../texts/interpolate";
import { ToolSeen } from "../ToolSeen";
import type { Points } from "./PointsWork";

interface CapturePanelProps {
  points: Points;
  wanted: string | null;
  busy: boolean;
  /** The landmark captured last. */
  last: string | null;
  onCapture: (landmark: string) => void;
  onUndo: (landmark: string) => void;
}

/** The current landmark with its capture button. */
export function CapturePanel({
  points,
  wanted,
  busy,
  last,
  onCapture,
  onUndo,
}: CapturePanelProps): ReactNode {
  const texts = useTexts().registration;
  const { capture, limits } = points;
  const touched = points.landmarks.filter((one) => one.touched).length;
  const looking = capture?.state === "looking";
  const again = points.landmarks.some((one) => one.name === wanted && one.touched);
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
      <div className="row">
        <Button
          size="xl"
          className="grow"
          disabled={wanted === null || looking}
          loading={busy}
          data-testid="capture"
          onClick={() => {
            if (wanted !== null) onCapture(wanted);
          }}
        >
          {again ? texts.points.captureAgain : texts.points.capture}
        </Button>
        <Button
          size="xl"
          variant="default"
          disabled={last === null || looking || busy}
          data-testid="undo-last"
          onClick={() => {
            if (last !== null) onUndo(last);
          }}
        >
          <Icon name="undo" /> {texts.points.undo}
        </Button>
      </div>
      <p className="quiet">{texts.points.hold}</p>
    </section>
  );
}

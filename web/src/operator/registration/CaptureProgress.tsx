import { Progress } from "@mantine/core";
import type { ReactNode } from "react";
import { formatNumber } from "../../live/rounding";
import { Rejection } from "../../rest/client";
import type { CaptureMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { interpolate } from "../../texts/interpolate";
import { captureText } from "./captureText";
import { RegistrationRejection } from "./RegistrationRejection";

interface CaptureProgressProps {
  capture: CaptureMessage;
  maxSpreadMm: number;
}

/** Progress and spread of a capture, or why it was rejected. */
export function CaptureProgress({ capture, maxSpreadMm }: CaptureProgressProps): ReactNode {
  const texts = useTexts().registration.capture;
  if (capture.state === "rejected" && capture.problem !== null)
    return (
      <div data-testid="capture-rejected">
        <p>
          ▲ <strong>{capture.landmark}</strong>: {texts.rejected}
        </p>
        <RegistrationRejection rejection={new Rejection(capture.problem)} />
      </div>
    );
  if (capture.state === "taken") {
    const worst = Math.max(...(capture.spread_mm ?? [0]));
    return (
      <p className="good" role="status" data-testid="captured">
        ✓ <strong>{capture.landmark}</strong>{" "}
        {interpolate(texts.taken, {
          images: capture.images,
          spread: formatNumber(worst, 2),
          max: formatNumber(maxSpreadMm, 2),
        })}
      </p>
    );
  }
  const share = Math.min(100, (100 * capture.images) / Math.max(1, capture.wanted));
  return (
    <div role="status" data-testid="capturing">
      <p>
        ● <strong>{capture.landmark}</strong> {captureText(capture, texts)}
      </p>
      <Progress value={share} size="xl" aria-label={texts.images} />
    </div>
  );
}

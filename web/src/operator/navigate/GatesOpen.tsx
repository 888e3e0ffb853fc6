import type { ReactNode } from "react";
import { useProcedure, type Step } from "../../app/procedure";
import { formatNumber } from "../../live/rounding";
import { interpolate } from "../../texts/interpolate";
import { useTexts } from "../../texts/TextsContext";
import { openSteps } from "./openSteps";

/** That all steps are valid, with the result of the check; nothing while one is due. */
export function GatesOpen(): ReactNode {
  const texts = useTexts().navigate;
  const steps = useProcedure().data?.steps ?? [];
  const check = steps.find((one) => one.step === "check");
  if (openSteps(steps).length > 0) return null;
  return (
    <p className="step-said good" role="status" data-testid="gates-open">
      ✓ {texts.open} {check !== undefined && checkSaid(texts.checked, check.numbers)}
    </p>
  );
}

/** Landmark and distance of the check; empty if they are missing. */
function checkSaid(texts: string, { landmark, distance_mm, max_mm }: Step["numbers"]): string {
  if (typeof landmark !== "string" || typeof distance_mm !== "number" || typeof max_mm !== "number")
    return "";
  return interpolate(texts, { landmark, mm: formatNumber(distance_mm, 1), max: formatNumber(max_mm, 1) });
}

import type { ReactNode } from "react";
import { useLocation } from "wouter";
import { useLive } from "../live/LiveContext";
import { proposedChannel } from "../live/proposedChannel";
import { useSides } from "../operator/registration/useSides";
import { interpolate } from "../texts/interpolate";
import { useTexts } from "../texts/TextsContext";

/** Another planned channel that the drill is nearer to; empty without one. */
export function ProposedChannel(): ReactNode {
  const texts = useTexts().numbers;
  const sideName = useSides();
  const [path] = useLocation();
  const proposed = proposedChannel(useLive().view);
  // The page on which it is switched does not refer to itself.
  const where = path === "/operator/navigate" ? texts.switchBelow : texts.switchUnderNavigation;
  return (
    <p className="state-proposal" data-testid="proposed-channel">
      {proposed !== null &&
        `${interpolate(texts.nearerTo, { channel: `${proposed.vertebra} ${sideName(proposed.side)}` })} · ${where}`}
    </p>
  );
}

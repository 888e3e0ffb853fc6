import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { proposedChannel } from "../live/proposedChannel";
import { useSides } from "../operator/registration/useSides";
import { interpolate } from "../texts/interpolate";
import { useTexts } from "../texts/TextsContext";

/** Another planned channel that the drill is nearer to; empty without one. */
export function ProposedChannel(): ReactNode {
  const texts = useTexts().numbers;
  const sideName = useSides();
  const proposed = proposedChannel(useLive().view);
  return (
    <p className="state-proposal" data-testid="proposed-channel">
      {proposed !== null &&
        interpolate(texts.nearerTo, { channel: `${proposed.vertebra} ${sideName(proposed.side)}` })}
    </p>
  );
}

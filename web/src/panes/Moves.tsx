import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { useTexts } from "../texts/TextsContext";

/** How movements of patient or camera are detected; an empty line while unknown, so that nothing else moves. */
export function Moves(): ReactNode {
  const texts = useTexts();
  const { view } = useLive();
  const stale = !view.numbers.live && view.numbers.cause !== "unread";
  const moves = view.newest?.snapshot?.motion.motion_detected_by ?? null;
  if (moves === null || stale) return <p className="moves" />;
  return (
    <p className="moves" data-moves={moves} data-testid="moves">
      {moves !== "reference" && <span aria-hidden="true">▲ </span>}
      {texts.moves[moves]}
    </p>
  );
}

import { useRef, type ReactNode } from "react";
import { OPENED } from "../hub/openedTheatre";
import { setText } from "../panes/setText";
import { useTexts } from "../texts/TextsContext";
import type { PictureDelivery } from "./pictureDelivery";
import { usePainter } from "./LiveContext";
import { formatNumber } from "./rounding";
import type { ConnectionTexts } from "../texts/connection/en";

/** States when the picture is reduced or few images arrive; empty otherwise. */
export function ConnectionNote(): ReactNode {
  const { connection: connectionTexts } = useTexts();
  const note = useRef<HTMLParagraphElement>(null);
  usePainter(({ video, pictureDelivery }) => {
    // A hub's pictures are few and small by design.
    const isShown = video.live && OPENED === null;
    setText(note.current, isShown ? connectionText(pictureDelivery, connectionTexts) : "");
  });
  return <p className="line-note" data-testid="line-note" ref={note} />;
}

/** "Slow connection: 4 images/s, 640x360"; empty at full rate and size. */
function connectionText(
  { limitedBy, imagesPerS, widthPx, heightPx }: PictureDelivery,
  texts: ConnectionTexts,
): string {
  if (limitedBy === null || widthPx === null || heightPx === null) return "";
  const size = `${widthPx}x${heightPx}`;
  if (limitedBy === "reduced") return `${texts.reduced}: ${size}`;
  return `${texts[limitedBy]}: ${formatNumber(imagesPerS, 0)} ${texts.rate}, ${size}`;
}

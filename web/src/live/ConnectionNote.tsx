import { useRef, type ReactNode } from "react";
import { OPENED } from "../hub/openedTheatre";
import { setText } from "../panes/setText";
import { useTexts } from "../texts/TextsContext";
import type { PictureDelivery } from "./pictureDelivery";
import { usePainter } from "./LiveContext";
import type { Texts } from "../texts/en";
import { pluralize } from "../texts/pluralize";

/** States when the picture is reduced or few images arrive; empty otherwise. */
export function ConnectionNote(): ReactNode {
  const texts = useTexts();
  const note = useRef<HTMLParagraphElement>(null);
  usePainter(({ video, pictureDelivery }) => {
    // A hub's pictures are few and small by design.
    const isShown = video.live && OPENED === null;
    setText(note.current, isShown ? connectionText(pictureDelivery, texts) : "");
  });
  return <p className="line-note" data-testid="line-note" ref={note} />;
}

/** "Slow connection: 4 images/s, 640x360"; empty at full rate and size. */
function connectionText(
  { limitedBy, imagesPerS, widthPx, heightPx }: PictureDelivery,
  { connection: texts, language }: Texts,
): string {
  if (limitedBy === null || widthPx === null || heightPx === null) return "";
  const size = `${widthPx}x${heightPx}`;
  if (limitedBy === "reduced") return `${texts.reduced}: ${size}`;
  return `${texts[limitedBy]}: ${pluralize(texts.rate, Math.round(imagesPerS), language)}, ${size}`;
}

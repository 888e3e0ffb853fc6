import { useRef, type ReactNode } from "react";
import { setText } from "../panes/setText";
import { useTexts } from "../texts/TextsContext";
import type { Carried } from "./carried";
import { usePainter } from "./LiveContext";
import { shownNumber } from "./rounding";
import type { ConnectionTexts } from "../texts/connection/en";

/** Says in words when the picture is reduced or few images come; empty otherwise. */
export function LineNote(): ReactNode {
  const { connection: line } = useTexts();
  const note = useRef<HTMLParagraphElement>(null);
  usePainter(({ video, carried }) => {
    setText(note.current, video.live ? lineText(carried, line) : "");
  });
  return <p className="line-note" data-testid="line-note" ref={note} />;
}

/** "Thin line: 4 images/s, 640x360"; nothing where all that the camera gives comes in full. */
export function lineText({ little, imagesPerS, widthPx, heightPx }: Carried, texts: ConnectionTexts): string {
  if (little === null || widthPx === null || heightPx === null) return "";
  const size = `${widthPx}x${heightPx}`;
  if (little === "reduced") return `${texts.reduced}: ${size}`;
  return `${texts[little]}: ${shownNumber(imagesPerS, 0)} ${texts.rate}, ${size}`;
}

import { useRef, type ReactNode } from "react";
import { setText } from "../panes/setText";
import { useWords } from "../words/WordsContext";
import type { Carried } from "./carried";
import { usePainter } from "./LiveContext";
import { shownNumber } from "./rounding";
import type { LineWords } from "../words/line/en";

/** Says in words when the picture is reduced or few images come; empty otherwise. */
export function LineNote(): ReactNode {
  const { line } = useWords();
  const note = useRef<HTMLParagraphElement>(null);
  usePainter(({ video, carried }) => {
    setText(note.current, video.live ? lineText(carried, line) : "");
  });
  return <p className="line-note" data-testid="line-note" ref={note} />;
}

/** "Thin line: 4 images/s, 640x360"; nothing where all that the camera gives comes in full. */
export function lineText({ little, imagesPerS, widthPx, heightPx }: Carried, words: LineWords): string {
  if (little === null || widthPx === null || heightPx === null) return "";
  const size = `${widthPx}x${heightPx}`;
  if (little === "reduced") return `${words.reduced}: ${size}`;
  return `${words[little]}: ${shownNumber(imagesPerS, 0)} ${words.rate}, ${size}`;
}

import type { ReactNode, Ref } from "react";
import type { Reading } from "../live/reading";
import type { Texts } from "../texts/en";
import { useTexts } from "../texts/TextsContext";
import { setText } from "./setText";
import { splitOf, type SplitPart } from "./splitText";

const PARTS: readonly SplitPart[] = ["entry", "angle"];

/** Directions of the drill's deviation at the entry and of its axis, in words. */
export function Split({ ref }: { ref: Ref<HTMLDListElement> }): ReactNode {
  const texts = useTexts();
  return (
    <dl className="split" ref={ref} data-testid="split">
      {PARTS.map((name) => (
        <div key={name} data-split={name}>
          <dt>{texts.theatre.split[name]}</dt>
          <dd data-line="0" />
          <dd data-line="1" />
        </div>
      ))}
    </dl>
  );
}

export function paintSplit(list: HTMLElement | null, reading: Reading | null, texts: Texts): void {
  for (const name of PARTS) {
    const lines = reading === null ? [] : splitOf(reading, name, texts);
    for (const index of [0, 1]) {
      const line = list?.querySelector(`[data-split=${name}] [data-line="${index}"]`) ?? null;
      setText(line, lines[index] ?? "");
    }
  }
}

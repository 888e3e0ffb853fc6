import { useRef, type ReactNode } from "react";
import { usePainter } from "../live/LiveContext";
import type { View } from "../live/live";
import { shownDuration, shownNumber } from "../live/rounding";
import { setData, setText } from "../panes/setText";
import { useWords } from "../words/WordsContext";

const PARTS = ["picture", "numbers", "scene", "line"] as const;
type Part = (typeof PARTS)[number];
type Ages = Record<Part, { live: boolean; text: string }>;

/** The true age of everything that is shown here, measured on this page. */
export function AgesStrip(): ReactNode {
  const words = useWords().supervisor.ages;
  const strip = useRef<HTMLDListElement>(null);
  usePainter((view) => {
    const ages = agesOf(view, words);
    for (const part of PARTS) {
      const fact = strip.current?.querySelector<HTMLElement>(`[data-part=${part}]`) ?? null;
      setData(fact, "live", String(ages[part].live));
      setText(fact?.querySelector("dd") ?? null, `${ages[part].live ? "●" : "▲"} ${ages[part].text}`);
    }
  });
  return (
    <dl className="ages" aria-label={words.title} data-testid="ages" ref={strip}>
      {PARTS.map((part) => (
        <div key={part} data-part={part} data-live="false">
          <dt>{words[part]}</dt>
          <dd>—</dd>
        </div>
      ))}
    </dl>
  );
}

function agesOf({ video, numbers, scene, link }: View, words: Record<string, string>): Ages {
  const gone = words["gone"] ?? "";
  const old = (ageMs: number | null): string => (ageMs === null ? gone : `${gone}, ${shownDuration(ageMs)}`);
  return {
    picture: { live: video.live, text: video.live ? `${shownNumber(video.ageMs, 0)} ms` : old(video.ageMs) },
    numbers: {
      live: numbers.live,
      text: numbers.live ? `${shownNumber(numbers.ageMs, 0)} ms` : old(numbers.ageMs),
    },
    scene:
      scene.state === "live"
        ? { live: true, text: `${shownNumber(scene.ageMs, 0)} ms` }
        : { live: false, text: scene.state === "stale" ? old(scene.ageMs) : (words["notShown"] ?? "") },
    line: { live: link === "open", text: (link === "open" ? words["good"] : words["lost"]) ?? "" },
  };
}

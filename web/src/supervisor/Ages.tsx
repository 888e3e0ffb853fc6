import { useRef, type ReactNode } from "react";
import { usePainter } from "../live/LiveContext";
import type { View } from "../live/live";
import { formatDuration, formatNumber } from "../live/rounding";
import { PaintRateLimiter } from "../panes/paintRateLimiter";
import { setData, setText } from "../panes/setText";
import { useTexts } from "../texts/TextsContext";

const PARTS = ["picture", "numbers", "scene", "line"] as const;
type Part = (typeof PARTS)[number];
type Ages = Record<Part, { live: boolean | "loading"; mark: string; text: string }>;

/** Ages of everything on display, measured on this page. */
export function AgesStrip(): ReactNode {
  const { supervisor, rest } = useTexts();
  const texts = supervisor.ages;
  const strip = useRef<HTMLDListElement>(null);
  const limiter = useRef(new PaintRateLimiter());
  usePainter((view) => {
    const ages = agesOf(view, texts, rest.loading);
    const states = PARTS.map((part) => `${ages[part].mark}${ages[part].live}`).join(" ");
    if (!limiter.current.isDue(view.nowMs, `${texts.title} ${states}`)) return;
    for (const part of PARTS) {
      const fact = strip.current?.querySelector<HTMLElement>(`[data-part=${part}]`) ?? null;
      setData(fact, "live", String(ages[part].live));
      setText(fact?.querySelector("dd") ?? null, `${ages[part].mark} ${ages[part].text}`);
    }
  });
  return (
    <dl className="ages" aria-label={texts.title} data-testid="ages" ref={strip}>
      {PARTS.map((part) => (
        <div key={part} data-part={part} data-live="false">
          <dt>{texts[part]}</dt>
          <dd>—</dd>
        </div>
      ))}
    </dl>
  );
}

function agesOf(
  { video, numbers, scene, link, firstMessage }: View,
  texts: Record<string, string>,
  loading: string,
): Ages {
  if (firstMessage === "awaited") {
    const awaited = { live: "loading" as const, mark: "◌", text: loading };
    return { picture: awaited, numbers: awaited, scene: awaited, line: awaited };
  }
  const say = (key: string): string => texts[key] ?? "";
  const young = (ageMs: number): Ages[Part] => ({
    live: true,
    mark: "●",
    text: `${formatNumber(ageMs, 0)} ms`,
  });
  const gone = (ageMs: number | null): Ages[Part] => ({
    live: false,
    mark: "▲",
    text: ageMs === null ? say("gone") : `${say("gone")}, ${formatDuration(ageMs)}`,
  });
  const stands = link === "open" && firstMessage === "received";
  return {
    picture: video.live ? young(video.ageMs) : gone(video.ageMs),
    numbers: numbers.live ? young(numbers.ageMs) : gone(numbers.ageMs),
    scene:
      scene.state === "live"
        ? young(scene.ageMs)
        : scene.state === "stale"
          ? gone(scene.ageMs)
          : { live: false, mark: "○", text: say("notShown") },
    line: { live: stands, mark: stands ? "●" : "▲", text: say(stands ? "good" : "lost") },
  };
}

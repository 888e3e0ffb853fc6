// The judgement of a drill in words. Pure, so that it is tested without a page.
import type { ClosestMessage, JudgementMessage, Verdict } from "../live/messages";
import { shownFigure, shownNumber, shownPercent } from "../live/rounding";
import type { Words } from "../words/en";

/** A shape of its own for each, as in the video: the colour says nothing that the shape does not. */
export const VERDICT_SYMBOL: Record<Verdict, string> = { on: "●", off: "▲", unsure: "◆", through: "✖" };

/** "UNSURE ±1.9 of 1.2 mm": what is not sure enough, and what the pedicle leaves. */
export function verdictText(judgement: JudgementMessage, words: Words): string {
  const word = words.verdict[judgement.verdict];
  if (judgement.verdict !== "unsure") return word;
  const { entry_95_mm: entry, isthmus_95_mm: isthmus, room_mm: room } = judgement.certain;
  const worst = entry === null || isthmus === null ? null : Math.max(entry, isthmus);
  return `${word} ±${shownNumber(worst)} ${words.wall.of} ${shownNumber(room)} mm`;
}

/** What comes if the direction is kept. */
export function aheadText(judgement: JudgementMessage, words: Words): string {
  const { chance, clearance } = judgement;
  const through = [
    `${words.wall.now} ${shownPercent(chance.now_ratio)}`,
    `${words.wall.soon} ${shownPercent(chance.soon_ratio)}`,
    `${words.wall.atEnd} ${shownPercent(chance.at_end_ratio)}`,
  ];
  const end = clearance.at_end;
  const grade = end.kind === "nearest" ? ` · ${words.wall.atEnd} ${words.wall.grade} ${end.grade}` : "";
  return `${words.wall.through}: ${through.join(", ")}${grade}`;
}

/** Which wall is meant. */
export function wallSide(judgement: JudgementMessage, words: Words): string {
  const { now } = judgement.clearance;
  return now.kind === "not-entered" ? words.wall.notEntered : words.wall.side[now.wall];
}

/** What the wall was measured against, and what is left of it a little further on. */
export function wallAhead(judgement: JudgementMessage, words: Words): string {
  const { soon, against } = judgement.clearance;
  const left = soon.kind === "nearest" ? ` · ${words.wall.soon} ${shownFigure(soon.clearance_mm)} mm` : "";
  return `${words.wall.against[against]}${left}`;
}

export function clearanceMm(closest: ClosestMessage): number | null {
  return closest.kind === "nearest" ? closest.clearance_mm : null;
}

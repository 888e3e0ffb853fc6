import type { ReactNode } from "react";
import { shownFigure } from "../../../live/rounding";
import type { components } from "../../../schema";
import { useWords } from "../../../words/WordsContext";

/** Every nudge that holds, the newest first: what, who, when. */
export function NudgeLog({ nudges }: { nudges: components["schemas"]["KeptNudge"][] }): ReactNode {
  const words = useWords().registration.nudges;
  if (nudges.length === 0) return <p className="quiet">{words.logEmpty}</p>;
  return (
    <ol className="nudge-log card" reversed aria-label={words.log} data-testid="nudge-log">
      {nudges.toReversed().map((one) => {
        const shift = one.kind === "shift";
        const way = words[shift ? "shiftTo" : "turnTo"][one.axis][one.amount > 0 ? "plus" : "minus"];
        return (
          <li key={`${one.made_at} ${one.axis}`}>
            <strong>
              {shownFigure(Math.abs(one.amount), 1)} {shift ? "mm" : "°"} {way}
            </strong>{" "}
            <small>
              {one.made_by} · {new Date(one.made_at).toLocaleTimeString()}
            </small>
          </li>
        );
      })}
    </ol>
  );
}

import type { ReactNode } from "react";
import { formatFigure } from "../../../live/rounding";
import type { NudgeRecord } from "../../../api";
import { useTexts } from "../../../texts/TextsContext";
import { formatSecond } from "../../parts/format";

/** Valid nudges, newest first: what, who, when. */
export function NudgeLog({ nudges }: { nudges: NudgeRecord[] }): ReactNode {
  const all = useTexts();
  const texts = all.registration.nudges;
  if (nudges.length === 0) return <p className="quiet">{texts.logEmpty}</p>;
  return (
    <ol className="nudge-log card" reversed aria-label={texts.log} data-testid="nudge-log">
      {nudges.toReversed().map((one) => {
        const shift = one.kind === "shift";
        const way = texts[shift ? "shiftTo" : "turnTo"][one.axis][one.amount > 0 ? "plus" : "minus"];
        return (
          <li key={`${one.made_at} ${one.axis}`}>
            <strong>
              {formatFigure(Math.abs(one.amount), 1)} {shift ? "mm" : "°"} {way}
            </strong>{" "}
            <small>
              {one.made_by} · {formatSecond(one.made_at, all.language)}
            </small>
          </li>
        );
      })}
    </ol>
  );
}

import type { ReactNode } from "react";
import type { Reading } from "../live/reading";
import { shownFigure, shownNumber } from "../live/rounding";
import type { Words } from "../words/en";
import { useWords } from "../words/WordsContext";
import { figureOf, type Figure, type FigureName, type Standing } from "./limits";
import { setData, setText } from "./setText";
import { wallSide } from "./verdictText";

const REMOVED = "—";
const MARKS: Record<Standing, string> = { within: "", over: "▲ ", through: "▲▲▲ " };

/** One big number, its unit, and its limit under it. */
export function FigureTile({ name }: { name: FigureName }): ReactNode {
  const words = useWords();
  return (
    <div className="reading" data-reading={name} data-standing="none">
      <p className="reading-name">
        <span>{words.reading[name].name}</span> <small data-part="hint" />{" "}
        <span className="unit">{words.reading[name].unit}</span>
      </p>
      <p className="reading-value">
        <output data-part="value" data-testid={`reading-${name}`} aria-live="off">
          {REMOVED}
        </output>
      </p>
      <p className="reading-limit" data-testid={`limit-${name}`}>
        {name === "depth" && (
          <span className="to-go">
            {words.reading.toGo.name}{" "}
            <output data-part="to-go" data-testid="reading-toGo" aria-live="off">
              {REMOVED}
            </output>{" "}
          </span>
        )}
        <span data-part="limit" />
      </p>
    </div>
  );
}

/** Paints past React's state. */
export function paintFigure(
  pane: HTMLElement | null,
  name: FigureName,
  reading: Reading | null,
  warningMm: number | null,
  words: Words,
): void {
  const tile = pane?.querySelector<HTMLElement>(`[data-reading=${name}]`);
  if (!tile) return;
  const figure = reading === null ? null : figureOf(reading, name, warningMm);
  setText(tile.querySelector("[data-part=value]"), figure ? shownFigure(figure.value) : REMOVED);
  setText(tile.querySelector("[data-part=limit]"), figure ? limitText(figure, name, words) : "");
  setText(tile.querySelector("[data-part=hint]"), hintOf(reading, name, words));
  setData(tile, "standing", figure?.standing ?? "none");
  if (name === "depth") {
    const toGo = reading === null ? REMOVED : shownFigure(reading.deviation.remaining_mm);
    setText(tile.querySelector("[data-part=to-go]"), toGo);
  }
}

function limitText({ limit, standing }: Figure, name: FigureName, words: Words): string {
  const { theatre, depthWords } = words;
  if (name === "depth" && standing === "through") return `${MARKS.through}${depthWords.past}`;
  if (limit === null) return "";
  const amount = shownNumber(limit);
  if (name === "depth") return `${theatre.of} ${amount}`;
  const mark = MARKS[standing];
  if (name === "wall") {
    if (standing === "within") return `${theatre.nearBelow} ${amount}`;
    return `${mark}${standing === "over" ? theatre.near : theatre.through}, ${theatre.limit} ${amount}`;
  }
  return standing === "over" ? `${mark}${theatre.over} ${amount}` : `${theatre.limit} ${amount}`;
}

/** Only what is not as it should be, or which wall is meant: everything else is known by heart. */
function hintOf(reading: Reading | null, name: FigureName, words: Words): string {
  if (reading === null) return "";
  const { deviation, judgement } = reading;
  if (name === "wall") return judgement === null ? "" : wallSide(judgement, words);
  if (name === "entry" && deviation.entry_offset_mm === null) return words.depthWords.across;
  return name === "depth" && deviation.depth_mm < 0 ? words.depthWords.before : "";
}

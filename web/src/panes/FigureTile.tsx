import type { ReactNode } from "react";
import type { FigureMessage, Status } from "../live/messages";
import type { Reading } from "../live/reading";
import { formatFigure, formatNumber } from "../live/rounding";
import type { Texts } from "../texts/en";
import { interpolate } from "../texts/interpolate";
import { useTexts } from "../texts/TextsContext";
import { figureOf, type FigureName } from "./limits";
import { setData, setText, setVariable } from "./setText";
import { wallSide } from "./verdictText";

const REMOVED = "—";
/** As in "12.3": a figure keeps its size while it has fewer. */
const MIN_GLYPHS = 4;
const MARKS: Record<Status, string> = {
  within: "",
  over: "▲ ",
  through: "▲▲▲ ",
  unlimited: "",
  outside: "",
};

/** One figure with its unit and limit; a large one stands out from the others. */
export function FigureTile({ name, isLarge = false }: { name: FigureName; isLarge?: boolean }): ReactNode {
  const texts = useTexts();
  return (
    <div className="reading" data-reading={name} data-status="none" data-large={isLarge}>
      <p className="reading-name">
        <span>{texts.reading[name].name}</span> <small data-part="hint" />{" "}
        <span className="unit">{texts.reading[name].unit}</span>
      </p>
      <p className="reading-value">
        <output data-part="value" data-testid={`reading-${name}`} aria-live="off">
          {REMOVED}
        </output>
        <canvas
          className="trend"
          data-trend={name}
          width={1}
          height={1}
          role="img"
          aria-label={interpolate(texts.numbers.trend, { figure: texts.reading[name].name })}
        />
      </p>
      <p className="reading-limit" data-testid={`limit-${name}`}>
        {name === "depth" && (
          <span className="to-go">
            {texts.reading.toGo.name}{" "}
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

/** Paints without React. */
export function paintFigure(
  pane: HTMLElement | null,
  name: FigureName,
  reading: Reading | null,
  texts: Texts,
): void {
  const tile = pane?.querySelector<HTMLElement>(`[data-reading=${name}]`);
  if (!tile) return;
  const figure = reading === null ? null : figureOf(reading, name);
  const value = figure ? formatFigure(figure.value) : REMOVED;
  setText(tile.querySelector("[data-part=value]"), value);
  // The figure's size depends on it, so that none of its digits is cut off.
  setVariable(tile, "--glyphs", String(Math.max(value.length, MIN_GLYPHS)));
  setText(tile.querySelector("[data-part=limit]"), figure ? limitText(figure, name, texts) : "");
  setText(tile.querySelector("[data-part=hint]"), hintOf(reading, name, texts));
  setData(tile, "status", figure?.status ?? "none");
  if (name === "depth") {
    const toGo = reading === null ? REMOVED : formatFigure(reading.assessment.figures.to_go.value);
    setText(tile.querySelector("[data-part=to-go]"), toGo);
  }
}

function limitText({ value, limit, status }: FigureMessage, name: FigureName, texts: Texts): string {
  const { theatre, depthTexts } = texts;
  if (name === "depth" && status === "through") return `${MARKS.through}${depthTexts.past}`;
  if (limit === null) return "";
  const amount = formatNumber(limit);
  // Before the entry more is to go than the length: 65.0 of 55.0.
  if (name === "depth") return (value ?? 0) < 0 ? "" : `${theatre.of} ${amount}`;
  const mark = MARKS[status];
  // The wall's limit is 0; this is the distance below which it is near.
  if (name === "wall") {
    if (status === "through") return `${mark}${theatre.through}`;
    return status === "over" ? `${mark}${theatre.near} ${amount}` : `${theatre.nearBelow} ${amount}`;
  }
  return status === "over" ? `${mark}${theatre.over} ${amount}` : `${theatre.limit} ${amount}`;
}

/** Shows only deviations, or which wall is meant. */
function hintOf(reading: Reading | null, name: FigureName, texts: Texts): string {
  if (reading === null) return "";
  const { assessment } = reading;
  if (name === "wall") return wallSide(assessment, texts);
  if (name === "entry" && assessment.figures.entry.value === null) return texts.depthTexts.across;
  return name === "depth" && (assessment.figures.depth.value ?? 0) < 0 ? texts.depthTexts.before : "";
}

import { useRef, type ReactNode } from "react";
import { usePainter } from "../live/LiveContext";
import { useTexts } from "../texts/TextsContext";
import { Pane } from "./Pane";
import { paintBullseye } from "./paintBullseye";
import { setData } from "./setText";
import { paintSplit, Split } from "./Split";

/** The drill as it is seen along the channel, of the same image as the numbers; empty when they are. */
export function BullseyePane(): ReactNode {
  const texts = useTexts();
  const stage = useRef<HTMLDivElement>(null);
  const svg = useRef<SVGSVGElement>(null);
  const split = useRef<HTMLDListElement>(null);

  usePainter(({ numbers }) => {
    const reading = numbers.live ? numbers.reading : null;
    const along = reading?.along ?? null;
    setData(stage.current, "live", String(along !== null));
    paintBullseye(svg.current, along, reading);
    paintSplit(split.current, reading, texts);
  });

  return (
    <Pane id="bullseye" title={texts.theatre.along}>
      <div className="bullseye-stage" data-testid="bullseye" data-live="false" ref={stage}>
        <svg ref={svg} viewBox="-1 -1 2 2" role="img" aria-label={texts.theatre.alongAlt}>
          <circle className="eye-border" data-part="border" />
          <g data-part="view">
            <circle className="eye-channel" data-part="channel" />
            <path className="eye-axis" data-part="axis" />
            <path className="eye-way" data-part="way" />
            <path className="eye-end" data-part="end" />
            <path className="eye-ellipse" data-part="ellipse" />
            <circle className="eye-drill" data-part="drill" />
            <circle className="eye-tip" data-part="tip" />
            <path className="eye-wall" data-part="wall" />
            <path className="eye-arrow" data-part="arrow" />
          </g>
          <text className="eye-letter" data-part="left">
            L
          </text>
          <text className="eye-letter" data-part="right">
            R
          </text>
          <text className="eye-letter" data-part="head">
            S
          </text>
        </svg>
        <p className="bullseye-none">{texts.theatre.alongNone}</p>
        <Split ref={split} />
      </div>
    </Pane>
  );
}

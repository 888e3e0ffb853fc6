import { useRef, type ReactNode } from "react";
import { usePainter } from "../live/LiveContext";
import { useTrend } from "../trend/useTrend";
import { useTexts } from "../texts/TextsContext";
import { FigureTile, paintFigure } from "./FigureTile";
import { FIGURES } from "./limits";
import { NumbersState } from "./NumbersState";
import { setData } from "./setText";

/** The surgeon's numbers with their limits, replaced by words when they are not live. */
export function NumbersPane(): ReactNode {
  const texts = useTexts();
  const pane = useRef<HTMLDivElement>(null);

  // Painted before the curves, which follow the figures.
  usePainter(({ numbers }) => {
    setData(pane.current, "live", String(numbers.live));
    setData(pane.current, "cause", numbers.live ? "" : numbers.cause);
    const reading = numbers.live ? numbers.reading : null;
    for (const name of FIGURES) paintFigure(pane.current, name, reading, texts);
  });

  useTrend(pane);

  return (
    <section className="pane pane-numbers" aria-labelledby="numbers-title">
      <h2 id="numbers-title" className="heard-only">
        {texts.numbers.title}
      </h2>
      <div className="numbers" data-testid="numbers" data-live="false" ref={pane}>
        <NumbersState />
        <div className="readings" id="numbers" tabIndex={-1}>
          {FIGURES.map((name) => (
            <FigureTile key={name} name={name} />
          ))}
        </div>
      </div>
    </section>
  );
}

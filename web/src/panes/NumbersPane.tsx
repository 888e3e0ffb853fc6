import { useRef, type ReactNode } from "react";
import { usePainter } from "../live/LiveContext";
import { useTrend } from "../trend/useTrend";
import { useTexts } from "../texts/TextsContext";
import { FigureTile, paintFigure } from "./FigureTile";
import { FIGURES, type FigureName } from "./limits";
import { NumbersState } from "./NumbersState";
import { setData } from "./setText";

interface NumbersPaneProps {
  /** Figures that are drawn larger than the others. */
  large?: readonly FigureName[];
  /** Shown below the headline. */
  beside?: ReactNode;
  /** Shown over the figures while they are withheld. */
  over?: ReactNode;
}

/** The surgeon's numbers with their limits, replaced by words when they are not live. */
export function NumbersPane({ large = [], beside, over }: NumbersPaneProps): ReactNode {
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
        <NumbersState>{beside}</NumbersState>
        {over}
        <div className="readings" id="numbers" tabIndex={-1}>
          {FIGURES.map((name) => (
            <FigureTile key={name} name={name} isLarge={large.includes(name)} />
          ))}
        </div>
      </div>
    </section>
  );
}

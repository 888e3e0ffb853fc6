import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import { FIGURES } from "./limits";

const NOTHING_YET = "\u00a0";

/** Placeholder for the numbers while the page is loading, of the same size. */
export function LoadingNumbers(): ReactNode {
  const texts = useTexts();
  return (
    <section className="pane pane-numbers" aria-label={texts.numbers.title} aria-busy="true">
      <div className="numbers">
        <div className="numbers-state">
          <p className="loading" data-testid="numbers-loading">
            {texts.rest.loading}
          </p>
        </div>
        <div className="readings" id="numbers" tabIndex={-1}>
          {FIGURES.map((name) => (
            <div className="reading" key={name}>
              <p className="reading-name">{texts.reading[name].name}</p>
              <p className="reading-value">{NOTHING_YET}</p>
              <p className="reading-limit">{NOTHING_YET}</p>
            </div>
          ))}
        </div>
      </div>
    </section>
  );
}

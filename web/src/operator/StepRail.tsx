import { useState, type ReactNode } from "react";
import { Link } from "wouter";
import { HelpButton } from "../help/HelpButton";
import { ThemeButton } from "../theme/ThemeButton";
import { interpolate } from "../texts/interpolate";
import { useTexts } from "../texts/TextsContext";
import { sentence } from "./parts/format";
import { PAGES, type OperatorPage } from "./pages";
import { useProcedure, type Step } from "../app/procedure";
import { MARK_OF_STATE } from "./stepMarks";
import { stateText } from "./stepTexts";

type Mark = Step["state"] | "none";

/** Links to the steps, with their states, and why one is no longer valid. On a phone a line, which a touch opens. */
export function StepRail({ now }: { now: OperatorPage | null }): ReactNode {
  const texts = useTexts().operator;
  const { data } = useProcedure();
  const [isOpen, setOpen] = useState(false);
  return (
    <nav className="rail" aria-label={texts.steps} data-open={isOpen}>
      <button
        type="button"
        className="rail-now"
        data-testid="rail-now"
        aria-expanded={isOpen}
        onClick={() => {
          setOpen(!isOpen);
        }}
      >
        {now === null ? (
          texts.steps
        ) : (
          <>
            {interpolate(texts.at, { at: PAGES.indexOf(now) + 1, all: PAGES.length })}{" "}
            <strong>{texts.page[now.name]}</strong>
          </>
        )}{" "}
        <span aria-hidden="true">{isOpen ? "▴" : "▾"}</span>
      </button>
      <div className="rail-steps">
        <ol>
          {PAGES.map((page) => {
            const step = data?.steps.find((one) => one.step === page.step) ?? null;
            const mark: Mark = step?.state ?? "none";
            const isNext = data?.case_id != null && data.next_step === page.step;
            return (
              <li key={page.name} data-state={mark} data-next={isNext || undefined}>
                <Link
                  href={`/operator/${page.name}`}
                  aria-current={page === now ? "step" : undefined}
                  data-testid={`step-${page.name}`}
                  onClick={() => {
                    setOpen(false);
                  }}
                >
                  <span className="rail-mark" aria-hidden="true">
                    {mark === "none" ? "" : MARK_OF_STATE[mark]}
                  </span>
                  <span className="rail-name">{texts.page[page.name]}</span>
                  <span className="rail-state">
                    {step === null ? "" : stateText(step, texts)}
                    {step !== null && !step.allowed && !isNext && ` · ${texts.locked}`}
                    {isNext && ` · ${texts.now}`}
                  </span>
                  {step !== null && isInvalid(step) && (
                    <span className="rail-why" lang={step.language}>
                      {sentence(step.message)}
                    </span>
                  )}
                </Link>
              </li>
            );
          })}
        </ol>
        <div className="rail-more">
          <ThemeButton />
          {now !== null && <HelpButton place={now.name} />}
        </div>
      </div>
    </nav>
  );
}

/** Whether a step was done and is not valid now. */
function isInvalid({ state }: Step): boolean {
  return state === "failed" || state === "out_of_date" || state === "due";
}

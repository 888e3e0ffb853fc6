import type { ReactNode } from "react";
import { Link } from "wouter";
import { useWords } from "../words/WordsContext";
import { PAGES, type OperatorPage } from "./pages";
import { useProcedure, type Step } from "../app/procedure";
import { MARK_OF_STATE } from "./stepMarks";
import { stateWord } from "./stepWords";

type Mark = Step["state"] | "none";

/** The steps, how each stands, and the way to each. */
export function StepRail({ now }: { now: OperatorPage | null }): ReactNode {
  const words = useWords().operator;
  const { data } = useProcedure();
  return (
    <nav className="rail" aria-label={words.steps}>
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
              >
                <span className="rail-mark" aria-hidden="true">
                  {mark === "none" ? "" : MARK_OF_STATE[mark]}
                </span>
                <span className="rail-name">{words.page[page.name]}</span>
                <span className="rail-state">
                  {step === null ? "" : stateWord(step, words)}
                  {step !== null && !step.allowed && ` · ${words.locked}`}
                  {isNext && ` · ${words.now}`}
                </span>
              </Link>
            </li>
          );
        })}
      </ol>
    </nav>
  );
}

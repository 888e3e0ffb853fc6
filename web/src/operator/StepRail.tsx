import type { ReactNode } from "react";
import { Link } from "wouter";
import { useWords } from "../words/WordsContext";
import { PAGES, type OperatorPage } from "./pages";
import { useProcedure, type Step } from "./procedure";

type Mark = Step["state"] | "none";
const SYMBOL: Record<Mark, string> = {
  done: "✓",
  due: "↻",
  missing: "○",
  out_of_date: "!",
  failed: "✕",
  none: "",
};

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
          return (
            <li key={page.name} data-state={mark} data-next={data?.next_step === page.step || undefined}>
              <Link
                href={`/operator/${page.name}`}
                aria-current={page === now ? "step" : undefined}
                data-testid={`step-${page.name}`}
              >
                <span className="rail-mark" aria-hidden="true">
                  {SYMBOL[mark]}
                </span>
                <span className="rail-name">{words.page[page.name]}</span>
                <span className="rail-state">{step === null ? "" : words.state[step.state]}</span>
              </Link>
            </li>
          );
        })}
      </ol>
    </nav>
  );
}

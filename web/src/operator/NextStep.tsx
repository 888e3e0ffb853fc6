import type { ReactNode } from "react";
import { Link } from "wouter";
import { useTexts } from "../texts/TextsContext";
import { PAGES, type OperatorPage } from "./pages";
import { useProcedure } from "../app/procedure";

/** Link to the next step, if it is on another page. */
export function NextStep({ page }: { page: OperatorPage }): ReactNode {
  const texts = useTexts().operator;
  const { data } = useProcedure();
  if (data === null) return null;
  const name = data.case_id === null ? "case" : data.next_step;
  const next = PAGES.find((one) => one.step === name || one.name === name);
  if (next === undefined || next === page) return null;
  return (
    <Link className="next-step" href={`/operator/${next.name}`} data-testid="next-step">
      {texts.next}: <strong>{texts.page[next.name]}</strong> <span aria-hidden="true">→</span>
    </Link>
  );
}

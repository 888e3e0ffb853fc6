import type { ReactNode } from "react";
import { Rejection } from "../../../rest/client";
import type { SweepFitMessage } from "../../../api";
import { useTexts } from "../../../texts/TextsContext";
import { Remarks } from "../../parts/Remarks";
import { RegistrationRejection } from "../RegistrationRejection";
import { RegistrationNumbers } from "../RegistrationNumbers";

/** The fit of the sweep, its least certain direction, and why it cannot be stored. */
export function SweepFit({ fit }: { fit: SweepFitMessage }): ReactNode {
  const texts = useTexts().registration.sweep;
  const way = Object.hasOwn(texts.ways, fit.weakest)
    ? texts.ways[fit.weakest as keyof typeof texts.ways]
    : fit.weakest;
  return (
    <section className="card" data-testid="sweep-fit-result" aria-live="polite">
      <RegistrationNumbers method="surface" numbers={fit.numbers} />
      <p>
        {texts.weakest}: <strong>{way}</strong>
      </p>
      <Remarks remarks={fit.remarks} />
      {fit.missing.map((problem) => (
        <RegistrationRejection key={problem.code} rejection={new Rejection(problem)} />
      ))}
      {fit.missing.length === 0 && <p className="good">✓ {texts.passes}</p>}
    </section>
  );
}

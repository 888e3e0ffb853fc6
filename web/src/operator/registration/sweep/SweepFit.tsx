import type { ReactNode } from "react";
import { Rejection } from "../../../rest/client";
import type { components } from "../../../schema";
import { useWords } from "../../../words/WordsContext";
import { Rejected } from "../Rejected";
import { RegistrationNumbers } from "../RegistrationNumbers";

/** What the sweep gives, which way it holds the bone least, and what keeps it from being kept. */
export function SweepFit({ fit }: { fit: components["schemas"]["SweepFitMessage"] }): ReactNode {
  const words = useWords().registration.sweep;
  const way = Object.hasOwn(words.ways, fit.weakest)
    ? words.ways[fit.weakest as keyof typeof words.ways]
    : fit.weakest;
  return (
    <section className="card" data-testid="sweep-fit-told" aria-live="polite">
      <RegistrationNumbers method="surface" numbers={fit.numbers} />
      <p>
        {words.minHeld}: <strong>{way}</strong>
      </p>
      {fit.remarks.map((remark) => (
        <p className="warning" key={remark.code}>
          ▲ {remark.message}. {remark.remedy}
        </p>
      ))}
      {fit.missing.map((problem) => (
        <Rejected key={problem.code} rejection={new Rejection(problem)} />
      ))}
      {fit.missing.length === 0 && <p className="good">✓ {words.passes}</p>}
    </section>
  );
}

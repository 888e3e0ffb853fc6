import type { ReactNode } from "react";
import { Refusal } from "../../../rest/client";
import type { components } from "../../../schema";
import { useWords } from "../../../words/WordsContext";
import { Refused } from "../Refused";
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
      {fit.missing.map((trouble) => (
        <Refused key={trouble.code} refusal={new Refusal(trouble)} />
      ))}
      {fit.missing.length === 0 && <p className="good">✓ {words.passes}</p>}
    </section>
  );
}

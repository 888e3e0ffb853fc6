import type { ReactNode } from "react";
import { Link } from "wouter";
import { useWords } from "../../words/WordsContext";
import { RegistrationNow } from "./RegistrationNow";
import { useRunning } from "./useRunning";

export const METHODS = ["points", "needles", "surface"] as const;
const PATH = { points: "points", needles: "needles", surface: "sweep" } as const;

/** The ways to register, what each sees and does not see, and what is there already. */
export function MethodChoice(): ReactNode {
  const words = useWords().registration;
  const running = useRunning().data;
  const begun = { points: running?.points === true, needles: false, surface: running?.sweep === true };
  return (
    <>
      <RegistrationNow />
      <p className="quiet">{words.choice.ends}</p>
      <ul className="methods">
        {METHODS.map((method) => (
          <li key={method}>
            <Link href={`/operator/register/${PATH[method]}`} data-testid={`method-${method}`}>
              <strong>{words.method[method]}</strong>
              <span className="method-does">{words.choice[method].does}</span>
              <span>
                <b aria-hidden="true">✓ </b>
                {words.choice[method].sees}
              </span>
              <span className="method-blind">
                <b aria-hidden="true">▲ </b>
                {words.choice[method].misses}
              </span>
              {begun[method] && <em>↻ {words.choice.begun}</em>}
            </Link>
          </li>
        ))}
      </ul>
    </>
  );
}

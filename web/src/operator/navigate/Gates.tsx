import type { ReactNode } from "react";
import { Link } from "wouter";
import { shownNumber } from "../../live/rounding";
import { Unanswered } from "../../rest/Unanswered";
import { useWords } from "../../words/WordsContext";
import { filled } from "../../words/filled";
import { stateWord } from "../stepWords";
import { useProcedure, type Step } from "../../app/procedure";

/** Every step that does not hold or is due again, why, and the way to it; or that all hold. */
export function Gates(): ReactNode {
  const words = useWords();
  const procedure = useProcedure();
  const { data } = procedure;
  if (data === null) return <Unanswered asked={procedure} />;
  const open = data.steps.filter((one) => one.step !== "navigate" && one.state !== "done");
  const check = data.steps.find((one) => one.step === "check");
  if (open.length === 0)
    return (
      <p className="good" role="status" data-testid="gates-open">
        ✓ {words.navigate.open} {check !== undefined && checkSaid(words.navigate.checked, check.numbers)}{" "}
        <Link className="big-link" href="/operator/check" data-testid="re-check">
          {words.navigate.recheck}
        </Link>
      </p>
    );
  return (
    <section className="card gates" data-testid="gates-shut">
      <h3>▲ {data.may_navigate ? words.navigate.dueTitle : words.navigate.shutTitle}</h3>
      <ul>
        {open.map((one) => (
          <li key={one.step}>
            <strong>
              {words.operator.page[one.step]} · {stateWord(one, words.operator)}
            </strong>{" "}
            {one.message}.{" "}
            <Link className="big-link" href={`/operator/${one.step}`}>
              {words.navigate.goTo} {words.operator.page[one.step]}
            </Link>
          </li>
        ))}
      </ul>
    </section>
  );
}

/** On what it was checked and how far off it was; nothing where no check says so. */
function checkSaid(words: string, { landmark, distance_mm, max_mm }: Step["numbers"]): string {
  if (typeof landmark !== "string" || typeof distance_mm !== "number" || typeof max_mm !== "number")
    return "";
  return filled(words, { landmark, mm: shownNumber(distance_mm, 1), most: shownNumber(max_mm, 1) });
}

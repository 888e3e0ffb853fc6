import type { ReactNode } from "react";
import { Link } from "wouter";
import { useWords } from "../../words/WordsContext";
import { useProcedure } from "../procedure";

/** Every step that does not hold or is due again, why, and the way to it; or that all hold. */
export function Gates(): ReactNode {
  const words = useWords();
  const { data } = useProcedure();
  if (data === null) return null;
  const open = data.steps.filter((one) => one.step !== "navigate" && one.state !== "done");
  if (open.length === 0)
    return (
      <p className="good" data-testid="gates-open">
        ✓ {words.navigate.open}{" "}
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
              {words.operator.page[one.step]} · {words.operator.state[one.state]}
            </strong>{" "}
            {one.said}.{" "}
            <Link className="big-link" href={`/operator/${one.step}`}>
              {words.navigate.goTo} {words.operator.page[one.step]}
            </Link>
          </li>
        ))}
      </ul>
    </section>
  );
}

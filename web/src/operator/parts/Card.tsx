import { useId, type ReactNode } from "react";
import { useIntoView } from "./useIntoView";

interface CardProps {
  title: string;
  testId?: string;
  aside?: ReactNode;
  /** Names what was just made here and stands in this card: it is brought into view. */
  fresh?: string | null;
  children: ReactNode;
}

/** One part of a step's page with its name. */
export function Card({ title, testId, aside, fresh = null, children }: CardProps): ReactNode {
  const id = useId();
  const card = useIntoView<HTMLElement>(fresh);
  return (
    <section className="card" aria-labelledby={id} data-testid={testId} ref={card}>
      <header className="card-head">
        <h3 id={id}>{title}</h3>
        {aside}
      </header>
      {children}
    </section>
  );
}

import { useId, type ReactNode } from "react";
import { useIntoView } from "./useIntoView";

interface CardProps {
  title: string;
  testId?: string;
  aside?: ReactNode;
  /** Identifies a result that was just made here; a new value scrolls to the card. */
  fresh?: string | null;
  children: ReactNode;
}

/** A titled section of a step's page. */
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

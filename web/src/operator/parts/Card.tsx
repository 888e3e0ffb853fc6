import { useId, type ReactNode } from "react";

interface CardProps {
  title: string;
  testId?: string;
  aside?: ReactNode;
  children: ReactNode;
}

/** One part of a step's page with its name. */
export function Card({ title, testId, aside, children }: CardProps): ReactNode {
  const id = useId();
  return (
    <section className="card" aria-labelledby={id} data-testid={testId}>
      <header className="card-head">
        <h3 id={id}>{title}</h3>
        {aside}
      </header>
      {children}
    </section>
  );
}

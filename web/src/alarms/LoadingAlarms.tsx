import type { ReactNode } from "react";
import { useWords } from "../words/WordsContext";

/** What the band of alarms says while the page is loading: nothing of alarms. */
export function LoadingAlarms(): ReactNode {
  return <p className="alarms-none">{useWords().rest.loading}</p>;
}

/** The same where there is no band around it. */
export function LoadingAlarmsShown(): ReactNode {
  const words = useWords().alarms;
  return (
    <section
      className="alarms alarms-shown"
      aria-label={words.title}
      data-testid="alarms-shown"
      data-priority="loading"
    >
      <LoadingAlarms />
    </section>
  );
}

import { Alert } from "@mantine/core";
import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { useWords } from "../words/WordsContext";
import { troublesOf } from "./troubles";

/** What is wrong, in the server's words: what happened, and what to do. Nothing wrong, no band. */
export function AlertBand(): ReactNode {
  const words = useWords();
  const { view } = useLive();
  const troubles = view.link === "open" ? troublesOf(view) : [];
  return (
    <div className="alerts" role="region" aria-label={words.alerts.title} aria-live="polite">
      {troubles.map(({ code, message, remedy }) => (
        <Alert
          key={code}
          color="yellow"
          variant="outline"
          role="status"
          icon={<span aria-hidden="true">▲▲</span>}
          title={message}
          data-testid="alert"
        >
          <strong>{words.alerts.remedy}</strong> {remedy} <code>{code}</code>
        </Alert>
      ))}
    </div>
  );
}

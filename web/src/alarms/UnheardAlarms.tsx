import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { useTexts } from "../texts/TextsContext";
import { AlarmsShown } from "./AlarmsShown";
import { alarmsVerdict } from "./verdict";

/** Band of alarms before the first message: loading, or server not reached. */
export function UnheardAlarms(): ReactNode {
  const { rest, cause } = useTexts();
  if (useLive().view.firstMessage === "awaited") return <p className="alarms-none">{rest.loading}</p>;
  const { state, sentence } = cause["not-reached"];
  return (
    <div className="alarms-top">
      <p className="alarms-state" role="alert">
        <span aria-hidden="true">▲▲</span> {state}
      </p>
      <p className="alarms-sentence">{sentence}</p>
    </div>
  );
}

/** The band of alarms once their state can be known. */
export function AlarmsAfterFirstMessage(): ReactNode {
  const texts = useTexts().alarms;
  const { view } = useLive();
  const { firstMessage } = view;
  if (firstMessage === "received" || alarmsVerdict(view, false).known) return <AlarmsShown />;
  return (
    <section
      className="alarms alarms-shown"
      aria-label={texts.title}
      data-testid="alarms-shown"
      data-priority={firstMessage === "awaited" ? "loading" : "unknown"}
      data-lit="true"
    >
      <UnheardAlarms />
    </section>
  );
}

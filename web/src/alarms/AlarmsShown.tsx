import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { useTexts } from "../texts/TextsContext";
import { AlarmLine } from "./AlarmSentence";
import { alarmsVerdict } from "./verdict";

/** Read-only list of alarms. They are acknowledged in theatre. */
export function AlarmsShown(): ReactNode {
  const texts = useTexts().alarms;
  const { view } = useLive();
  const verdict = alarmsVerdict(view, view.link !== "connecting");
  const alarms = verdict.known ? verdict.alarms.alarms : [];
  return (
    <section
      className="alarms alarms-shown"
      aria-label={texts.title}
      data-testid="alarms-shown"
      data-priority={verdict.known ? (alarms[0]?.priority ?? "none") : "unknown"}
    >
      {!verdict.known && (
        <p className="alarms-state" role="alert">
          <span aria-hidden="true">▲▲</span> {texts.unknown}
        </p>
      )}
      {verdict.known && alarms.length === 0 && <p className="alarms-none">{texts.none}</p>}
      {alarms.length > 0 && (
        <ul className="alarms-shown-list">
          {alarms.map((alarm) => (
            <li
              key={alarm.number}
              data-priority={alarm.priority}
              data-state={alarm.state}
              data-condition={alarm.condition}
            >
              <AlarmLine alarm={alarm} />
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}

import type { ReactNode } from "react";
import { formatSecond } from "../operator/parts/format";
import { getAlarmsLog } from "../api";
import { EmptyState } from "../panes/EmptyState";
import { QueryStatus } from "../rest/QueryStatus";
import { useQuery } from "../rest/useQuery";
import { textIn } from "../texts/text";
import { useTexts } from "../texts/TextsContext";
import type { Texts } from "../texts/en";

type Line = Record<string, unknown>;

const LINES = 100;

/** Alarm log of the open case, newest first. It is requested only while it is open. */
export function LogPanel(): ReactNode {
  const texts = useTexts();
  const own = texts.supervisor.log;
  const query = useQuery((signal) => getAlarmsLog({ query: { last: LINES }, signal }));
  const { data } = query;
  if (data === null) return <QueryStatus query={query} />;
  return (
    <>
      <button type="button" onClick={query.refetch}>
        {own.again}
      </button>
      {data.lines.length === 0 && <EmptyState drawing="log" sentence={own.none} />}
      <ul className="log" data-testid="log">
        {[...data.lines].reverse().map((line, index) => (
          <li key={`${text(line, "at")} ${index}`}>
            <time>{formatSecond(text(line, "at"), texts.language)}</time> {entryText(line, texts)}
          </li>
        ))}
      </ul>
    </>
  );
}

/** One line of the log: the alarm, its change, its text at that time, and the person. */
function entryText(line: Line, texts: Texts): string {
  const change = text(line, "change");
  const { change: changes, by } = texts.supervisor.log;
  const parts = [
    textIn(line, "title", texts) || text(line, "condition"),
    change in changes ? changes[change as keyof typeof changes] : change,
    textIn(line, "sentence", texts),
    text(line, "by") === "" ? "" : `${by} ${text(line, "by")}`,
  ];
  return parts.filter((part) => part !== "").join(" · ");
}

function text(line: Line, key: string): string {
  const value = line[key];
  return typeof value === "string" ? value : "";
}

import { Table } from "@mantine/core";
import type { ReactNode } from "react";
import { answered, server } from "../../rest/client";
import { Unanswered } from "../../rest/Unanswered";
import { useAsked } from "../../rest/useAsked";
import { inWords } from "../../words/text";
import { useWords } from "../../words/WordsContext";
import { shownTime } from "../parts/shown";
import { alarmsIn } from "./alarmSummary";

const MAX_LINES = 10_000;

/** The alarm log in short: which, how often, from when to when, acknowledged by whom. */
export function Alarms(): ReactNode {
  const words = useWords();
  const asked = useAsked((signal) =>
    answered(server.GET("/api/alarms/log", { signal, params: { query: { last: MAX_LINES } } })),
  );
  const { data } = asked;
  const alarms = data === null ? [] : alarmsIn(data.lines);
  return (
    <section className="stack">
      <h4>{words.report.alarms}</h4>
      {data === null && <Unanswered asked={asked} />}
      {data !== null && alarms.length === 0 && <p className="soft">{words.report.noAlarms}</p>}
      {data?.lines.length === MAX_LINES && <p className="bad">▲ {words.report.logCut}</p>}
      {alarms.length > 0 && (
        <Table.ScrollContainer minWidth={480}>
          <Table>
            <Table.Thead>
              <Table.Tr>
                <Table.Th scope="col">{words.report.alarm}</Table.Th>
                <Table.Th scope="col">{words.report.times}</Table.Th>
                <Table.Th scope="col">{words.report.worst}</Table.Th>
                <Table.Th scope="col">{words.report.firstLast}</Table.Th>
                <Table.Th scope="col">{words.report.acknowledged}</Table.Th>
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {alarms.map((one) => (
                <Table.Tr key={one.condition}>
                  <Table.Th scope="row">{inWords(one.line, "title", words) || one.condition}</Table.Th>
                  <Table.Td className="figure">{one.raised}</Table.Td>
                  <Table.Td>{inWords(one.line, "sentence", words)}</Table.Td>
                  <Table.Td>
                    {shownTime(one.firstAt, words.language)} – {shownTime(one.lastAt, words.language)}
                  </Table.Td>
                  <Table.Td>{one.acknowledgedBy.join(", ") || "—"}</Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </Table.ScrollContainer>
      )}
    </section>
  );
}

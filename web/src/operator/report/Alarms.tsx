import { Table } from "@mantine/core";
import type { ReactNode } from "react";
import { getAlarmsLog } from "../../api";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { textIn } from "../../texts/text";
import { useTexts } from "../../texts/TextsContext";
import { formatTime } from "../parts/format";
import { alarmsIn } from "./alarmSummary";

const MAX_LINES = 10_000;

/** Summary of the alarm log: which, how often, first and last, acknowledged by whom. */
export function Alarms(): ReactNode {
  const texts = useTexts();
  const query = useQuery((signal) => getAlarmsLog({ signal, query: { last: MAX_LINES } }));
  const { data } = query;
  const alarms = data === null ? [] : alarmsIn(data.lines);
  return (
    <section className="stack">
      <h4>{texts.report.alarms}</h4>
      {data === null && <QueryStatus query={query} />}
      {data !== null && alarms.length === 0 && <p className="soft">{texts.report.noAlarms}</p>}
      {data?.lines.length === MAX_LINES && <p className="bad">▲ {texts.report.logCut}</p>}
      {alarms.length > 0 && (
        <Table.ScrollContainer minWidth={480}>
          <Table>
            <Table.Thead>
              <Table.Tr>
                <Table.Th scope="col">{texts.report.alarm}</Table.Th>
                <Table.Th scope="col">{texts.report.times}</Table.Th>
                <Table.Th scope="col">{texts.report.worst}</Table.Th>
                <Table.Th scope="col">{texts.report.firstLast}</Table.Th>
                <Table.Th scope="col">{texts.report.acknowledged}</Table.Th>
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {alarms.map((one) => (
                <Table.Tr key={one.condition}>
                  <Table.Th scope="row">{textIn(one.line, "title", texts) || one.condition}</Table.Th>
                  <Table.Td className="figure">{one.raised}</Table.Td>
                  <Table.Td>{textIn(one.line, "sentence", texts)}</Table.Td>
                  <Table.Td>
                    {formatTime(one.firstAt, texts.language)} – {formatTime(one.lastAt, texts.language)}
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

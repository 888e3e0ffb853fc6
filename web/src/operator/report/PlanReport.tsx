import { Maker } from "../parts/Maker";
import { Table } from "@mantine/core";
import type { ReactNode } from "react";
import { formatFigure } from "../../live/rounding";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { getCasesByCaseIdDocumentsByDocumentId, type HeadingMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { formatTime } from "../parts/format";
import { channelsIn } from "./plan";

interface PlanReportProps {
  caseId: string;
  heading: HeadingMessage;
}

/** The planned channels with their screws. */
export function PlanReport({ caseId, heading }: PlanReportProps): ReactNode {
  const all = useTexts();
  const texts = all.report;
  const query = useQuery(
    (signal) => {
      const path = { case_id: caseId, document_id: heading.id };
      return getCasesByCaseIdDocumentsByDocumentId({ signal, path });
    },
    { key: heading.id },
  );
  const { data } = query;
  const channels = data === null ? [] : channelsIn(data.content);
  return (
    <section className="stack">
      <h4>{texts.plan}</h4>
      <p className="soft">
        {all.case.version} {heading.version} · {formatTime(heading.made_at, all.language)} ·{" "}
        <Maker of={heading} />
      </p>
      {data === null && <QueryStatus query={query} />}
      {data !== null && channels.length === 0 && <p className="soft">{texts.noChannels}</p>}
      {channels.length > 0 && (
        <Table.ScrollContainer minWidth={480}>
          <Table>
            <Table.Thead>
              <Table.Tr>
                <Table.Th scope="col">{texts.vertebra}</Table.Th>
                <Table.Th scope="col">{texts.side}</Table.Th>
                <Table.Th scope="col">{texts.channel}</Table.Th>
                <Table.Th scope="col">{texts.screw}</Table.Th>
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {channels.map((one) => (
                <Table.Tr key={`${one.vertebra} ${one.side}`}>
                  <Table.Th scope="row">{one.vertebra}</Table.Th>
                  <Table.Td>{texts.sides[one.side] ?? one.side}</Table.Td>
                  <Table.Td className="figure">
                    Ø {formatFigure(one.diameterMm, 1)} mm, {formatFigure(one.lengthMm, 1)} mm
                    {one.byHand && ` · ${texts.byHand}`}
                  </Table.Td>
                  <Table.Td className="figure">
                    {one.screw === null
                      ? "—"
                      : `Ø ${formatFigure(one.screw.diameterMm, 1)} × ${formatFigure(one.screw.lengthMm, 0)} mm`}
                  </Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </Table.ScrollContainer>
      )}
    </section>
  );
}

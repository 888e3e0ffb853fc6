import { Table } from "@mantine/core";
import type { ReactNode } from "react";
import type { ProcedureMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { stateText } from "../stepTexts";
import { formatTime, sentence } from "../parts/format";
import { interpolate } from "../../texts/interpolate";

interface StepsReportProps {
  procedure: ProcedureMessage;
  readAt: string;
}

/** State of each step at the time of the report. */
export function StepsReport({ procedure, readAt }: StepsReportProps): ReactNode {
  const texts = useTexts();
  return (
    <section className="stack">
      <h4>{interpolate(texts.report.steps, { time: formatTime(readAt, texts.language) })}</h4>
      <p className="soft">{texts.report.stepsLead}</p>
      <Table.ScrollContainer minWidth={480}>
        <Table>
          <Table.Thead>
            <Table.Tr>
              <Table.Th scope="col">{texts.report.step}</Table.Th>
              <Table.Th scope="col">{texts.report.state}</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {procedure.steps.map((step) => (
              <Table.Tr key={step.step} data-testid={`report-${step.step}`}>
                <Table.Th scope="row">{texts.operator.page[step.step]}</Table.Th>
                <Table.Td>
                  <strong>{stateText(step, texts.operator)}</strong>
                  <p className="soft" lang={step.language}>
                    {sentence(step.message)}
                  </p>
                </Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      </Table.ScrollContainer>
    </section>
  );
}

import { Table } from "@mantine/core";
import type { ReactNode } from "react";
import type { components } from "../../schema";
import { useWords } from "../../words/WordsContext";
import { stateWord } from "../stepWords";
import { sentence, shownTime } from "../parts/shown";
import { filled } from "../../words/filled";

interface StepsReportProps {
  procedure: components["schemas"]["ProcedureMessage"];
  readAt: string;
}

/** How each step of the procedure stood when the report was read. */
export function StepsReport({ procedure, readAt }: StepsReportProps): ReactNode {
  const words = useWords();
  return (
    <section className="stack">
      <h4>{filled(words.report.steps, { time: shownTime(readAt, words.language) })}</h4>
      <p className="soft">{words.report.stepsLead}</p>
      <Table.ScrollContainer minWidth={480}>
        <Table>
          <Table.Thead>
            <Table.Tr>
              <Table.Th scope="col">{words.report.step}</Table.Th>
              <Table.Th scope="col">{words.report.state}</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {procedure.steps.map((step) => (
              <Table.Tr key={step.step} data-testid={`report-${step.step}`}>
                <Table.Th scope="row">{words.operator.page[step.step]}</Table.Th>
                <Table.Td>
                  <strong>{stateWord(step, words.operator)}</strong>
                  {/* The server speaks English. */}
                  <p className="soft" lang="en">
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

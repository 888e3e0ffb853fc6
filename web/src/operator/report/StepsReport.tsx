import { Table } from "@mantine/core";
import type { ReactNode } from "react";
import { useWords } from "../../words/WordsContext";
import { sentence } from "../parts/shown";
import { useProcedure } from "../procedure";
import { shownNumbers } from "./numbers";

/** Each step of the procedure: how it stands, and the numbers of its gate. */
export function StepsReport(): ReactNode {
  const words = useWords();
  const { data } = useProcedure();
  if (data === null) return null;
  return (
    <section className="stack">
      <h4>{words.report.steps}</h4>
      <Table.ScrollContainer minWidth={480}>
        <Table>
          <Table.Thead>
            <Table.Tr>
              <Table.Th scope="col">{words.report.step}</Table.Th>
              <Table.Th scope="col">{words.report.state}</Table.Th>
              <Table.Th scope="col">{words.report.numbers}</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {data.steps.map((step) => (
              <Table.Tr key={step.step} data-testid={`report-${step.step}`}>
                <Table.Th scope="row">{words.operator.page[step.step]}</Table.Th>
                <Table.Td>
                  <strong>{words.operator.state[step.state]}</strong>
                  <p className="soft">{sentence(step.said)}</p>
                </Table.Td>
                <Table.Td className="figure">
                  {shownNumbers(step.numbers).map(([name, value]) => (
                    <p key={name}>
                      {words.report.names[name] ?? name.replaceAll("_", " ")}: {value}
                    </p>
                  ))}
                </Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      </Table.ScrollContainer>
    </section>
  );
}

import { Table } from "@mantine/core";
import type { ReactNode } from "react";
import type { components } from "../../schema";
import { useWords } from "../../words/WordsContext";
import { newestOf } from "../case/newest";
import { Maker } from "../parts/Maker";
import { sentence, shownTime } from "../parts/shown";

/** What was made, by whom and when, and whether it holds. */
export function DocumentsReport({
  documents,
}: {
  documents: readonly components["schemas"]["HeadingMessage"][];
}): ReactNode {
  const words = useWords();
  const newest = newestOf(documents);
  return (
    <section className="stack">
      <h4>{words.report.documents}</h4>
      {newest.length === 0 ? (
        <p className="soft">{words.report.nothing}</p>
      ) : (
        <Table.ScrollContainer minWidth={480}>
          <Table>
            <Table.Thead>
              <Table.Tr>
                <Table.Th scope="col">{words.case.document}</Table.Th>
                <Table.Th scope="col">{words.case.standing}</Table.Th>
                <Table.Th scope="col">{words.report.madeAt}</Table.Th>
                <Table.Th scope="col">{words.report.by}</Table.Th>
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {[...newest].reverse().map((one) => (
                <Table.Tr key={one.id}>
                  <Table.Th scope="row">
                    {words.case.kinds[one.kind]} · {one.name}, {words.case.version} {one.version}
                  </Table.Th>
                  <Table.Td>
                    {one.current
                      ? `✓ ${words.case.standings.current}`
                      : `! ${sentence(one.out_of_date ?? "")}`}
                  </Table.Td>
                  <Table.Td>{shownTime(one.made_at, words.language)}</Table.Td>
                  <Table.Td>
                    <Maker of={one} />
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

import { Maker } from "../parts/Maker";
import { Table } from "@mantine/core";
import type { ReactNode } from "react";
import { formatFigure } from "../../live/rounding";
import { useTexts } from "../../texts/TextsContext";
import { documentTitle } from "../case/documentTitle";
import { sentence, formatTime } from "../parts/format";
import { interpolate } from "../../texts/interpolate";
import { useSides } from "../registration/useSides";
import { factsOf, type Fact } from "./facts";
import type { Entry, Heading } from "./record";

interface RecordReportProps {
  entries: readonly Entry[];
  /** Facts by document id. */
  contents: ReadonlyMap<string, Record<string, unknown>>;
  /** Time of reading, which validity refers to. */
  readAt: string;
}

/** History of the case: documents with author, time and values, and their validity at the time of reading. */
export function RecordReport({ entries, contents, readAt }: RecordReportProps): ReactNode {
  const texts = useTexts();
  return (
    <section className="stack">
      <h4>{texts.report.record}</h4>
      <p className="soft">{texts.report.recordLead}</p>
      {entries.length === 0 ? (
        <p className="soft">{texts.report.nothing}</p>
      ) : (
        <Table.ScrollContainer minWidth={0} className="stacked">
          <Table verticalSpacing="sm" data-testid="record">
            <Table.Thead>
              <Table.Tr>
                <Table.Th scope="col">{texts.report.madeAt}</Table.Th>
                <Table.Th scope="col">{texts.report.what}</Table.Th>
                <Table.Th scope="col">{texts.report.says}</Table.Th>
                <Table.Th scope="col">{texts.report.by}</Table.Th>
                <Table.Th scope="col">
                  {interpolate(texts.report.validityAt, { time: formatTime(readAt, texts.language) })}
                </Table.Th>
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {entries.map((entry) => (
                <EntryRow key={entry.last.id} entry={entry} content={contents.get(entry.last.id) ?? {}} />
              ))}
            </Table.Tbody>
          </Table>
        </Table.ScrollContainer>
      )}
    </section>
  );
}

function EntryRow({ entry, content }: { entry: Entry; content: Record<string, unknown> }): ReactNode {
  const texts = useTexts();
  const { first, last } = entry;
  const isOne = first === last;
  return (
    <Table.Tr>
      <Table.Td className="record-time">
        {formatTime(first.made_at, texts.language)}
        {!isOne && (
          <>
            {" "}
            {texts.report.until} {formatTime(last.made_at, texts.language)}
          </>
        )}
      </Table.Td>
      <Table.Th scope="row">
        {documentTitle(last, texts.case)}
        <p className="soft">
          {isOne
            ? `${texts.case.version} ${String(last.version)}`
            : interpolate(texts.report.versions, { first: first.version, last: last.version })}
        </p>
      </Table.Th>
      <Table.Td className="figure">
        {content["passed"] === true && <p>✓ {texts.report.passed}</p>}
        {content["passed"] === false && <p>✕ {texts.report.notPassed}</p>}
        {factsOf(last.kind, content).map((fact) => (
          <FactLine key={fact.name} fact={fact} />
        ))}
      </Table.Td>
      <Table.Td>
        <Maker of={last} />
      </Table.Td>
      <Table.Td>
        <Validity heading={last} />
      </Table.Td>
    </Table.Tr>
  );
}

function FactLine({ fact }: { fact: Fact }): ReactNode {
  const texts = useTexts();
  const sideName = useSides();
  const { name, value, unit, limit } = fact;
  const methods = texts.registration.method as Partial<Record<string, string>>;
  const shown = typeof value === "string" ? (methods[value] ?? sideName(value)) : formatFigure(value, 2);
  return (
    <p>
      {texts.report.facts[name]}: {shown} {unit}
      {limit !== null && (
        <span className="soft">
          {" "}
          ({texts.report.allowed} {formatFigure(limit, 2)} {unit})
        </span>
      )}
    </p>
  );
}

function Validity({ heading }: { heading: Heading }): ReactNode {
  const texts = useTexts().case;
  const { current, withdrawn, out_of_date: why } = heading;
  if (current) return `✓ ${texts.validities.current}`;
  return (
    <>
      ! {withdrawn === null ? texts.validities.outOfDate : texts.validities.withdrawn}
      <p className="soft">
        {withdrawn === null ? sentence(why ?? "") : `${sentence(withdrawn.reason)} (${withdrawn.by})`}
      </p>
    </>
  );
}

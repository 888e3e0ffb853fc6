import { Table } from "@mantine/core";
import { useEffect, useEffectEvent, type ReactNode } from "react";
import {
  getRecordingsDrillings,
  type DrillingInstantMessage,
  type DrillingMessage,
  type DrillingsMessage,
} from "../../api";
import { JobProgress } from "../../rest/JobProgress";
import { QueryStatus } from "../../rest/QueryStatus";
import { useJob } from "../../rest/useJob";
import { useQuery } from "../../rest/useQuery";
import { interpolate } from "../../texts/interpolate";
import { pluralize } from "../../texts/pluralize";
import { EmptyState } from "../../panes/EmptyState";
import { useTexts } from "../../texts/TextsContext";
import { formatTime } from "../parts/format";
import { figureText, gradeText, missingText } from "./drilling";

/** Course of each drilling, from the recordings of the case, which are read first where necessary. */
export function Drillings(): ReactNode {
  const texts = useTexts().report.drilling;
  const query = useQuery((signal) => getRecordingsDrillings({ signal }));
  const { data, refetch } = query;
  const { follow, ...followed } = useJob(refetch);
  const job = data?.job ?? null;
  const onJob = useEffectEvent(() => {
    if (job !== null) follow(job);
  });
  useEffect(() => {
    onJob();
  }, [job?.id]);
  return (
    <section className="stack" data-testid="report-drillings">
      <h4>{texts.title}</h4>
      {data === null && <QueryStatus query={query} />}
      {job !== null && <JobProgress followed={{ follow, ...followed }} />}
      {data !== null && <Content drillings={data} />}
    </section>
  );
}

function Content({
  drillings: { drillings, job, unread, running },
}: {
  drillings: DrillingsMessage;
}): ReactNode {
  const all = useTexts();
  const texts = all.report.drilling;
  return (
    <>
      {drillings.length > 0 && <p className="soft">{texts.lead}</p>}
      {job !== null && <p className="bad">▲ {texts.incomplete}</p>}
      {unread.length > 0 && (
        <p className="bad">▲ {interpolate(texts.unread, { names: unread.join(", ") })}</p>
      )}
      {running > 0 && <p className="bad">▲ {pluralize(texts.running, running, all.language)}</p>}
      {drillings.length === 0 && job === null && <EmptyState drawing="recording" sentence={texts.none} />}
      {drillings.length > 0 && (
        <Table.ScrollContainer minWidth={0} className="stacked">
          <Table verticalSpacing="sm">
            <Table.Thead>
              <Table.Tr>
                {[texts.channel, texts.entry, texts.deepest, texts.nearest, texts.grade, texts.missing].map(
                  (title) => (
                    <Table.Th scope="col" key={title}>
                      {title}
                    </Table.Th>
                  ),
                )}
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {drillings.map((one) => (
                <DrillingRow
                  key={`${one.recording} ${one.channel} ${one.tool} ${one.from_s}`}
                  drilling={one}
                />
              ))}
            </Table.Tbody>
          </Table>
        </Table.ScrollContainer>
      )}
    </>
  );
}

function DrillingRow({ drilling }: { drilling: DrillingMessage }): ReactNode {
  const all = useTexts();
  const texts = all.report.drilling;
  const { at_entry: entry, deepest, nearest, against } = drilling;
  return (
    <Table.Tr>
      <Table.Th scope="row">
        {drilling.channel} · {drilling.tool}
        <p className="soft">{formatTime(drilling.began_at, all.language)}</p>
        <p className="soft">{pluralize(texts.images, drilling.images, all.language)}</p>
        {!drilling.is_whole && <p className="bad">▲ {texts.cut}</p>}
      </Table.Th>
      <Table.Td className="figure">
        <Deviation instant={entry} />
      </Table.Td>
      <Table.Td className="figure">
        <Deviation instant={deepest} />
      </Table.Td>
      <Table.Td className="figure">
        <strong>{figureText(nearest.wall, "mm", texts)}</strong>
        <p>
          {texts.depth}: {figureText(nearest.depth, "mm", texts)}
        </p>
        <p className="soft">{against === null ? texts.againstUnknown : texts.against[against]}</p>
      </Table.Td>
      <Table.Td>{gradeText(drilling, texts)}</Table.Td>
      <Table.Td>{missingText(drilling, texts)}</Table.Td>
    </Table.Tr>
  );
}

function Deviation({ instant }: { instant: DrillingInstantMessage }): ReactNode {
  const texts = useTexts().report.drilling;
  return (
    <>
      <p>
        {texts.depth}: {figureText(instant.depth, "mm", texts)}
      </p>
      <p>
        {texts.offset}: {figureText(instant.entry, "mm", texts)}
      </p>
      <p>
        {texts.angle}: {figureText(instant.angle, "°", texts)}
      </p>
    </>
  );
}

import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import {
  getCasesByCaseId,
  getCasesByCaseIdDocuments,
  getCasesByCaseIdDocumentsByDocumentId,
  getProcedure,
} from "../../api";
import { EmptyState } from "../../panes/EmptyState";
import { PageLink } from "../../rest/PageLink";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useTexts } from "../../texts/TextsContext";
import { ArchiveOut } from "../case/ArchiveOut";
import { newestOf } from "../case/newest";
import { formatTime } from "../parts/format";
import { useProcedure } from "../../app/procedure";
import { Alarms } from "./Alarms";
import { Drillings } from "./Drillings";
import { TELLING } from "./facts";
import { PlanReport } from "./PlanReport";
import { SignaturesReport } from "./SignaturesReport";
import { recordOf, type Heading } from "./record";
import { RecordReport } from "./RecordReport";
import { StepsReport } from "./StepsReport";

/** The case for print: history, plan, course of the drillings, alarms, and state of the steps. */
export function ReportPage(): ReactNode {
  const texts = useTexts().report;
  const procedure = useProcedure();
  const { data } = procedure;
  if (data === null) return <QueryStatus query={procedure} />;
  if (data.case_id === null) {
    return (
      <EmptyState drawing="case" sentence={texts.noCase}>
        <PageLink page="case" />
      </EmptyState>
    );
  }
  return <Report key={data.case_id} caseId={data.case_id} />;
}

function Report({ caseId }: { caseId: string }): ReactNode {
  const all = useTexts();
  const texts = all.report;
  const query = useQuery(
    async (signal) => {
      const path = { case_id: caseId };
      const [storedCase, { documents }, procedure] = await Promise.all([
        getCasesByCaseId({ signal, path }),
        getCasesByCaseIdDocuments({ signal, path }),
        getProcedure({ signal }),
      ]);
      const entries = recordOf(documents);
      const telling = entries.map((one) => one.last).filter((one) => isTelling(one) && !one.is_damaged);
      const contents = await contentsOf(caseId, telling, signal);
      return { storedCase, documents, entries, contents, procedure, readAt: new Date().toISOString() };
    },
    { key: caseId },
  );
  const { data, refetch } = query;
  if (data === null) return <QueryStatus query={query} />;
  const { storedCase, documents, entries, contents, procedure, readAt } = data;
  const plan = newestOf(documents).find((one) => one.kind === "plan" && one.name === "main") ?? null;
  return (
    <div className="cards">
      <div className="row not-printed">
        <Button
          size="lg"
          onClick={() => {
            window.print();
          }}
        >
          {texts.print}
        </Button>
        <Button size="lg" variant="default" onClick={refetch}>
          {texts.again}
        </Button>
        <ArchiveOut caseId={caseId} />
      </div>
      <article className="card report" data-testid="report">
        <header className="stack">
          <h3>
            {texts.title}: {storedCase.name}
          </h3>
          <p className="report-notice">{all.notice}</p>
          <p className="soft">
            {texts.made} {formatTime(readAt, all.language)} · {all.case.madeAt}{" "}
            {formatTime(storedCase.created_at, all.language)} · {texts.caseId} {storedCase.id}
          </p>
          <p className="soft">{texts.identity}</p>
        </header>
        <RecordReport entries={entries} contents={contents} readAt={readAt} />
        {plan !== null && <PlanReport caseId={caseId} heading={plan} />}
        <Drillings />
        <SignaturesReport />
        <Alarms />
        <StepsReport procedure={procedure} readAt={readAt} />
      </article>
    </div>
  );
}

/** The plan's content is shown by its channels. */
function isTelling({ kind, name }: Heading): boolean {
  return TELLING.has(kind) && !(kind === "plan" && name === "main");
}

/** Facts of these documents, by id. */
async function contentsOf(
  caseId: string,
  documents: readonly Heading[],
  signal: AbortSignal,
): Promise<Map<string, Record<string, unknown>>> {
  const contents = new Map<string, Record<string, unknown>>();
  // Sequential, since navigation has priority on the server.
  for (const { id } of documents) {
    const path = { case_id: caseId, document_id: id };
    const { content } = await getCasesByCaseIdDocumentsByDocumentId({ signal, path });
    contents.set(id, content);
  }
  return contents;
}

import { Button, Loader } from "@mantine/core";
import type { ReactNode } from "react";
import { Link } from "wouter";
import { answered, server } from "../../rest/client";
import { RefusalNote } from "../../rest/RefusalNote";
import { useAsked } from "../../rest/useAsked";
import { useWords } from "../../words/WordsContext";
import { ArchiveOut } from "../case/ArchiveOut";
import { newestOf } from "../case/newest";
import { shownTime } from "../parts/shown";
import { useProcedure } from "../procedure";
import { Alarms } from "./Alarms";
import { DocumentsReport } from "./DocumentsReport";
import { PlanReport } from "./PlanReport";
import { SignaturesReport } from "./SignaturesReport";
import { StepsReport } from "./StepsReport";

/** What the case has, on paper: steps with their numbers, plan, registration, check, alarms. */
export function ReportPage(): ReactNode {
  const words = useWords().report;
  const { data, refusal } = useProcedure();
  if (data === null) {
    return refusal === null ? <Loader aria-label={words.loading} /> : <RefusalNote refusal={refusal} />;
  }
  if (data.case_id === null) {
    return (
      <p className="card-lead">
        {words.noCase}{" "}
        <Link className="way" href="/operator/case">
          {words.toCases}
        </Link>
      </p>
    );
  }
  return <Report key={data.case_id} caseId={data.case_id} />;
}

function Report({ caseId }: { caseId: string }): ReactNode {
  const all = useWords();
  const words = all.report;
  const { data, refusal, again } = useAsked(
    async (signal) => {
      const params = { path: { case_id: caseId } };
      const [kept, documents] = await Promise.all([
        answered(server.GET("/api/cases/{case_id}", { signal, params })),
        answered(server.GET("/api/cases/{case_id}/documents", { signal, params })),
      ]);
      return { kept, documents: documents.documents, at: new Date().toISOString() };
    },
    { key: caseId },
  );
  if (data === null) {
    return refusal === null ? <Loader aria-label={words.loading} /> : <RefusalNote refusal={refusal} />;
  }
  const { kept, documents, at } = data;
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
          {words.print}
        </Button>
        <Button size="lg" variant="default" onClick={again}>
          {words.again}
        </Button>
        <ArchiveOut caseId={caseId} />
      </div>
      <article className="card report" data-testid="report">
        <header className="stack">
          <h3>
            {words.title}: {kept.name}
          </h3>
          <p className="report-notice">{all.notice}</p>
          <p className="soft">
            {words.made} {shownTime(at, all.language)} · {all.case.madeAt}{" "}
            {shownTime(kept.created_at, all.language)} · {words.caseId} {kept.id}
          </p>
          <p className="soft">{words.identity}</p>
        </header>
        <StepsReport />
        {plan !== null && <PlanReport caseId={caseId} heading={plan} />}
        <SignaturesReport />
        <DocumentsReport documents={documents} />
        <Alarms />
      </article>
    </div>
  );
}

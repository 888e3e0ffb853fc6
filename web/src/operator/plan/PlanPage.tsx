import type { ReactNode } from "react";
import { getCt } from "../../api";
import { Drawing } from "../../panes/Drawing";
import { EmptyState } from "../../panes/EmptyState";
import { PageLink } from "../../rest/PageLink";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useTexts } from "../../texts/TextsContext";
import { useCaseId, useProcedure } from "../../app/procedure";
import { CtIntake } from "./ct/CtIntake";
import { LabelsProvider } from "./labels/LabelsContext";
import { SlicesProvider } from "./slices/SlicesContext";
import { hasDocument } from "./state/documents";
import { PlanProvider } from "./state/PlanContext";
import { WorkProvider } from "./state/WorkContext";
import { Workplace } from "./Workplace";

/** The plan page: receives the CT; the plan is made on its slices. */
export function PlanPage(): ReactNode {
  const texts = useTexts().plan;
  const query = useProcedure();
  const caseId = useCaseId();
  if (caseId === undefined) return <QueryStatus query={query} />;
  if (caseId === null) {
    return (
      <EmptyState drawing="case" sentence={texts.noCase}>
        <PageLink page="case" />
      </EmptyState>
    );
  }
  return <PlanOfCase key={caseId} caseId={caseId} />;
}

function PlanOfCase({ caseId }: { caseId: string }): ReactNode {
  const texts = useTexts().plan;
  const ct = useQuery(async (signal) => {
    const isThere = await hasDocument(caseId, "ct", signal);
    return isThere ? getCt({ signal }) : "none";
  });
  if (ct.data === "none") {
    return (
      <section className="plan-empty" data-testid="no-ct">
        <h3 className="with-drawing">
          <Drawing name="ct" /> {texts.ct.noneTitle}
        </h3>
        <CtIntake isSecond={false} onTaken={ct.refetch} />
      </section>
    );
  }
  if (ct.data === null) {
    return (
      <section className="plan-empty">
        <QueryStatus query={ct} />
      </section>
    );
  }
  return (
    <PlanProvider caseId={caseId}>
      <SlicesProvider key={ct.data.heading.id} ct={ct.data} lookAnew={ct.refetch}>
        <WorkProvider>
          <LabelsProvider caseId={caseId}>
            <Workplace onCtTaken={ct.refetch} />
          </LabelsProvider>
        </WorkProvider>
      </SlicesProvider>
    </PlanProvider>
  );
}

import type { ReactNode } from "react";
import { getCases } from "../../api";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useProcedure } from "../../app/procedure";
import { TourOffer } from "../../tour/TourOffer";
import { ArchiveIn } from "./ArchiveIn";
import { CaseList } from "./CaseList";
import { Documents } from "./Documents";
import { Jobs } from "./Jobs";
import { NewCase } from "./NewCase";
import { OpenedCase } from "./OpenedCase";
import { Rehearsal } from "./Rehearsal";
import { Verification } from "./Verification";

const ASK_EVERY_MS = 3000;

/** The case page: create, open, inspect, archive and close cases. */
export function CasePage(): ReactNode {
  const { refetch: askProcedure } = useProcedure();
  const query = useQuery((signal) => getCases({ signal }), {
    everyMs: ASK_EVERY_MS,
  });
  const { data, refetch } = query;
  const changed = (): void => {
    refetch();
    askProcedure();
  };
  if (data === null) return <QueryStatus query={query} />;
  const opened = data.cases.find((one) => one.id === data.opened_id) ?? null;
  const newCase = <NewCase first={data.cases.length === 0} onMade={changed} />;
  return (
    <div className="cards">
      <TourOffer />
      {opened === null && newCase}
      {opened !== null && <OpenedCase key={opened.id} opened={opened} onChange={changed} />}
      <Rehearsal />
      <CaseList cases={data.cases} openedId={data.opened_id} onChange={changed} />
      {opened !== null && newCase}
      <ArchiveIn onTaken={changed} />
      {opened !== null && <Documents key={`documents ${opened.id}`} caseId={opened.id} />}
      {opened !== null && <Verification key={`files ${opened.id}`} caseId={opened.id} />}
      <Jobs />
    </div>
  );
}

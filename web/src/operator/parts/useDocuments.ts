import { useQuery } from "../../rest/useQuery";
import { getCasesByCaseIdDocuments, type HeadingMessage } from "../../api";
import { useProcedure } from "../../app/procedure";

type Heading = HeadingMessage;

/** Documents of the open case, empty without one; null until the server has answered. */
export function useDocuments(): readonly Heading[] | null {
  const procedure = useProcedure().data;
  const caseId = procedure?.case_id ?? null;
  const { data } = useQuery(
    async (signal) => {
      if (caseId === null) return { documents: [] };
      const path = { case_id: caseId };
      return getCasesByCaseIdDocuments({ signal, path });
    },
    { key: caseId ?? "", everyMs: 3000 },
  );
  return procedure === null ? null : (data?.documents ?? null);
}

import { answered, server } from "../../rest/client";
import { useQuery } from "../../rest/useQuery";
import type { components } from "../../schema";
import { useProcedure } from "../../app/procedure";

type Heading = components["schemas"]["HeadingMessage"];

/** Documents of the open case, empty without one; null until the server has answered. */
export function useDocuments(): readonly Heading[] | null {
  const procedure = useProcedure().data;
  const caseId = procedure?.case_id ?? null;
  const { data } = useQuery(
    async (signal) => {
      if (caseId === null) return { documents: [] };
      const params = { path: { case_id: caseId } };
      return answered(server.GET("/api/cases/{case_id}/documents", { signal, params }));
    },
    { key: caseId ?? "", everyMs: 3000 },
  );
  return procedure === null ? null : (data?.documents ?? null);
}

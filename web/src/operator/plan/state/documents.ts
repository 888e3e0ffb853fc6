// Documents of a case. Existence is checked first, so that a missing document is no error.
import { answered, server } from "../../../rest/client";
import type { components } from "../../../schema";

type Kind = components["schemas"]["DocumentKind"];

/** Name of the case's only CT, plan or surface. */
const MAIN = "main";

/**
 * Whether the case has a document of this kind.
 *
 * @throws Rejection
 */
export async function hasDocument(caseId: string, kind: Kind, signal?: AbortSignal): Promise<boolean> {
  const { documents } = await answered(
    server.GET("/api/cases/{case_id}/documents", {
      params: { path: { case_id: caseId } },
      ...(signal === undefined ? {} : { signal }),
    }),
  );
  const versions = documents.filter((one) => one.kind === kind && one.name === MAIN);
  return versions.length > 0 && versions.at(-1)?.withdrawn === null;
}

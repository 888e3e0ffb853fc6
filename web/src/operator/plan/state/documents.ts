// Documents of a case. Existence is checked first, so that a missing document is no error.
import { type DocumentKind, getCasesByCaseIdDocuments } from "../../../api";

type Kind = DocumentKind;

/** Name of the case's only CT, plan or surface. */
const MAIN = "main";

/**
 * Whether the case has a document of this kind.
 *
 * @throws Rejection
 */
export async function hasDocument(caseId: string, kind: Kind, signal?: AbortSignal): Promise<boolean> {
  const { documents } = await getCasesByCaseIdDocuments({
    path: { case_id: caseId },
    ...(signal === undefined ? {} : { signal }),
  });
  const versions = documents.filter((one) => one.kind === kind && one.name === MAIN);
  return versions.length > 0 && versions.at(-1)?.withdrawn === null;
}

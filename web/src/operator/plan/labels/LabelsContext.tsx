// Labels of vertebrae of the case, and whether they are drawn.
import { createContext, use, useMemo, useState, type ReactNode } from "react";
import { getLabels, type LabelsMessage } from "../../../api";
import { useQuery } from "../../../rest/useQuery";
import { hasDocument } from "../state/documents";

interface LabelsValue {
  /** Labels of the present CT; null if there are none, or not known yet. */
  labels: LabelsMessage | null;
  isShown: boolean;
  setShown: (isShown: boolean) => void;
  refetch: () => void;
}

const LabelsContext = createContext<LabelsValue | null>(null);
// Another tablet may send labels.
const ASK_EVERY_MS = 10_000;

export function LabelsProvider({ caseId, children }: { caseId: string; children: ReactNode }): ReactNode {
  const { data, refetch } = useQuery(
    async (signal) => ((await hasDocument(caseId, "labels", signal)) ? getLabels({ signal }) : null),
    { key: caseId, everyMs: ASK_EVERY_MS },
  );
  const [isShown, setShown] = useState(true);
  const labels = data?.heading.current === true ? data : null;
  const value = useMemo(() => ({ labels, isShown, setShown, refetch }), [labels, isShown, refetch]);
  return <LabelsContext value={value}>{children}</LabelsContext>;
}

export function useLabels(): LabelsValue {
  const value = use(LabelsContext);
  if (value === null) throw new Error("useLabels must be used inside LabelsProvider");
  return value;
}

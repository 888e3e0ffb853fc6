import { Alert } from "@mantine/core";
import type { ReactNode } from "react";
import { getLabelsChannels } from "../../../api";
import { useQuery } from "../../../rest/useQuery";
import { usePlanning } from "../state/PlanContext";
import { useLabels } from "./LabelsContext";

/** Channels that lie in the label of another level than they are planned for. */
export function LevelProblems(): ReactNode {
  const { labels } = useLabels();
  const { plan } = usePlanning();
  return labels === null || plan === null ? null : (
    <Problems of={`${labels.heading.id} ${String(plan.heading.version)}`} />
  );
}

function Problems({ of }: { of: string }): ReactNode {
  const { data } = useQuery((signal) => getLabelsChannels({ signal }), { key: of });
  return data?.channels.map(
    ({ vertebra, side, problem }) =>
      problem !== null && (
        <Alert
          key={`${vertebra} ${side}`}
          className="consequence"
          title={problem.message}
          data-testid="level-problem"
        >
          {problem.remedy}
        </Alert>
      ),
  );
}

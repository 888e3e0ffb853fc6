import type { ReactNode } from "react";
import { getHealth } from "../api";
import { useQuery } from "../rest/useQuery";

const ASK_EVERY_MS = 10_000;

/** What does not work beside navigation: the hub, or a plug-in. Below the page, so that it moves nothing. */
export function SinkNotes(): ReactNode {
  const { data } = useQuery((signal) => getHealth({ signal }), { everyMs: ASK_EVERY_MS });
  return data?.sinks.map(
    ({ name, problem }) =>
      problem !== null && (
        <p
          key={name}
          className="sink-note"
          role="status"
          data-testid={`sink-${name}`}
          lang={problem.language}
        >
          ▲ {problem.message}. {problem.remedy}
        </p>
      ),
  );
}

import { useQuery, type QueryState } from "../../rest/useQuery";
import { getRegistrationRunning, type RunningMessage } from "../../api";

const ASK_EVERY_MS = 1500;

/** Procedures begun here or on another tablet, and not concluded. */
export function useActiveProcedures(): QueryState<RunningMessage> {
  return useQuery((signal) => getRegistrationRunning({ signal }), {
    everyMs: ASK_EVERY_MS,
  });
}

import { useQuery, type QueryState } from "../../rest/useQuery";
import { type GatesMessage, getGates } from "../../api";

export type Gates = GatesMessage;

/** The limits of each step. */
export function useGates(): QueryState<Gates> {
  return useQuery((signal) => getGates({ signal }));
}

// Whether another person could sign in as operator. Pure.
import type { PeopleMessage } from "../api";

type People = PeopleMessage;

/** True if no other operator is signed in and no operator invitation is open. */
export function isOnlyOperator({ sessions, invitations }: Pick<People, "sessions" | "invitations">): boolean {
  const isThere = sessions.some((one) => one.role === "operator" && !one.is_own && !one.for_machine);
  const mayCome = invitations.some(
    (one) => one.role === "operator" && one.state === "open" && !one.for_machine,
  );
  return !isThere && !mayCome;
}

// Whether anybody else could come back as operator; pure.
import type { components } from "../schema";

type People = components["schemas"]["PeopleMessage"];

/** No other person is signed in as operator, and no invitation as operator waits to be used. */
export function isOnlyOperator({ sessions, invitations }: Pick<People, "sessions" | "invitations">): boolean {
  const isThere = sessions.some((one) => one.role === "operator" && !one.is_own && !one.for_machine);
  const mayCome = invitations.some(
    (one) => one.role === "operator" && one.state === "open" && !one.for_machine,
  );
  return !isThere && !mayCome;
}

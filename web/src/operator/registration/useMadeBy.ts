import { useSession } from "../../app/session";

/** The server's name for users without sign-in. */
const ANYBODY = "this computer";

/** Author of what is done here. */
export function useMadeBy(): string {
  const { session } = useSession();
  return session.state === "in" && session.who.name !== "" ? session.who.name : ANYBODY;
}

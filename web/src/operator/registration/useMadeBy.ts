import { useSession } from "../../app/session";

/** As the server calls whoever sits here where nobody has to sign in. */
const ANYBODY = "this computer";

/** Whose name stands under what is done here. */
export function useMadeBy(): string {
  const { session } = useSession();
  return session.state === "in" && session.who.name !== "" ? session.who.name : ANYBODY;
}

import { useSession } from "../../../app/session";
import { useWords } from "../../../words/WordsContext";

/** The name under which a change is stored: of who is signed in. */
export function useMadeBy(): string {
  const { session } = useSession();
  const words = useWords().plan;
  const name = session.state === "in" ? session.who.name.trim() : "";
  return name === "" ? words.nobodyNamed : name;
}

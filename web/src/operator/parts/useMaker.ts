import { useSession } from "../../app/session";
import { useWords } from "../../words/WordsContext";

/** Whose name stands under what is made here: of who is signed in, or of this tablet. */
export function useMaker(): string {
  const words = useWords().case;
  const { session } = useSession();
  const name = session.state === "in" ? session.who.name.trim() : "";
  return name === "" ? words.thisTablet : name;
}

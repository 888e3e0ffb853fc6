import { useSession } from "../../app/session";
import { useTexts } from "../../texts/TextsContext";

/** Whose name stands under what is made here: of who is signed in, or of this tablet. */
export function useMaker(): string {
  const texts = useTexts().case;
  const { session } = useSession();
  const name = session.state === "in" ? session.who.name.trim() : "";
  return name === "" ? texts.thisTablet : name;
}

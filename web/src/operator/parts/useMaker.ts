import { useSession } from "../../app/session";
import { useTexts } from "../../texts/TextsContext";

/** Author of what is made here: the signed-in user, or this tablet. */
export function useMaker(): string {
  const texts = useTexts().case;
  const { session } = useSession();
  const name = session.state === "in" ? session.who.name.trim() : "";
  return name === "" ? texts.thisTablet : name;
}

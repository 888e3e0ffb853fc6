import { useSession } from "../../../app/session";
import { useTexts } from "../../../texts/TextsContext";

/** Author of a change: the signed-in user. */
export function useMadeBy(): string {
  const { session } = useSession();
  const texts = useTexts().plan;
  const name = session.state === "in" ? session.who.name.trim() : "";
  return name === "" ? texts.nobodyNamed : name;
}

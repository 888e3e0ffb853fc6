import { useSession } from "../../../app/session";
import { useTexts } from "../../../texts/TextsContext";

/** The name under which a change is stored: of who is signed in. */
export function useMadeBy(): string {
  const { session } = useSession();
  const texts = useTexts().plan;
  const name = session.state === "in" ? session.who.name.trim() : "";
  return name === "" ? texts.nobodyNamed : name;
}

import type { Texts } from "../texts/en";

/** A name that the server made: a level and a side, of a case or of the rehearsal. */
const MADE_UP = /^(?<own>rehearsal's )?(?<level>.+) (?<side>left|right)$/u;

/** Returns the name of a channel as shown; only names that the server made are translated. */
export function channelName(
  name: string,
  { registration, theatre }: Pick<Texts, "registration" | "theatre">,
): string {
  const { own, level, side } = MADE_UP.exec(name)?.groups ?? {};
  if (level === undefined || (side !== "left" && side !== "right")) return name;
  const shown = `${level} ${registration.side[side]}`;
  return own === undefined ? shown : `${shown} · ${theatre.ofRehearsal}`;
}

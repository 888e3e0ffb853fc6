import type { Texts } from "../texts/en";

/** Name by which the server knows everybody where sign-in is off. */
const LOCAL_USER = "this computer";

/** Returns the name of a person as shown; only that of the computer is translated. */
export function personName(name: string, { room }: Pick<Texts, "room">): string {
  return name === LOCAL_USER ? room.thisComputer : name;
}

import type { Texts } from "../texts/en";

/** Name by which the server knows everybody where sign-in is off. */
const LOCAL_USER = "this computer";
/** Name of whoever signed in with the link that the server printed. */
const FIRST_OPERATOR = "Operator";

/** Returns the name of a person as shown; only names that the server gave are translated. */
export function personName(name: string, { room, signIn }: Pick<Texts, "room" | "signIn">): string {
  if (name === FIRST_OPERATOR) return signIn.role.operator;
  return name === LOCAL_USER ? room.thisComputer : name;
}

/** Returns the role to show beside a name; empty if the name is that of the role. */
export function roleBeside(name: string, role: string, texts: Pick<Texts, "room" | "signIn">): string {
  return personName(name, texts).toLowerCase() === role.toLowerCase() ? "" : role;
}

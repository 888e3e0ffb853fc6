import { expect, test } from "vitest";
import type { InvitationMessage, SignedInMessage } from "../api";
import { isOnlyOperator } from "./onlyOperator";

type Session = SignedInMessage;
type Invitation = InvitationMessage;

const session = (changed: Partial<Session>): Session => ({
  id: "a",
  name: "Ito",
  role: "operator",
  started_at: "",
  expires_at: "",
  for_machine: false,
  is_own: false,
  ...changed,
});
const invitation = (changed: Partial<Invitation>): Invitation =>
  ({ id: "i", name: "Berg", role: "operator", state: "open", for_machine: false, ...changed }) as Invitation;
const OWN = session({ is_own: true });

test.each([
  ["nobody else is there", [], [], true],
  ["another operator is signed in", [session({})], [], false],
  ["only a script is", [session({ for_machine: true })], [], true],
  ["only a supervisor is", [session({ role: "supervisor" })], [], true],
  ["an operator is invited", [], [invitation({})], false],
  ["a script is invited as operator", [], [invitation({ for_machine: true })], true],
  ["an operator's invitation was used up", [], [invitation({ state: "used" })], true],
  ["a viewer is invited", [], [invitation({ role: "viewer" })], true],
] as const)("%s", (_, sessions, invitations, isOnly) => {
  expect(isOnlyOperator({ sessions: [OWN, ...sessions], invitations: [...invitations] })).toBe(isOnly);
});

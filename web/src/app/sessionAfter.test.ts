import { expect, test } from "vitest";
import { sessionAfter, type Session } from "./sessionAfter";

const inside: Session = { state: "in", who: { name: "Ito", role: "operator" }, required: true, isHub: false };
const asking: Session = { state: "asking", silent: false };

test.each<[string, Session, Session | string, Session]>([
  ["nobody was there", asking, "SESSION_NEEDED", { state: "out", expired: false }],
  ["an old cookie", asking, "SESSION_EXPIRED", { state: "out", expired: true }],
  ["thrown out while watching", inside, "SESSION_EXPIRED", { state: "out", expired: true }],
  ["a cookie that ran out while watching", inside, "SESSION_NEEDED", { state: "out", expired: true }],
  ["the server is gone while watching", inside, "NO_ANSWER", inside],
  ["the server does not answer at first", asking, "NO_ANSWER", { state: "asking", silent: true }],
  ["signed in beside", { state: "out", expired: true }, inside, inside],
])("%s", (_, before, answer, after) => {
  expect(sessionAfter(before, answer)).toEqual(after);
});

test("an equal answer changes nothing, so that nothing is rendered again", () => {
  expect(sessionAfter(inside, { ...inside, who: { ...inside.who } })).toBe(inside);
});

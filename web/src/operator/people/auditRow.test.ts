import { expect, test } from "vitest";
import { auditRow } from "./auditRow";

test("a line is told with who, what, and from which version to which", () => {
  const line = {
    number: 7,
    at: "2026-11-21T08:00:00.000Z",
    who: { id: "a", name: "Ito", role: "operator" },
    what: "PUT /api/plan",
    of: { name: "L3" },
    status: 200,
    changes: [{ what: "plan", name: "L3", from: 3, to: 4 }],
  };
  expect(auditRow(line)).toEqual({
    number: 7,
    at: "2026-11-21T08:00:00.000Z",
    who: "Ito · operator",
    what: "PUT /api/plan · L3",
    changes: ["plan L3: 3 → 4"],
    result: "200",
  });
});

test("what is left of a damaged line is shown", () => {
  expect(auditRow({ damaged: "nonsen", who: 3, changes: [1] })).toMatchObject({ number: 0, what: "nonsen" });
});

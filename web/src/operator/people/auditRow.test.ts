import { expect, test } from "vitest";
import openapi from "../../../openapi.json?raw";
import { auditDe } from "../../texts/audit/de";
import { auditEn } from "../../texts/audit/en";
import { en } from "../../texts/en";
import { auditRow } from "./auditRow";

const ITO = { id: "a", name: "Ito", role: "operator" };

test("a line is shown with person, action and versions", () => {
  const line = {
    number: 7,
    at: "2026-11-21T08:00:00.000Z",
    who: ITO,
    what: "PUT /api/plan/vertebrae/{name}/channels/{side}",
    of: { name: "L3", side: "left" },
    status: 200,
    changes: [{ what: "plan", name: "main", from: 3, to: 4 }],
  };
  expect(auditRow(line, en)).toEqual({
    number: 7,
    at: "2026-11-21T08:00:00.000Z",
    who: "Ito · Operator",
    what: "Laid a channel · L3 · left",
    written: "PUT /api/plan/vertebrae/{name}/channels/{side}",
    changes: ["Plan: version 3 → 4"],
    result: "✓ done",
    code: "",
  });
});

test.each([
  [{ what: "PUT /api/something/{new}", of: { id: "7f3a" } }, "Other action"],
  [{ what: "GET /api/people" }, "Tried to view something"],
  [{ what: "constructor" }, "Other action"],
])("%j has no words of its own", (line, what) => {
  expect(auditRow(line, en).what).toBe(what);
});

test("a recording that was deleted by rotation is named", () => {
  const changes = [{ what: "rotation", name: "20260101T000000Z-0000.mcap", from: "stored", to: null }];
  expect(auditRow({ what: "store", changes }, en).changes).toEqual([
    "Recording deleted to make room for a new one: 20260101T000000Z-0000.mcap",
  ]);
});

test.each([
  [204, "✓ done"],
  [403, "✕ rejected"],
  [507, "✕ failed"],
  [undefined, ""],
])("an answer of %s", (status, result) => {
  expect(auditRow({ what: "start", status }, en).result).toBe(result);
});

test("automatic actions of the server have no person", () => {
  expect(auditRow({ what: "start", who: { id: "server", name: "Coaxial", role: "operator" } }, en).who).toBe(
    "Coaxial itself",
  );
});

test("what is left of a damaged line is shown", () => {
  expect(auditRow({ damaged: "nonsen", who: 3, changes: [1] }, en)).toMatchObject({
    number: 0,
    what: "A damaged line: nonsen",
    written: "nonsen",
  });
});

test("everything that the server writes down has words", () => {
  const schema = JSON.parse(openapi) as { paths: Record<string, object> };
  const changing = Object.entries(schema.paths).flatMap(([path, methods]) =>
    Object.keys(methods)
      .filter((method) => ["post", "put", "patch", "delete"].includes(method))
      .map((method) => `${method.toUpperCase()} ${path}`),
  );
  // Not logged: pages report their presence every two seconds, and a review shows an instant.
  const silent = [
    "POST /api/alarms/screens",
    "POST /api/supervision/marks",
    "PUT /api/recordings/{name}/scenes/{key}",
  ];
  const written = changing.filter((one) => !silent.includes(one));
  expect(written.filter((one) => !Object.hasOwn(auditEn.actions, one))).toEqual([]);
  expect(Object.keys(auditDe.actions)).toEqual(Object.keys(auditEn.actions));
});

import { expect, test } from "vitest";
import { recordOf, type Heading } from "./record";

function made(kind: Heading["kind"], name: string, version: number, by = "Ito"): Heading {
  return {
    id: `${kind}-${name}-${String(version)}`,
    kind,
    name,
    version,
    made_at: "2026-03-01T10:00:00.000Z",
    made_by: by,
    depends_on: [],
    files: [],
    withdrawn: null,
    imported: null,
    current: true,
    out_of_date: null,
    is_damaged: false,
  };
}

const idsOf = (documents: Heading[]): string[] =>
  recordOf(documents).map(({ first, last }) => (first === last ? first.id : `${first.id} to ${last.id}`));

test("every version is listed, including those no longer valid", () => {
  const lost = { ...made("registration", "L3", 1), current: false, out_of_date: "it was replaced" };
  expect(idsOf([made("camera", "main", 1), lost, made("registration", "L3", 2)])).toEqual([
    "camera-main-1",
    "registration-L3-1",
    "registration-L3-2",
  ]);
});

test("a plan under one hand is one entry; another hand, or other work between, begins the next", () => {
  const plan = (version: number, by?: string): Heading => made("plan", "main", version, by);
  expect(
    idsOf([plan(1), plan(2), plan(3), plan(4, "Berg"), made("check", "L3", 1), plan(5, "Berg")]),
  ).toEqual(["plan-main-1 to plan-main-3", "plan-main-4", "check-L3-1", "plan-main-5"]);
});

test("two checks of one landmark are never merged", () => {
  expect(idsOf([made("check", "L3", 1), made("check", "L3", 2)])).toHaveLength(2);
});

test("alarms have their own table", () => {
  expect(idsOf([made("alarm", "log", 1), made("ct", "main", 1)])).toEqual(["ct-main-1"]);
});

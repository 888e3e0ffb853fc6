import { expect, test } from "vitest";
import { lastIntact, newestOf } from "./newest";

const of = (
  kind: string,
  name: string,
  version: number,
): { kind: string; name: string; version: number } => ({
  kind,
  name,
  version,
});

test("each document once, in its newest version, the last made first", () => {
  const all = [
    of("camera", "main", 1),
    of("tool", "drill", 1),
    of("camera", "main", 2),
    of("tool", "awl", 1),
  ];
  expect(newestOf(all)).toEqual([of("tool", "awl", 1), of("camera", "main", 2), of("tool", "drill", 1)]);
});

test("a version that arrives late does not hide a newer one", () => {
  expect(newestOf([of("plan", "main", 3), of("plan", "main", 2)])).toEqual([of("plan", "main", 3)]);
});

test("documents of one name but of two kinds are two", () => {
  expect(newestOf([of("plan", "L3", 1), of("registration", "L3", 1)])).toHaveLength(2);
});

test("somebody can go on with the last intact version of a damaged one, unless that is withdrawn", () => {
  const stored = (version: number, damaged = false, withdrawn = false) => ({
    ...of("plan", "main", version),
    is_damaged: damaged,
    withdrawn: withdrawn ? {} : null,
  });
  const other = { ...stored(3), name: "active" };
  const lost = stored(3, true);
  expect(lastIntact([stored(1), stored(2), other, lost], lost)).toEqual(stored(2));
  expect(lastIntact([stored(1), stored(2, true), lost], lost)).toEqual(stored(1));
  expect(lastIntact([stored(1), stored(2, false, true), lost], lost)).toBeNull();
  expect(lastIntact([lost], lost)).toBeNull();
  expect(lastIntact([stored(2), lost, stored(4)], lost)).toBeNull();
  expect(lastIntact([stored(2), other], stored(2))).toBeNull();
});

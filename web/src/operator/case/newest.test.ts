import { expect, test } from "vitest";
import { newestOf } from "./newest";

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

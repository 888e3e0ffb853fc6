import { describe, expect, test } from "vitest";
import { textsFor } from "./language";
import { de } from "./de";
import { en } from "./en";

function leaves(value: object, path = ""): [string, string][] {
  return Object.entries(value).flatMap(([key, inner]: [string, unknown]) =>
    typeof inner === "object" && inner !== null
      ? leaves(inner, `${path}${key}.`)
      : [[`${path}${key}`, String(inner)]],
  );
}

describe.each([
  ["en", en],
  ["de", de],
])("%s", (_, texts) => {
  test("has every word, and none is empty", () => {
    expect(leaves(texts).map(([path]) => path)).toEqual(leaves(en).map(([path]) => path));
    expect(leaves(texts).filter(([, text]) => text.trim() === "")).toEqual([]);
  });
});

test("nearly all German texts differ from the English ones", () => {
  const english = new Map(leaves(en));
  const same = leaves(de).filter(([path, text]) => english.get(path) === text);
  expect(same.length).toBeLessThan(leaves(en).length / 5);
});

test.each([
  ["?lang=de", ["en-GB"], "de"],
  ["", ["de-AT", "en"], "de"],
  ["", ["fr", "de"], "de"],
  ["?lang=xx", ["en-US"], "en"],
  ["", ["ja"], "en"],
  ["?lang=constructor", [], "en"],
])("%s with %j speaks %s", (query, languages, spoken) => {
  expect(textsFor(query, languages).language).toBe(spoken);
});

test("no German text has a decimal point", () => {
  expect(leaves(de).filter(([, text]) => /\d\.\d/.test(text))).toEqual([]);
});

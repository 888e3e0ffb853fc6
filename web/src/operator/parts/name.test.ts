import { expect, test } from "vitest";
import { NAME, nameFrom } from "./name";

test.each([
  ["drill.png", "drill"],
  ["My drill (2).png", "My-drill-2"],
  ["_awl.new.jpeg", "awl-new"],
  ["Bohrer für L3.png", "Bohrer-f-r-L3"],
])("%s could be called %s", (file, name) => {
  expect(nameFrom(file)).toBe(name);
  expect(name).toMatch(NAME);
});

test("a file without any letter gives no name, and no name is not taken", () => {
  expect(nameFrom("(.png")).toBe("");
  expect("").not.toMatch(NAME);
});

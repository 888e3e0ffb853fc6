import { expect, test } from "vitest";
import { de } from "../texts/de";
import { en } from "../texts/en";
import { personName, roleBeside } from "./personName";

test.each([
  ["Operator", "Bedienung", ""],
  ["this computer", "dieser Computer", "Bedienung"],
  ["M. Ito", "M. Ito", "Bedienung"],
])("the name %s is shown in German as %s, with the role %s", (name, shown, role) => {
  expect(personName(name, de)).toBe(shown);
  expect(roleBeside(name, de.room.role.operator, de)).toBe(role);
});

test("whoever is called by the role has it stated once", () => {
  expect(roleBeside("Operator", en.room.role.operator, en)).toBe("");
});

import { expect, test } from "vitest";
import { tokenIn } from "./token";

const TOKEN = `0123456789ab.${"x".repeat(43)}`;

test.each([
  [`https://theatre:8000/enter#${TOKEN}`, TOKEN],
  [`  ${TOKEN}\n`, TOKEN],
  [`#${TOKEN}`, TOKEN],
  ["https://theatre:8000/enter", null],
  [`${TOKEN}y`, null],
  ["", null],
])("%j holds %j", (text, token) => {
  expect(tokenIn(text)).toBe(token);
});

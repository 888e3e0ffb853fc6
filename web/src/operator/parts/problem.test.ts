import { expect, test } from "vitest";
import { problemIn } from "./problem";

test("a refusal keeps its code, sentence and remedy", () => {
  const problem = { code: "STORE_FULL", message: "the disk is full", remedy: "Make room.", context: {} };
  expect(problemIn(JSON.stringify(problem), 507)).toEqual(problem);
});

test.each(["", "<html>", "null", '"text"', '{"detail": 1}'])(
  "without words in %j it is no answer",
  (text) => {
    expect(problemIn(text, 502)).toEqual({
      code: "NO_ANSWER",
      message: "",
      language: "en",
      remedy: "",
      context: { status: 502 },
    });
  },
);

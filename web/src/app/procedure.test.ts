import { expect, test } from "vitest";

/** Text of every source file of the page except tests, by relative path. */
const TEXTS = import.meta.glob<string>(["../**/*.{ts,tsx}", "!../**/*.test.*", "!../api/**"], {
  query: "?raw",
  import: "default",
  eager: true,
});

test("the state of the procedure is requested in one place, except for the report", () => {
  const asking = Object.entries(TEXTS).filter(([, text]) => text.includes("getProcedure("));
  expect(asking.map(([file]) => file)).toEqual(["./procedure.tsx", "../operator/report/ReportPage.tsx"]);
});

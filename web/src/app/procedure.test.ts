import { expect, test } from "vitest";

/** Text of every source file of the page except tests, by relative path. */
const TEXTS = import.meta.glob<string>(["../**/*.{ts,tsx}", "!../**/*.test.*", "!../schema.d.ts"], {
  query: "?raw",
  import: "default",
  eager: true,
});

test("how the procedure stands is asked for in one place, but for the report, which is of one moment", () => {
  const asking = Object.entries(TEXTS).filter(([, text]) => text.includes('"/api/procedure"'));
  expect(asking.map(([file]) => file)).toEqual(["./procedure.tsx", "../operator/report/ReportPage.tsx"]);
});

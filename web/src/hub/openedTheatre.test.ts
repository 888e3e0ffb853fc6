import { expect, test } from "vitest";
import { theatreAt } from "./openedTheatre";

test.each([
  ["/theatres/OR-1", "OR-1"],
  ["/theatres/", null],
  ["/theatres", null],
  ["/theatre", null],
  ["/theatres/OR-1/more", null],
])("%s shows %s", (path, theatre) => {
  expect(theatreAt(path)).toBe(theatre);
});

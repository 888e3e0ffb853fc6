import { expect, test } from "vitest";
import type { LiveProblemMessage } from "../live/messages";
import { de } from "./de";
import { en } from "./en";
import { languageOf } from "./text";

const problem = (isTranslated: boolean): LiveProblemMessage => ({
  code: "CAMERA_GONE",
  message: { en: "X", de: "X" },
  remedy: { en: "Y", de: "Y" },
  is_translated: isTranslated,
  context: {},
});

test.each([
  ["a translated problem is in the page's language, even with equal words", true, "de"],
  ["an untranslated problem is English on a German page", false, "en"],
])("%s", (_, isTranslated, language) => {
  expect(languageOf(problem(isTranslated), de)).toBe(language);
  expect(languageOf(problem(isTranslated), en)).toBe("en");
});

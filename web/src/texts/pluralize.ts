import { interpolate } from "./interpolate";

/** A sentence for one thing and for several. `{count}` is the number. */
interface PluralText {
  one: string;
  other: string;
}

/** Returns the form for `count` by the plural rules of the language, with its gaps filled. */
export function pluralize(
  text: PluralText,
  count: number,
  language: string,
  gaps: Record<string, string | number> = {},
): string {
  const form = new Intl.PluralRules(language).select(count) === "one" ? text.one : text.other;
  return interpolate(form, { ...gaps, count });
}

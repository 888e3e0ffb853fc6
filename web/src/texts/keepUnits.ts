const NUMBER_BEFORE_UNIT = /(\d) (?=(?:mm|ms|s|px|%)(?!\p{L}))/gu;

/** Returns the text with no line break between a number and its unit. */
export function keepUnits(text: string): string {
  return text.replace(NUMBER_BEFORE_UNIT, "$1\u00a0");
}

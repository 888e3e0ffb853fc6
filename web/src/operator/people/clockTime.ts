/** A time of the server as people here write it, with the day. */
export function clockTime(text: string, language: string): string {
  const form: Intl.DateTimeFormatOptions = { dateStyle: "short", timeStyle: "short" };
  return new Intl.DateTimeFormat(language === "en" ? "en-GB" : language, form).format(new Date(text));
}

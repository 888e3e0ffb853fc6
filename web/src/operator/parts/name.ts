/** What the server takes as the name of a marker or tool. */
export const NAME = /^[A-Za-z0-9][A-Za-z0-9_-]{0,39}$/;

/** "My drill (2).png" as a marker could be called. */
export function nameFrom(file: string): string {
  const bare = file.replace(/\.[^.]*$/, "").replace(/[^A-Za-z0-9_-]+/g, "-");
  return bare.replace(/^[^A-Za-z0-9]+|-+$/g, "").slice(0, 40);
}

/** Names that the server accepts for markers and tools. */
export const NAME = /^[A-Za-z0-9][A-Za-z0-9_-]{0,39}$/;

/** Suggests a marker name for a file such as "My drill (2).png". */
export function nameFrom(file: string): string {
  const bare = file.replace(/\.[^.]*$/, "").replace(/[^A-Za-z0-9_-]+/g, "-");
  return bare.replace(/^[^A-Za-z0-9]+|-+$/g, "").slice(0, 40);
}

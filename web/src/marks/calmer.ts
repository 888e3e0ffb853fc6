/** Whether this person asked for less motion. */
export function calmer(): boolean {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}

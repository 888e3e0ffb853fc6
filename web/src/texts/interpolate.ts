import { formatExact } from "../live/rounding";

/** Fills the gaps of a sentence: `interpolate("{count} of {all}", { count: 2, all: 3 })`. */
export function interpolate(sentence: string, gaps: Record<string, string | number>): string {
  return sentence.replace(/\{(\w+)\}/g, (gap, name: string) => {
    const value = gaps[name] ?? gap;
    return typeof value === "number" ? formatExact(value) : value;
  });
}

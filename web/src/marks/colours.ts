// A colour for each page that marks. Distinguishable with colour blindness, and always beside a name.
const COLOURS = ["#56b4e9", "#e69f00", "#cc79a7", "#f0e442", "#00c08b", "#ff8a5c"] as const;

export function colourOf(seat: number): string {
  return COLOURS[seat % COLOURS.length] ?? COLOURS[0];
}

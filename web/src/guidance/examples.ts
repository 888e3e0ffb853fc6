// Examples to learn the guiding sound by.
import { HOME_HZ, type Tone } from "./tone";

const ON_TARGET = { hz: HOME_HZ.offset, pan: 0 };
const PARALLEL = { hz: HOME_HZ.angle, pan: 0 };

export const EXAMPLES = {
  aligned: { kind: "align", offset: ON_TARGET, angle: PARALLEL },
  offset: { kind: "align", offset: { hz: 2 * HOME_HZ.offset, pan: -1 }, angle: PARALLEL },
  angle: { kind: "align", offset: ON_TARGET, angle: { hz: 2 * HOME_HZ.angle, pan: 1 } },
  depth: { kind: "drill", ticksPerS: 6.5, hz: 1000 },
} as const satisfies Record<string, Tone>;

export type ExampleName = keyof typeof EXAMPLES;

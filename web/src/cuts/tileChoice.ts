// Choice of cuts: in-line with the drill or in the patient's planes, and which one if there is room for one.
import { ANATOMICAL, IN_LINE, type CutName } from "./planes";

/** Content of a tile: a cut or the 3-D scene. */
export type TileName = CutName | "scene";

export interface TileChoice {
  /** Whether the planes are anatomical. */
  isAnatomical: boolean;
  name: TileName;
}

export const FIRST_CHOICE: TileChoice = { isAnatomical: false, name: "probe" };

const SAME_PLANE: Partial<Record<TileName, TileName>> = {
  axial: "anatomical-axial",
  sagittal: "anatomical-sagittal",
  "anatomical-axial": "axial",
  "anatomical-sagittal": "sagittal",
  "anatomical-coronal": "axial",
};

/** All alternatives of a single tile. */
export function choicesOf(choice: TileChoice): TileName[] {
  return ["probe", ...planesOf(choice), "scene"];
}

/** Cut of the upper of two tiles, content of the lower one, and its alternatives. */
export function pairOf(choice: TileChoice): { upper: CutName; lower: TileName; choices: TileName[] } {
  const [upper, ...others] = planesOf(choice);
  const [first = upper] = others;
  const isOther = choice.name === "scene" || others.some((one) => one === choice.name);
  return { upper, lower: isOther ? choice.name : first, choices: [...others, "scene"] };
}

/** Content of a single tile beside the probe's eye, and its alternatives. */
export function besideProbe(choice: TileChoice): { name: TileName; choices: TileName[] } {
  const planes = planesOf(choice);
  const choices: TileName[] = [...planes, "scene"];
  return { name: choices.includes(choice.name) ? choice.name : planes[0], choices };
}

/** The same view in the other kind of planes. */
export function switched({ isAnatomical: was, name }: TileChoice): TileChoice {
  return { isAnatomical: !was, name: SAME_PLANE[name] ?? name };
}

/** Whether the kind of planes can be chosen for this content. */
export function hasPlane({ name }: TileChoice): boolean {
  return name in SAME_PLANE;
}

function planesOf({ isAnatomical: is }: TileChoice): readonly [CutName, ...CutName[]] {
  return is ? ANATOMICAL : IN_LINE;
}

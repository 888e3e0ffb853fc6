// Which cuts are shown: in-line with the drill or in the patient's planes, and which one where there is room for one.
import { ANATOMICAL, IN_LINE, type CutName } from "./planes";

/** What a tile shows: a cut, or the 3-D scene in its place. */
export type TileName = CutName | "scene";

export interface TileChoice {
  /** Whether the planes are the patient's, not the drill's. */
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

/** All that the only tile of a page can show. */
export function choicesOf(choice: TileChoice): TileName[] {
  return ["probe", ...planesOf(choice), "scene"];
}

/** The cut of the upper of two tiles, what the lower one shows, and what else it can show. */
export function pairOf(choice: TileChoice): { upper: CutName; lower: TileName; choices: TileName[] } {
  const [upper, ...others] = planesOf(choice);
  const [first = upper] = others;
  const isOther = choice.name === "scene" || others.some((one) => one === choice.name);
  return { upper, lower: isOther ? choice.name : first, choices: [...others, "scene"] };
}

/** The same view in the other planes. */
export function switched({ isAnatomical: was, name }: TileChoice): TileChoice {
  return { isAnatomical: !was, name: SAME_PLANE[name] ?? name };
}

/** Whether another plane than the drill's or the patient's can be chosen for what is shown. */
export function hasPlane({ name }: TileChoice): boolean {
  return name in SAME_PLANE;
}

function planesOf({ isAnatomical: is }: TileChoice): readonly [CutName, ...CutName[]] {
  return is ? ANATOMICAL : IN_LINE;
}

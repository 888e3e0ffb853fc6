import { useState, type ReactNode } from "react";
import { CutTile, OnlyTile } from "../cuts/CutTile";
import { besideProbe, FIRST_CHOICE, pairOf, type TileChoice } from "../cuts/tileChoice";
import type { Layout } from "./layouts/layout";

/** What a layout shows first in the tile that can be chosen. */
const FIRST: Partial<Record<Layout, TileChoice>> = { drill: { isAnatomical: false, name: "axial" } };

/**
 * The cuts of the CT and the 3-D scene. A theatre screen shows the probe's eye, and beside it one or two tiles: a touch
 * replaces a cut by another one or by the scene, for each layout on its own. A smaller screen shows one tile.
 */
export function Tiles({ layout, isWide }: { layout: Layout; isWide: boolean }): ReactNode {
  const [chosen, setChosen] = useState<Partial<Record<Layout, TileChoice>>>({});
  const choice = chosen[layout] ?? FIRST[layout] ?? FIRST_CHOICE;
  const onChoose = (next: TileChoice): void => {
    setChosen({ ...chosen, [layout]: next });
  };
  if (!isWide) return <OnlyTile choice={choice} onChoose={onChoose} />;
  const hasPair = layout === "overview" || layout === "drill";
  const pair = pairOf(choice);
  const { name, choices } = hasPair ? { name: pair.lower, choices: pair.choices } : besideProbe(choice);
  // The scene needs the place of both, except in the drill layout, where they are side by side.
  const hasUpper = hasPair && (name !== "scene" || layout === "drill");
  const hasKind = !hasUpper && name !== "scene";
  return (
    <>
      <div className="tiles">
        {hasUpper && <CutTile key="upper" name={pair.upper} choice={choice} onChoose={onChoose} hasKind />}
        <CutTile
          key="chosen"
          name={name}
          choices={choices}
          choice={{ ...choice, name }}
          onChoose={onChoose}
          hasKind={hasKind}
        />
      </div>
      <div className="tiles tiles-eye">
        <CutTile name="probe" choice={choice} onChoose={onChoose} />
      </div>
    </>
  );
}

import { useState, type ReactNode } from "react";
import { AfterFirstMessage } from "../live/AfterFirstMessage";
import { LoadingPane } from "../panes/LoadingPane";
import { ScenePane } from "../panes/ScenePane";
import { useTexts } from "../texts/TextsContext";
import { CutPane } from "./CutPane";
import type { CutName } from "./planes";

/** What a tile shows: a cut, or the 3-D scene in its place. */
export type TileName = CutName | "scene";

export const TILES: readonly TileName[] = ["probe", "axial", "sagittal", "scene"];

interface CutTileProps {
  name: TileName;
  choices?: readonly TileName[];
  onChoose?: (name: TileName) => void;
}

/** One cut or the 3-D scene, with what else can be shown in its place. */
export function CutTile({ name, choices = [], onChoose }: CutTileProps): ReactNode {
  const texts = useTexts();
  const t = texts.theatre.cuts;
  const tabs = choices.length > 0 && (
    <div className="tile-tabs" role="group" aria-label={t.tabs}>
      {choices.map((one) => (
        <button
          key={one}
          type="button"
          aria-pressed={one === name}
          data-testid={`tile-${one}`}
          onClick={() => onChoose?.(one)}
        >
          {one === "scene" ? texts.scene.title : t.short[one]}
        </button>
      ))}
    </div>
  );
  if (name === "scene") return <ScenePane tabs={tabs} />;
  return (
    <AfterFirstMessage loading={<LoadingPane id={`cut-${name}`} title={t.title[name]} />}>
      <CutPane key={name} name={name} tabs={tabs} />
    </AfterFirstMessage>
  );
}

/** The only tile of a page that has no room for more: the probe's eye, until something else is chosen. */
export function OnlyTile(): ReactNode {
  const [chosen, setChosen] = useState<TileName>("probe");
  return (
    <div className="tiles tiles-one">
      <CutTile name={chosen} choices={TILES} onChoose={setChosen} />
    </div>
  );
}

import { useState, useSyncExternalStore, type ReactNode } from "react";
import { CutPane } from "../cuts/CutPane";
import type { CutName } from "../cuts/planes";
import { AfterFirstMessage } from "../live/AfterFirstMessage";
import { LoadingPane } from "../panes/LoadingPane";
import { ScenePane } from "../panes/ScenePane";
import { useTexts } from "../texts/TextsContext";

type TileName = CutName | "scene";

const TILES: readonly TileName[] = ["probe", "axial", "sagittal", "scene"];
/** Room for three cuts beside the video. */
const WIDE = "(min-width: 1400px) and (min-aspect-ratio: 11/10)";

function useIsWide(): boolean {
  return useSyncExternalStore(
    (onChange) => {
      const query = matchMedia(WIDE);
      query.addEventListener("change", onChange);
      return () => {
        query.removeEventListener("change", onChange);
      };
    },
    () => matchMedia(WIDE).matches,
  );
}

/**
 * The cuts through the CT and the 3-D scene: three cuts on a theatre's screen, where the scene takes the place of both
 * in-line cuts by a touch, and one of the four on a smaller screen.
 */
export function Tiles(): ReactNode {
  const isWide = useIsWide();
  const [chosen, setChosen] = useState<TileName>("probe");
  if (!isWide) {
    return (
      <div className="tiles tiles-one">
        <Tile name={chosen} choices={TILES} onChoose={setChosen} />
      </div>
    );
  }
  const isScene = chosen === "scene";
  return (
    <>
      <div className="tiles">
        {!isScene && <Tile name="axial" />}
        <Tile name={isScene ? "scene" : "sagittal"} choices={["sagittal", "scene"]} onChoose={setChosen} />
      </div>
      <div className="tiles tiles-eye">
        <Tile name="probe" />
      </div>
    </>
  );
}

interface TileProps {
  name: TileName;
  choices?: readonly TileName[];
  onChoose?: (name: TileName) => void;
}

function Tile({ name, choices = [], onChoose }: TileProps): ReactNode {
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

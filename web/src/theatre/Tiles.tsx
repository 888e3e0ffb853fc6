import { useState, useSyncExternalStore, type ReactNode } from "react";
import { CutTile, TILES, type TileName } from "../cuts/CutTile";

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
        <CutTile name={chosen} choices={TILES} onChoose={setChosen} />
      </div>
    );
  }
  const isScene = chosen === "scene";
  return (
    <>
      <div className="tiles">
        {!isScene && <CutTile name="axial" />}
        <CutTile name={isScene ? "scene" : "sagittal"} choices={["sagittal", "scene"]} onChoose={setChosen} />
      </div>
      <div className="tiles tiles-eye">
        <CutTile name="probe" />
      </div>
    </>
  );
}

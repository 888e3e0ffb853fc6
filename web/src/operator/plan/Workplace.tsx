import { useEffect, type ReactNode } from "react";
import { QueryStatus } from "../../rest/QueryStatus";
import { useTexts } from "../../texts/TextsContext";
import { ChannelPart } from "./channel/ChannelPart";
import { CtPart } from "./ct/CtPart";
import { PlanDrawing } from "./drawing/PlanDrawing";
import { FilePart } from "./file/FilePart";
import { LevelProblems } from "./labels/LevelProblems";
import { LandmarksPart } from "./landmarks/LandmarksPart";
import { LinesPart } from "./lines/LinesPart";
import { PediclePart } from "./pedicle/PediclePart";
import { PlanBar } from "./PlanBar";
import { Planes } from "./slices/Planes";
import { useSlices } from "./slices/SlicesContext";
import { channelOf } from "./state/shape";
import { usePlanning } from "./state/PlanContext";
import { useWork, type Part } from "./state/WorkContext";
import { SurfacePart } from "./surface/SurfacePart";

/** The slices, and beside them the current part of the plan. */
export function Workplace({ onCtTaken }: { onCtTaken: () => void }): ReactNode {
  const texts = useTexts().plan;
  const { part } = useWork();
  const { isLoading, planRejection, askAgain } = usePlanning();
  useWayOfChannel();
  const parts: Record<Part, () => ReactNode> = {
    ct: () => <CtPart onTaken={onCtTaken} />,
    pedicle: () => <PediclePart />,
    channel: () => <ChannelPart />,
    lines: () => <LinesPart />,
    landmarks: () => <LandmarksPart />,
    surface: () => <SurfacePart />,
    file: () => <FilePart />,
  };
  return (
    <div className="plan">
      <PlanBar />
      <div className="plan-body">
        <Planes drawing={(plane, projection) => <PlanDrawing plane={plane} projection={projection} />} />
        <aside className="plan-side" aria-label={texts.part[part]}>
          <LevelProblems />
          {isLoading && part !== "ct" ? (
            <QueryStatus query={{ rejection: planRejection, refetch: askAgain }} />
          ) : (
            parts[part]()
          )}
        </aside>
      </div>
    </div>
  );
}

/** Oblique slices follow the stored channel of the chosen side, also while it is being moved. */
function useWayOfChannel(): void {
  const { vertebra, side } = usePlanning();
  const { setWay } = useSlices();
  const channel = channelOf(vertebra, side)?.channel ?? null;
  const key =
    channel === null ? "" : JSON.stringify([channel.entry_in_vertebra_mm, channel.target_in_vertebra_mm]);
  useEffect(() => {
    if (key === "") {
      setWay(null);
      return;
    }
    const [entry, target] = JSON.parse(key) as [[number, number, number], [number, number, number]];
    setWay({ entry, target });
  }, [key, setWay]);
}

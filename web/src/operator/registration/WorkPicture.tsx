import type { ReactNode } from "react";
import type { SceneRequest } from "../../api";
import { LiveStage } from "./LiveStage";
import { RehearsalStrip } from "./RehearsalStrip";
import { TipContact } from "./TipContact";

/** The live picture of a step that touches bone; in a rehearsal with its scene, and what the tip is on. */
export function WorkPicture({ scene }: { scene: SceneRequest["scene"] }): ReactNode {
  return (
    <div className="work-main">
      <LiveStage />
      <RehearsalStrip scenes={[scene]}>{(rehearsal) => <TipContact rehearsal={rehearsal} />}</RehearsalStrip>
    </div>
  );
}

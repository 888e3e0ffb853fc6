import type { ReactNode } from "react";
import { EmptyState } from "../../../panes/EmptyState";
import { QueryStatus } from "../../../rest/QueryStatus";
import { useTexts } from "../../../texts/TextsContext";
import { useProcedure } from "../../../app/procedure";
import { LiveStage } from "../LiveStage";
import { NudgesWork } from "./NudgesWork";

/** Small corrections by hand, with the overlaid vertebra in view. */
export function NudgesPage(): ReactNode {
  const texts = useTexts().registration.nudges;
  const procedure = useProcedure();
  const step = procedure.data?.steps.find((one) => one.step === "register");
  if (step === undefined) return <QueryStatus query={procedure} />;
  if (step.state !== "done") return <EmptyState drawing="registration" sentence={texts.needsRegistration} />;
  return (
    <div className="work">
      <LiveStage />
      <div className="work-side">
        <NudgesWork />
      </div>
    </div>
  );
}

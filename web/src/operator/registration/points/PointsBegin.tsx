import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postRegistrationPoints } from "../../../api";
import { useAction } from "../../../rest/useAction";
import { useTexts } from "../../../texts/TextsContext";
import { StepActions } from "../../StepActions";
import { WorkPicture } from "../WorkPicture";
import { RegistrationRejection } from "../RegistrationRejection";
import { ToolChoice } from "../ToolChoice";
import { ToolSeen } from "../ToolSeen";
import { useTools } from "../useTools";

/** Before the first landmark: instructions and choice of the tool. */
export function PointsBegin({ onBegun }: { onBegun: () => void }): ReactNode {
  const texts = useTexts().registration;
  const first = useTools()?.[0]?.name ?? "";
  const [chosen, setChosen] = useState("");
  const tool = chosen || first;
  const beginning = useAction();
  return (
    <div className="work">
      <WorkPicture scene="landmarks" />
      <div className="work-side">
        <section className="card">
          <h3>{texts.points.before}</h3>
          <ol className="steps">
            {texts.points.steps.map((step) => (
              <li key={step}>{step}</li>
            ))}
          </ol>
          <ToolChoice tool={tool} onTool={setChosen} />
          <ToolSeen tool={tool} />
          <RegistrationRejection rejection={beginning.rejection} />
        </section>
      </div>
      <StepActions>
        <Button
          size="xl"
          disabled={tool === ""}
          loading={beginning.busy}
          data-testid="points-begin"
          onClick={() => {
            void beginning
              .run(async () => {
                await postRegistrationPoints({ body: { tool } });
              })
              .then(onBegun);
          }}
        >
          {texts.points.begin}
        </Button>
      </StepActions>
    </div>
  );
}

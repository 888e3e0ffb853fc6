import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postRegistrationSweep } from "../../../api";
import { useAction } from "../../../rest/useAction";
import { useTexts } from "../../../texts/TextsContext";
import { useProcedure } from "../../../app/procedure";
import { StepActions } from "../../StepActions";
import { WorkPicture } from "../WorkPicture";
import { RegistrationRejection } from "../RegistrationRejection";
import { ToolChoice } from "../ToolChoice";
import { ToolSeen } from "../ToolSeen";
import { useTools } from "../useTools";

/** Before the sweep: requirements and instructions. */
export function SweepBegin({ onBegun }: { onBegun: () => void }): ReactNode {
  const texts = useTexts().registration;
  const procedure = useProcedure().data;
  const first = useTools()?.[0]?.name ?? "";
  const [chosen, setChosen] = useState("");
  const tool = chosen || first;
  const beginning = useAction();
  const registered = procedure?.steps.some((one) => one.step === "register" && one.state === "done") === true;
  return (
    <div className="work">
      <WorkPicture scene="sweep" />
      <section className="card work-side">
        <h3>{texts.sweep.before}</h3>
        <ol className="steps">
          {texts.sweep.steps.map((step) => (
            <li key={step}>{step}</li>
          ))}
        </ol>
        {!registered && <p className="warning">▲ {texts.sweep.needsPoints}</p>}
        <ToolChoice tool={tool} onTool={setChosen} />
        <ToolSeen tool={tool} />
        <RegistrationRejection rejection={beginning.rejection} />
      </section>
      <StepActions>
        <Button
          size="xl"
          disabled={tool === "" || !registered}
          loading={beginning.busy}
          data-testid="sweep-begin"
          onClick={() => {
            void beginning
              .run(async () => {
                await postRegistrationSweep({ body: { tool } });
              })
              .then(onBegun);
          }}
        >
          {texts.sweep.begin}
        </Button>
      </StepActions>
    </div>
  );
}

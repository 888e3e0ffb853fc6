import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { getPlan, postRegistrationCheck } from "../../api";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useAction } from "../../rest/useAction";
import { useTexts } from "../../texts/TextsContext";
import { StepActions } from "../StepActions";
import { WorkPicture } from "../registration/WorkPicture";
import { interpolate } from "../../texts/interpolate";
import { plannedVertebrae } from "../registration/planReader";
import { WhereToTouch } from "../registration/points/WhereToTouch";
import { RegistrationRejection } from "../registration/RegistrationRejection";
import { ToolChoice } from "../registration/ToolChoice";
import { ToolSeen } from "../registration/ToolSeen";
import { useTools } from "../registration/useTools";

interface CheckChoiceProps {
  vertebra: string;
  used: readonly string[];
  maxMm: number;
  onBegun: () => void;
}

/** Choice of a landmark that was not used for the registration. */
export function CheckChoice({ vertebra, used, maxMm, onBegun }: CheckChoiceProps): ReactNode {
  const texts = useTexts().check;
  const plan = useQuery((signal) => getPlan({ signal }));
  const first = useTools()?.[0]?.name ?? "";
  const [tool, setTool] = useState("");
  const [picked, setPicked] = useState<string | null>(null);
  const beginning = useAction();
  if (plan.data === null) return <QueryStatus query={plan} Note={RegistrationRejection} />;
  const landmarks = plannedVertebrae(plan.data.plan).find((one) => one.name === vertebra)?.landmarks ?? [];
  const free = landmarks.filter((one) => !used.includes(one.name));
  const landmark = free.find((one) => one.name === picked) ?? null;
  const touching = tool || first;
  return (
    <div className="work">
      <WorkPicture scene="check" />
      <section className="card work-side">
        <h3>{texts.choose}</h3>
        <p>{interpolate(texts.why, { max: maxMm })}</p>
        {free.length === 0 && <p className="warning">▲ {texts.noneFree}</p>}
        <ul className="landmarks">
          {landmarks.map((one) => {
            const taken = used.includes(one.name);
            return (
              <li key={one.name}>
                <button
                  type="button"
                  className="landmark-name"
                  disabled={taken}
                  aria-pressed={one.name === picked}
                  data-testid={`check-${one.name}`}
                  onClick={() => {
                    setPicked(one.name);
                  }}
                >
                  <span aria-hidden="true">{taken ? "–" : one.name === picked ? "●" : "○"}</span>
                  <span>
                    {one.name}
                    {taken && <small>{texts.wasUsed}</small>}
                  </span>
                </button>
              </li>
            );
          })}
        </ul>
        {landmark !== null && <WhereToTouch name={landmark.name} pointMm={landmark.pointMm} />}
        <ToolChoice tool={touching} onTool={setTool} />
        <ToolSeen tool={touching} />
        <RegistrationRejection rejection={beginning.rejection} />
      </section>
      <StepActions>
        <Button
          size="xl"
          disabled={landmark === null || touching === ""}
          loading={beginning.busy}
          data-testid="check-begin"
          onClick={() => {
            if (landmark === null) return;
            void beginning
              .run(async () => {
                await postRegistrationCheck({ body: { landmark: landmark.name, tool: touching } });
              })
              .then(onBegun);
          }}
        >
          {texts.begin}
        </Button>
      </StepActions>
    </div>
  );
}

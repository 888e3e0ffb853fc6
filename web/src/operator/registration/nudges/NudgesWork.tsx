import { Button, SegmentedControl } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { deleteRegistrationNudgesLast, getRegistrationNudges, postRegistrationNudges } from "../../../api";
import { QueryStatus } from "../../../rest/QueryStatus";
import { useQuery } from "../../../rest/useQuery";
import { useAction } from "../../../rest/useAction";
import { formatExact } from "../../../live/rounding";
import { Icon } from "../../../panes/Icon";
import { useTexts } from "../../../texts/TextsContext";
import { useProcedure } from "../../../app/procedure";
import { StepActions } from "../../StepActions";
import { RegistrationRejection } from "../RegistrationRejection";
import { useMadeBy } from "../useMadeBy";
import { NudgeLog } from "./NudgeLog";
import { NudgePad, type Axis, type Kind } from "./NudgePad";
import { NudgeSums } from "./NudgeSums";

const STEPS = [0.1, 0.5, 1];

/** One step at a time, the total with its limit, and undo. */
export function NudgesWork(): ReactNode {
  const texts = useTexts().registration;
  const procedure = useProcedure();
  const madeBy = useMadeBy();
  const query = useQuery((signal) => getRegistrationNudges({ signal }));
  const [kind, setKind] = useState<Kind>("shift");
  const [step, setStep] = useState(0.5);
  const doing = useAction();
  const { data } = query;

  const run = (action: () => Promise<unknown>): void => {
    void doing
      .run(async () => {
        await action();
      })
      .then(() => {
        query.refetch();
        procedure.refetch();
      });
  };
  const nudge = (axis: Axis, way: 1 | -1): void => {
    run(() => postRegistrationNudges({ body: { made_by: madeBy, kind, axis, amount: way * step } }));
  };
  return (
    <>
      <section className="card">
        <p className="warning">▲ {texts.nudges.checkAgain}</p>
        {data !== null && <NudgeSums nudges={data} />}
        <div className="row">
          <SegmentedControl
            size="lg"
            aria-label={texts.nudges.kind}
            value={kind}
            onChange={(value) => {
              setKind(value === "turn" ? "turn" : "shift");
            }}
            data={[
              { value: "shift", label: texts.nudges.shift },
              { value: "turn", label: texts.nudges.turn },
            ]}
          />
          <SegmentedControl
            size="lg"
            aria-label={texts.nudges.step}
            value={String(step)}
            onChange={(value) => {
              setStep(Number(value));
            }}
            data={STEPS.map((one) => ({
              value: String(one),
              label: `${formatExact(one)} ${kind === "shift" ? "mm" : "°"}`,
            }))}
          />
        </div>
        <NudgePad kind={kind} disabled={doing.busy} onNudge={nudge} />
        <RegistrationRejection rejection={doing.rejection} />
        {data === null && <QueryStatus query={query} Note={RegistrationRejection} />}
      </section>
      <StepActions>
        <Button
          size="lg"
          variant="default"
          disabled={doing.busy || data === null || data.nudges.length === 0}
          data-testid="nudge-undo"
          onClick={() => {
            run(() => deleteRegistrationNudgesLast({ query: { made_by: madeBy } }));
          }}
        >
          <Icon name="undo" /> {texts.nudges.undo}
        </Button>
      </StepActions>
      {data !== null && <NudgeLog nudges={data.nudges} />}
    </>
  );
}

import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { useLocation } from "wouter";
import {
  deleteRegistrationCheck,
  getRegistrationCheck,
  postRegistrationCheck,
  postRegistrationCheckConclusion,
} from "../../api";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useAction } from "../../rest/useAction";
import { Icon } from "../../panes/Icon";
import { useTexts } from "../../texts/TextsContext";
import { useProcedure } from "../../app/procedure";
import { StepActions } from "../StepActions";
import { CaptureProgress } from "../registration/CaptureProgress";
import { WorkPicture } from "../registration/WorkPicture";
import { RegistrationRejection } from "../registration/RegistrationRejection";
import { ToolSeen } from "../registration/ToolSeen";
import { useMadeBy } from "../registration/useMadeBy";
import { CheckOutcome } from "./CheckOutcome";

const ASK_EVERY_MS = 250;

interface CheckWorkProps {
  onOver: () => void;
  /** Called after the check was saved, passed or failed. */
  onStored: () => void;
}

/** Measures the tip on the landmark, then shows the distance and the choices. */
export function CheckWork({ onOver, onStored }: CheckWorkProps): ReactNode {
  const texts = useTexts().check;
  const procedure = useProcedure();
  const madeBy = useMadeBy();
  const [, navigate] = useLocation();
  const query = useQuery((signal) => getRegistrationCheck({ signal }), {
    everyMs: ASK_EVERY_MS,
  });
  const doing = useAction();
  const { data } = query;
  if (data === null) return <QueryStatus query={query} Note={RegistrationRejection} />;
  const { outcome, capture } = data;
  const run = (action: () => Promise<unknown>, then: (done: boolean) => void): void => {
    void doing
      .run(async () => {
        await action();
      })
      .then(then);
  };
  return (
    <div className="work">
      <WorkPicture scene="check" />
      <section className="card work-side">
        <h3>{capture.landmark}</h3>
        <ToolSeen tool={data.tool} />
        <CaptureProgress capture={capture} maxSpreadMm={data.max_spread_mm} />
        {outcome === null ? <p className="quiet">{texts.byEye}</p> : <CheckOutcome outcome={outcome} />}
        <RegistrationRejection rejection={doing.rejection} />
      </section>
      <StepActions>
        <Button
          size="lg"
          variant="default"
          data-testid="check-end"
          onClick={() => {
            run(() => deleteRegistrationCheck(), onOver);
          }}
        >
          {texts.other}
        </Button>
        <Button
          size="lg"
          variant="default"
          data-testid="check-again"
          onClick={() => {
            run(
              () => postRegistrationCheck({ body: { landmark: capture.landmark, tool: data.tool } }),
              query.refetch,
            );
          }}
        >
          <Icon name="undo" /> {texts.again}
        </Button>
        <Button
          size="xl"
          disabled={outcome === null}
          color={outcome?.passed === false ? "yellow" : "cyan"}
          loading={doing.busy}
          data-testid="check-conclude"
          onClick={() => {
            const passed = outcome?.passed === true;
            run(
              () => postRegistrationCheckConclusion({ body: { made_by: madeBy } }),
              (done) => {
                procedure.refetch();
                onOver();
                if (done) onStored();
                if (done && passed) navigate("/operator/navigate");
              },
            );
          }}
        >
          {outcome?.passed === false ? texts.keepFailed : texts.keep}
        </Button>
      </StepActions>
    </div>
  );
}

import { Button, Loader } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { useLocation } from "wouter";
import { Rejection } from "../../../rest/client";
import { QueryStatus } from "../../../rest/QueryStatus";
import { useQuery } from "../../../rest/useQuery";
import { useAction } from "../../../rest/useAction";
import {
  deleteRegistrationSweep,
  getRegistrationSweep,
  postRegistrationSweep,
  postRegistrationSweepConclusion,
  postRegistrationSweepFit,
  putRegistrationSweep,
  type SweepFitMessage,
} from "../../../api";
import { Icon } from "../../../panes/Icon";
import { useTexts } from "../../../texts/TextsContext";
import { useProcedure } from "../../../app/procedure";
import { StepActions } from "../../StepActions";
import { WorkPicture } from "../WorkPicture";
import { RegistrationRejection } from "../RegistrationRejection";
import { ConfirmOrCancelButton } from "../ConfirmOrCancelButton";
import { ToolSeen } from "../ToolSeen";
import { useMadeBy } from "../useMadeBy";
import { SweepFit } from "./SweepFit";
import { SweepProgress } from "./SweepProgress";

type Fit = SweepFitMessage;
const ASK_EVERY_MS = 300;

/** Runs the sweep: capture or pause, fit to the bone, register or repeat. */
export function SweepWork({ onOver }: { onOver: () => void }): ReactNode {
  const texts = useTexts().registration;
  const procedure = useProcedure();
  const madeBy = useMadeBy();
  const [, navigate] = useLocation();
  const query = useQuery((signal) => getRegistrationSweep({ signal }), {
    everyMs: ASK_EVERY_MS,
  });
  const [fit, setFit] = useState<Fit | null>(null);
  const doing = useAction();
  const fitting = useAction();
  const { data } = query;
  if (data === null) return <QueryStatus query={query} Note={RegistrationRejection} />;

  const run = (action: () => Promise<unknown>, then: (done: boolean) => void): void => {
    void doing
      .run(async () => {
        await action();
      })
      .then(then);
  };
  const lay = (): void => {
    void fitting.run(async () => {
      // Paused during the fit, so that the tip need not be held still.
      if (data.taking) await putRegistrationSweep({ body: { taking: false } });
      query.refetch();
      setFit(null);
      setFit(await postRegistrationSweepFit());
    });
  };
  return (
    <div className="work">
      <WorkPicture scene="sweep" />
      <div className="work-side">
        <section className="card">
          <ToolSeen tool={data.tool} />
          <SweepProgress sweep={data} />
          {data.problem !== null && <RegistrationRejection rejection={new Rejection(data.problem)} />}
        </section>
        <RegistrationRejection rejection={doing.rejection ?? fitting.rejection} />
        {fitting.busy && (
          <p className="row" role="status">
            <Loader size="sm" /> {texts.sweep.fitting}
          </p>
        )}
        {fit !== null && <SweepFit fit={fit} />}
      </div>
      <StepActions>
        <ConfirmOrCancelButton
          needsConfirmation
          variant="default"
          confirmLabel={texts.throwAwaySure}
          onConfirm={() => {
            run(() => deleteRegistrationSweep(), onOver);
          }}
        >
          {texts.throwAway}
        </ConfirmOrCancelButton>
        <ConfirmOrCancelButton
          needsConfirmation
          variant="default"
          confirmLabel={texts.throwAwaySure}
          testId="sweep-again"
          onConfirm={() => {
            setFit(null);
            run(() => postRegistrationSweep({ body: { tool: data.tool } }), query.refetch);
          }}
        >
          <Icon name="undo" /> {texts.sweep.again}
        </ConfirmOrCancelButton>
        <Button size="lg" variant="default" loading={fitting.busy} data-testid="sweep-fit" onClick={lay}>
          {texts.sweep.fit}
        </Button>
        <ConfirmOrCancelButton
          needsConfirmation
          confirmLabel={texts.replaceSure}
          disabled={fit === null || fit.missing.length > 0}
          busy={doing.busy}
          testId="sweep-conclude"
          onConfirm={() => {
            run(
              () => postRegistrationSweepConclusion({ body: { made_by: madeBy } }),
              (done) => {
                procedure.refetch();
                if (done) navigate("/operator/register");
              },
            );
          }}
        >
          {texts.sweep.conclude}
        </ConfirmOrCancelButton>
        <Button
          size="xl"
          variant={data.taking ? "default" : "filled"}
          aria-pressed={data.taking}
          loading={doing.busy}
          data-testid="sweep-take"
          onClick={() => {
            setFit(null);
            run(() => putRegistrationSweep({ body: { taking: !data.taking } }), query.refetch);
          }}
        >
          {data.taking ? texts.sweep.lift : texts.sweep.take}
        </Button>
      </StepActions>
    </div>
  );
}

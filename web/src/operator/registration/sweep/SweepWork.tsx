import { Button, Loader } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { useLocation } from "wouter";
import { answered, Rejection, server } from "../../../rest/client";
import { Unanswered } from "../../../rest/Unanswered";
import { useAsked } from "../../../rest/useAsked";
import { useDo } from "../../../rest/useDo";
import type { components } from "../../../schema";
import { Icon } from "../../../panes/Icon";
import { useTexts } from "../../../texts/TextsContext";
import { useProcedure } from "../../../app/procedure";
import { LiveStage } from "../LiveStage";
import { Rejected } from "../Rejected";
import { SureButton } from "../SureButton";
import { ToolSeen } from "../ToolSeen";
import { useMadeBy } from "../useMadeBy";
import { SweepFit } from "./SweepFit";
import { SweepProgress } from "./SweepProgress";

type Fit = components["schemas"]["SweepFitMessage"];
const ASK_EVERY_MS = 300;

/** The sweep as it goes: taken or lifted, laid on the bone to see what it gives, kept or begun again. */
export function SweepWork({ onOver }: { onOver: () => void }): ReactNode {
  const texts = useTexts().registration;
  const procedure = useProcedure();
  const madeBy = useMadeBy();
  const [, navigate] = useLocation();
  const asked = useAsked((signal) => answered(server.GET("/api/registration/sweep", { signal })), {
    everyMs: ASK_EVERY_MS,
  });
  const [fit, setFit] = useState<Fit | null>(null);
  const doing = useDo();
  const fitting = useDo();
  const { data } = asked;
  if (data === null) return <Unanswered asked={asked} Note={Rejected} />;

  const run = (action: () => Promise<unknown>, then: (done: boolean) => void): void => {
    void doing
      .run(async () => {
        await action();
      })
      .then(then);
  };
  const lay = (): void => {
    void fitting.run(async () => {
      // Off the bone while it is looked at: the hand need not hold still for that.
      if (data.taking) await answered(server.PUT("/api/registration/sweep", { body: { taking: false } }));
      asked.again();
      setFit(null);
      setFit(await answered(server.POST("/api/registration/sweep/fit")));
    });
  };
  return (
    <div className="work">
      <LiveStage />
      <div className="work-side">
        <section className="card">
          <ToolSeen tool={data.tool} />
          <SweepProgress sweep={data} />
          {data.problem !== null && <Rejected rejection={new Rejection(data.problem)} />}
          <Button
            size="xl"
            fullWidth
            variant={data.taking ? "default" : "filled"}
            aria-pressed={data.taking}
            loading={doing.busy}
            data-testid="sweep-take"
            onClick={() => {
              setFit(null);
              run(
                () => answered(server.PUT("/api/registration/sweep", { body: { taking: !data.taking } })),
                asked.again,
              );
            }}
          >
            {data.taking ? texts.sweep.lift : texts.sweep.take}
          </Button>
        </section>
        <Rejected rejection={doing.rejection ?? fitting.rejection} />
        {fitting.busy && (
          <p className="row" role="status">
            <Loader size="sm" /> {texts.sweep.fitting}
          </p>
        )}
        {fit !== null && <SweepFit fit={fit} />}
        <div className="row">
          <Button size="lg" variant="default" loading={fitting.busy} data-testid="sweep-fit" onClick={lay}>
            {texts.sweep.fit}
          </Button>
          <SureButton
            ask
            sure={texts.replaceSure}
            disabled={fit === null || fit.missing.length > 0}
            busy={doing.busy}
            testId="sweep-conclude"
            onSure={() => {
              run(
                () =>
                  answered(server.POST("/api/registration/sweep/conclusion", { body: { made_by: madeBy } })),
                (done) => {
                  procedure.again();
                  if (done) navigate("/operator/register");
                },
              );
            }}
          >
            {texts.sweep.conclude}
          </SureButton>
          <SureButton
            ask
            variant="default"
            sure={texts.throwAwaySure}
            testId="sweep-again"
            onSure={() => {
              setFit(null);
              run(
                () => answered(server.POST("/api/registration/sweep", { body: { tool: data.tool } })),
                asked.again,
              );
            }}
          >
            <Icon name="undo" /> {texts.sweep.again}
          </SureButton>
          <SureButton
            ask
            variant="default"
            sure={texts.throwAwaySure}
            onSure={() => {
              run(() => answered(server.DELETE("/api/registration/sweep")), onOver);
            }}
          >
            {texts.throwAway}
          </SureButton>
        </div>
      </div>
    </div>
  );
}

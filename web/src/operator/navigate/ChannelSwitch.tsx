import { useState, type ReactNode } from "react";
import { answered, server } from "../../rest/client";
import { Unanswered } from "../../rest/Unanswered";
import { useAsked } from "../../rest/useAsked";
import { useDo } from "../../rest/useDo";
import { useTexts } from "../../texts/TextsContext";
import { useProcedure } from "../../app/procedure";
import { interpolate } from "../../texts/interpolate";
import { plannedVertebrae } from "../registration/planRead";
import { Rejected } from "../registration/Rejected";
import { SureButton } from "../registration/SureButton";
import { useMadeBy } from "../registration/useMadeBy";
import { useSides } from "../registration/useSides";

/** Which channel is drilled; another one is chosen by two touches, with what that ends. */
export function ChannelSwitch(): ReactNode {
  const texts = useTexts().navigate;
  const sideName = useSides();
  const procedure = useProcedure();
  const madeBy = useMadeBy();
  const isPlanned = procedure.data?.steps.some((one) => one.step === "plan" && one.document_id !== null);
  const plan = useAsked(
    // Without a plan there is nothing to ask for, and nothing to switch to.
    async (signal) => (isPlanned === true ? answered(server.GET("/api/plan", { signal })) : null),
    { key: String(isPlanned) },
  );
  const [shown, setShown] = useState(false);
  const switching = useDo();
  if (isPlanned === false) return null;
  if (plan.data === null) return <Unanswered asked={plan} Note={Rejected} />;
  const active = plan.data.active_channel;
  const others = plannedVertebrae(plan.data.plan)
    .flatMap((one) => one.sides.map((side) => ({ vertebra: one.name, side })))
    .filter((one) => one.vertebra !== active?.vertebra || one.side !== active.side);
  return (
    <section className="card" data-testid="channel-switch">
      <p className="row">
        <strong data-testid="active-channel">
          {active === null ? texts.noChannel : `${active.vertebra} ${sideName(active.side)}`}
        </strong>
        {others.length > 0 && (
          <button
            type="button"
            className="big-link"
            aria-expanded={shown}
            data-testid="switch-channel"
            onClick={() => {
              setShown(!shown);
            }}
          >
            {texts.switchTo}
          </button>
        )}
      </p>
      {shown &&
        others.map((one) => {
          const stays = one.vertebra === active?.vertebra;
          const name = `${one.vertebra} ${sideName(one.side)}`;
          return (
            <div key={name}>
              <p className="quiet">
                {stays ? texts.sameVertebra : interpolate(texts.otherVertebra, { vertebra: one.vertebra })}
              </p>
              <SureButton
                ask
                variant="default"
                sure={interpolate(texts.switchSure, { channel: name })}
                busy={switching.busy}
                testId={`channel-${one.vertebra}-${one.side}`}
                onSure={() => {
                  void switching
                    .run(async () => {
                      await answered(
                        server.POST("/api/plan/active-channel", {
                          body: {
                            made_by: madeBy,
                            vertebra: one.vertebra,
                            side: one.side === "right" ? "right" : "left",
                          },
                        }),
                      );
                    })
                    .then(() => {
                      setShown(false);
                      plan.again();
                      procedure.again();
                    });
                }}
              >
                {name}
              </SureButton>
            </div>
          );
        })}
      <Rejected rejection={switching.rejection} />
    </section>
  );
}

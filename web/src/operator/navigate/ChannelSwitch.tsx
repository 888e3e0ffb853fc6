import { useState, type ReactNode } from "react";
import { getPlan, postPlanActiveChannel } from "../../api";
import { QueryStatus } from "../../rest/QueryStatus";
import { useLive } from "../../live/LiveContext";
import { proposedChannel } from "../../live/proposedChannel";
import { useQuery } from "../../rest/useQuery";
import { useAction } from "../../rest/useAction";
import { useTexts } from "../../texts/TextsContext";
import { useProcedure } from "../../app/procedure";
import { interpolate } from "../../texts/interpolate";
import { plannedVertebrae } from "../registration/planReader";
import { RegistrationRejection } from "../registration/RegistrationRejection";
import { ConfirmOrCancelButton } from "../registration/ConfirmOrCancelButton";
import { useMadeBy } from "../registration/useMadeBy";
import { useSides } from "../registration/useSides";

// It is also switched on other tablets.
const ASK_EVERY_MS = 1000;

/** The drilled channel; switching needs two touches and states what it ends. */
export function ChannelSwitch(): ReactNode {
  const texts = useTexts().navigate;
  const sideName = useSides();
  const procedure = useProcedure();
  const madeBy = useMadeBy();
  const isPlanned = procedure.data?.steps.some((one) => one.step === "plan" && one.document_id !== null);
  const plan = useQuery(
    // Without a plan there is nothing to switch to.
    async (signal) => (isPlanned === true ? getPlan({ signal }) : null),
    { key: String(isPlanned), everyMs: ASK_EVERY_MS },
  );
  const { view } = useLive();
  const proposed = proposedChannel(view);
  const [shown, setShown] = useState(false);
  const switching = useAction();
  if (isPlanned === false) return null;
  if (plan.data === null) return <QueryStatus query={plan} Note={RegistrationRejection} />;
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
          const isProposed = one.vertebra === proposed?.vertebra && one.side === proposed.side;
          return (
            <div key={name}>
              <p className="quiet">
                {stays ? texts.sameVertebra : interpolate(texts.otherVertebra, { vertebra: one.vertebra })}
              </p>
              <ConfirmOrCancelButton
                needsConfirmation
                variant="default"
                confirmLabel={interpolate(texts.switchSure, { channel: name })}
                busy={switching.busy}
                testId={`channel-${one.vertebra}-${one.side}`}
                onConfirm={() => {
                  void switching
                    .run(async () => {
                      await postPlanActiveChannel({
                        body: {
                          made_by: madeBy,
                          vertebra: one.vertebra,
                          side: one.side === "right" ? "right" : "left",
                        },
                      });
                    })
                    .then(() => {
                      setShown(false);
                      plan.refetch();
                      procedure.refetch();
                    });
                }}
              >
                {isProposed ? `${name} · ${texts.nearer}` : name}
              </ConfirmOrCancelButton>
            </div>
          );
        })}
      <RegistrationRejection rejection={switching.rejection} />
    </section>
  );
}

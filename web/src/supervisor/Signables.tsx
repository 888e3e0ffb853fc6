import type { ReactNode } from "react";
import { EmptyState } from "../panes/EmptyState";
import type { Signable } from "../room/messages";
import { useRoomSnapshot } from "../room/RoomContext";
import { useTexts } from "../texts/TextsContext";
import { Fold } from "./Fold";
import { PlanPanel } from "./PlanPanel";
import { RegistrationPanel } from "./RegistrationPanel";

/** Plan and registration. Their signature state comes from the room, so it is shown while they are closed. */
export function Signables(): ReactNode {
  const { supervisor: own, rest } = useTexts();
  const { isConnected, firstMessage, signable } = useRoomSnapshot();
  const unheard = firstMessage === "awaited" ? rest.loading : own.notKnown;
  const plan = signable?.find((one) => one.what === "plan") ?? null;
  const registration = signable?.find((one) => one.what === "registration") ?? null;
  return (
    <>
      <Fold id="plan" group="sign" title={own.plan.title} aside={<SignState signable={plan} />}>
        {plan === null ? (
          <EmptyState drawing="plan" sentence={isConnected ? own.plan.none : unheard} />
        ) : (
          <PlanPanel signable={plan} />
        )}
      </Fold>
      <Fold
        id="registration"
        group="sign"
        title={own.registration.title}
        aside={<SignState signable={registration} />}
      >
        {registration === null ? (
          <EmptyState drawing="registration" sentence={isConnected ? own.registration.none : unheard} />
        ) : (
          <RegistrationPanel signable={registration} />
        )}
      </Fold>
    </>
  );
}

function SignState({ signable }: { signable: Signable | null }): ReactNode {
  const texts = useTexts().supervisor.sign;
  if (signable?.document_id == null) return null;
  const waits = !signable.is_cosigned && signable.requirement === "required";
  return (
    <span className="sign-state" data-state={signable.is_cosigned ? "done" : waits ? "waits" : "open"}>
      <span aria-hidden="true">{signable.is_cosigned ? "✓" : waits ? "▲" : "○"}</span>{" "}
      {signable.is_cosigned ? texts.done : waits ? texts.due : texts.open}
    </span>
  );
}

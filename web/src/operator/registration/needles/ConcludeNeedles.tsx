import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { useLocation } from "wouter";
import { postRegistrationNeedlesConclusion } from "../../../api";
import { useAction } from "../../../rest/useAction";
import { useTexts } from "../../../texts/TextsContext";
import { useProcedure } from "../../../app/procedure";
import { StepActions } from "../../StepActions";
import { RegistrationRejection } from "../RegistrationRejection";
import { ConfirmOrCancelButton } from "../ConfirmOrCancelButton";
import { useMadeBy } from "../useMadeBy";
import type { Overlay } from "./overlay";
import { needleRequestBody, type NeedleRequest } from "./order";

interface ConcludeNeedlesProps {
  order: NeedleRequest;
  overlay?: Overlay | null;
  marked?: readonly {
    entry_px: [number, number];
    head_px: [number, number];
    entry_is_seen?: boolean;
    along_sd_px?: number;
  }[];
  picked?: boolean;
  isFrozen: boolean;
  disabled: boolean;
  onRelease?: (() => void) | undefined;
  children: ReactNode;
}

/** Registers from the overlay, proposal or marks, always with the newest live image, never a frozen one. */
export function ConcludeNeedles({
  order,
  overlay = null,
  marked = [],
  picked = false,
  isFrozen,
  disabled,
  onRelease,
  children,
}: ConcludeNeedlesProps): ReactNode {
  const texts = useTexts().registration;
  const procedure = useProcedure();
  const madeBy = useMadeBy();
  const [, navigate] = useLocation();
  const doing = useAction();
  const isThere =
    procedure.data?.steps.some((one) => one.step === "register" && one.state === "done") === true;
  return (
    <div className="conclude">
      <RegistrationRejection rejection={doing.rejection} />
      {isFrozen ? (
        <>
          <p className="warning">▲ {texts.needles.frozenNoFit}</p>
          {onRelease !== undefined && (
            <Button size="lg" color="yellow" onClick={onRelease}>
              {texts.frozen.release}
            </Button>
          )}
        </>
      ) : (
        <p className="quiet">{texts.needles.fitsLive}</p>
      )}
      <StepActions>
        <ConfirmOrCancelButton
          needsConfirmation={isThere}
          confirmLabel={texts.replaceSure}
          disabled={disabled || isFrozen}
          busy={doing.busy}
          testId="needles-conclude"
          onConfirm={() => {
            void doing
              .run(async () => {
                const needles = marked.map((one) => ({ entry_is_seen: true, along_sd_px: 1, ...one }));
                await postRegistrationNeedlesConclusion({
                  body: { ...needleRequestBody(order), overlay, marked: needles, picked, made_by: madeBy },
                });
              })
              .then((done) => {
                procedure.refetch();
                if (done) navigate("/operator/register");
              });
          }}
        >
          {children}
        </ConfirmOrCancelButton>
      </StepActions>
    </div>
  );
}

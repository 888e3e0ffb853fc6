import type { ReactNode } from "react";
import { postAlarmsHold, postAlarmsRelease } from "../api";
import { RejectionNote } from "../rest/RejectionNote";
import { useAction } from "../rest/useAction";
import { useRoomSnapshot } from "../room/RoomContext";
import { useTexts } from "../texts/TextsContext";
import { formatTime } from "../operator/parts/format";
import { TwoStepButton } from "./TwoStepButton";

/** Asks theatre to hold. Large, and in two steps, so that a slip has no effect. */
export function HoldPanel(): ReactNode {
  const all = useTexts();
  const texts = all.supervisor.hold;
  const { hold, you } = useRoomSnapshot();
  const { busy, rejection, run } = useAction();
  const query = hold?.requested_by ?? [];
  const mine = hold?.is_yours === true;
  const mayRelease = mine || you?.role === "operator";
  return (
    <section className="hold" aria-label={texts.title} data-testid="hold" data-requested={query.length > 0}>
      {query.length > 0 && (
        <p className="hold-requested" role="status">
          <span aria-hidden="true">▲▲</span> {texts.requestedBy} <strong>{query.join(", ")}</strong>
          {hold?.since != null && ` (${texts.since} ${formatTime(hold.since, all.language)})`}
        </p>
      )}
      {!mine && (
        <TwoStepButton
          className="hold-ask"
          testid="hold-ask"
          first={texts.ask}
          second={texts.sure}
          busy={busy}
          onDone={() =>
            void run(async () => {
              await postAlarmsHold({ body: {} });
            })
          }
        />
      )}
      {query.length > 0 &&
        (mayRelease ? (
          <button
            type="button"
            className="hold-release"
            data-testid="hold-release"
            disabled={busy}
            onClick={() =>
              void run(async () => {
                await postAlarmsRelease({ body: {} });
              })
            }
          >
            {you?.role === "operator" ? texts.releaseAll : texts.release}
          </button>
        ) : (
          <p className="soft">{texts.othersOnly}</p>
        ))}
      <p className="soft">{texts.hint}</p>
      <RejectionNote rejection={rejection} />
    </section>
  );
}

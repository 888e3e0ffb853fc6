import type { ReactNode } from "react";
import { answered, server } from "../rest/client";
import { RejectionNote } from "../rest/RejectionNote";
import { useDo } from "../rest/useDo";
import { useRoomWords } from "../room/RoomContext";
import { useWords } from "../words/WordsContext";
import { shownTime } from "../operator/parts/shown";
import { TwoSteps } from "./TwoSteps";

/** Asks those in theatre to hold: big, in two steps so that a slip does nothing. */
export function HoldPanel(): ReactNode {
  const all = useWords();
  const words = all.supervisor.hold;
  const { hold, you } = useRoomWords();
  const { busy, rejection, run } = useDo();
  const asked = hold?.requested_by ?? [];
  const mine = hold?.is_yours === true;
  const mayRelease = mine || you?.role === "operator";
  return (
    <section className="hold" aria-label={words.title} data-testid="hold" data-asked={asked.length > 0}>
      {asked.length > 0 && (
        <p className="hold-asked" role="status">
          <span aria-hidden="true">▲▲</span> {words.asked} <strong>{asked.join(", ")}</strong>
          {hold?.since != null && ` (${words.since} ${shownTime(hold.since, all.language)})`}
        </p>
      )}
      {!mine && (
        <TwoSteps
          className="hold-ask"
          testid="hold-ask"
          first={words.ask}
          second={words.sure}
          busy={busy}
          onDone={() =>
            void run(async () => {
              await answered(server.POST("/api/alarms/hold", { body: {} }));
            })
          }
        />
      )}
      {asked.length > 0 &&
        (mayRelease ? (
          <button
            type="button"
            className="hold-release"
            data-testid="hold-release"
            disabled={busy}
            onClick={() =>
              void run(async () => {
                await answered(server.POST("/api/alarms/release", { body: {} }));
              })
            }
          >
            {you?.role === "operator" ? words.releaseAll : words.release}
          </button>
        ) : (
          <p className="soft">{words.othersOnly}</p>
        ))}
      <p className="soft">{words.hint}</p>
      <RejectionNote rejection={rejection} />
    </section>
  );
}

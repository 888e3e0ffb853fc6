import { Button, Progress } from "@mantine/core";
import type { ReactNode } from "react";
import { RejectionNote } from "../../rest/RejectionNote";
import { useWords } from "../../words/WordsContext";
import { shownBytes } from "./shown";
import type { Transfer } from "./useTransfer";

/** How far a file is on its way, with a way to stop it; how it ended. */
export function TransferProgress({ transfer, name }: { transfer: Transfer; name: string }): ReactNode {
  const words = useWords();
  const { moved, rejection, stopped, stop } = transfer;
  if (rejection !== null) return <RejectionNote rejection={rejection} />;
  if (stopped) return <p role="status">{words.rest.cancelled}</p>;
  if (moved === null) return null;
  const { doneBytes, allBytes } = moved;
  const arrived = allBytes > 0 && doneBytes >= allBytes;
  const percent = allBytes > 0 ? Math.round((100 * doneBytes) / allBytes) : 0;
  return (
    <div className="job" role="status">
      <p>
        {name} ·{" "}
        {arrived
          ? words.case.serverWorks
          : `${shownBytes(doneBytes)}${allBytes > 0 ? ` / ${shownBytes(allBytes)}` : ""}`}
      </p>
      <Progress
        value={arrived || allBytes === 0 ? 100 : percent}
        striped={arrived}
        size="lg"
        aria-label={name}
      />
      <Button size="lg" variant="default" onClick={stop}>
        {words.rest.cancel}
      </Button>
    </div>
  );
}

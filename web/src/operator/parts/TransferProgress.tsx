import { Button, Progress } from "@mantine/core";
import type { ReactNode } from "react";
import { RejectionNote } from "../../rest/RejectionNote";
import { useTexts } from "../../texts/TextsContext";
import { formatBytes } from "./format";
import type { Transfer } from "./useTransfer";

/** Progress and result of a transfer, with a cancel button. */
export function TransferProgress({ transfer, name }: { transfer: Transfer; name: string }): ReactNode {
  const texts = useTexts();
  const { moved, rejection, stopped, stop } = transfer;
  if (rejection !== null) return <RejectionNote rejection={rejection} />;
  if (stopped) return <p role="status">{texts.rest.cancelled}</p>;
  if (moved === null) return null;
  const { doneBytes, allBytes } = moved;
  const arrived = allBytes > 0 && doneBytes >= allBytes;
  const percent = allBytes > 0 ? Math.round((100 * doneBytes) / allBytes) : 0;
  return (
    <div className="job" role="status">
      <p>
        {name} ·{" "}
        {arrived
          ? texts.case.serverWorks
          : `${formatBytes(doneBytes)}${allBytes > 0 ? ` / ${formatBytes(allBytes)}` : ""}`}
      </p>
      <Progress
        value={arrived || allBytes === 0 ? 100 : percent}
        striped={arrived}
        size="lg"
        aria-label={name}
      />
      <Button size="lg" variant="default" onClick={stop}>
        {texts.rest.cancel}
      </Button>
    </div>
  );
}

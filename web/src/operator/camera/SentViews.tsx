import { useState, type ReactNode } from "react";
import { RejectionNote } from "../../rest/RejectionNote";
import { Rejection } from "../../rest/client";
import { useTexts } from "../../texts/TextsContext";
import { FileButton } from "../parts/FileButton";
import { interpolate } from "../../texts/interpolate";
import { sent } from "../parts/transfer";
import { TransferProgress } from "../parts/TransferProgress";
import { useTransfer } from "../parts/useTransfer";

interface Rejected {
  file: string;
  rejection: Rejection;
}

/** Views from pictures that were taken before, one after the other; each that is refused says why. */
export function SentViews({ disabled, onAdded }: { disabled: boolean; onAdded: () => void }): ReactNode {
  const texts = useTexts().camera;
  const transfer = useTransfer();
  const [rejected, setRejected] = useState<readonly Rejected[]>([]);
  const [taken, setTaken] = useState<number | null>(null);
  const send = (files: readonly File[]): void => {
    setRejected([]);
    setTaken(null);
    void transfer.run(async (onMoved, signal) => {
      let kept = 0;
      for (const file of files) {
        try {
          await sent(
            `/api/camera/collection/images?name=${encodeURIComponent(file.name)}`,
            file,
            onMoved,
            signal,
          );
          kept += 1;
        } catch (error) {
          if (!(error instanceof Rejection)) throw error;
          setRejected((before) => [...before, { file: file.name, rejection: error }]);
        }
        onAdded();
      }
      setTaken(kept);
    });
  };
  return (
    <div className="stack">
      <div className="row">
        <FileButton
          accept="image/png,image/jpeg"
          multiple
          disabled={disabled || transfer.moved !== null}
          testId="view-files"
          onFiles={send}
        >
          {texts.sendViews}
        </FileButton>
        <p className="soft grow">{texts.sendViewsHint}</p>
      </div>
      <TransferProgress transfer={transfer} name={texts.sendViews} />
      {taken !== null && <p role="status">{interpolate(texts.viewsSent, { count: taken })}</p>}
      {rejected.map(({ file, rejection }) => (
        <RejectionNote key={file} rejection={rejection} />
      ))}
    </div>
  );
}

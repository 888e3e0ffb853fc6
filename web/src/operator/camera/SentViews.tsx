import { useState, type ReactNode } from "react";
import { RejectionNote } from "../../rest/RejectionNote";
import { Rejection } from "../../rest/client";
import { useTexts } from "../../texts/TextsContext";
import { FileButton } from "../parts/FileButton";
import { pluralize } from "../../texts/pluralize";
import { uploadFile } from "../parts/transfer";
import { TransferProgress } from "../parts/TransferProgress";
import { useTransfer } from "../parts/useTransfer";

interface Rejected {
  file: string;
  rejection: Rejection;
}

/** Adds views from image files, one after another, and shows the rejected ones. */
export function SentViews({ disabled, onAdded }: { disabled: boolean; onAdded: () => void }): ReactNode {
  const { camera: texts, language } = useTexts();
  const transfer = useTransfer();
  const [rejected, setRejected] = useState<readonly Rejected[]>([]);
  const [storedViews, setStoredViews] = useState<number | null>(null);
  const send = (files: readonly File[]): void => {
    setRejected([]);
    setStoredViews(null);
    void transfer.run(async (onMoved, signal) => {
      let stored = 0;
      for (const file of files) {
        try {
          await uploadFile(
            `/api/camera/collection/images?name=${encodeURIComponent(file.name)}`,
            file,
            onMoved,
            signal,
          );
          stored += 1;
        } catch (error) {
          if (!(error instanceof Rejection)) throw error;
          setRejected((before) => [...before, { file: file.name, rejection: error }]);
        }
        onAdded();
      }
      setStoredViews(stored);
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
      {storedViews !== null && <p role="status">{pluralize(texts.viewsSent, storedViews, language)}</p>}
      {rejected.map(({ file, rejection }) => (
        <RejectionNote key={file} rejection={rejection} />
      ))}
    </div>
  );
}

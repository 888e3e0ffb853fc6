import { useState, type ReactNode } from "react";
import type { Job } from "../../../rest/useJob";
import { useTexts } from "../../../texts/TextsContext";

const TRIES_EVERY_RATIO = 0.05;

/** First slice of the CT while it is being read, so that a wrong patient is noticed early. */
export function ReadingPreview({ uploadId, of }: { uploadId: string; of: Job }): ReactNode {
  const texts = useTexts().plan.ct;
  const [isThere, setThere] = useState(false);
  // Requested again during reading until it exists.
  const round = isThere ? "last" : String(Math.floor(of.progress_ratio / TRIES_EVERY_RATIO));
  const [stored, setStored] = useState("");
  const source = stored !== "" ? stored : `/api/ct/uploads/${uploadId}/preview.png?round=${round}`;
  // It does not exist before reading begins or after it ends.
  if (stored === "" && (of.progress_ratio === 0 || of.state !== "running")) return null;
  return (
    <img
      className="ct-preview"
      src={source}
      alt={texts.previewAlt}
      hidden={!isThere}
      onLoad={() => {
        setThere(true);
        setStored(source);
      }}
    />
  );
}

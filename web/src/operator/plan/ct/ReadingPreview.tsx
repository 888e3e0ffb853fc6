import { useState, type ReactNode } from "react";
import type { Job } from "../../../rest/useJob";
import { useTexts } from "../../../texts/TextsContext";

const TRIES_EVERY_RATIO = 0.05;

/** The first slice, as soon as it is read: whether this is the right patient's part is seen early. */
export function ReadingPreview({ uploadId, of }: { uploadId: string; of: Job }): ReactNode {
  const texts = useTexts().plan.ct;
  const [isThere, setThere] = useState(false);
  // Asked again as the reading goes on, until it is there.
  const round = isThere ? "last" : String(Math.floor(of.progress_ratio / TRIES_EVERY_RATIO));
  const [stored, setStored] = useState("");
  const source = stored !== "" ? stored : `/api/ct/uploads/${uploadId}/preview.png?round=${round}`;
  // Before anything is read there is surely none, and in the end it goes.
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

import { Alert, Button, Progress } from "@mantine/core";
import type { ReactNode } from "react";
import { RejectionNote } from "../../../rest/RejectionNote";
import { useTexts } from "../../../texts/TextsContext";
import type { Upload } from "./useUpload";

/** Progress of packing and sending with a cancel button, or the reason of the rejection. */
export function UploadProgress({ upload }: { upload: Upload }): ReactNode {
  const texts = useTexts();
  if (upload.rejection !== null) return <RejectionNote rejection={upload.rejection} />;
  if (upload.isTooMuch) return <Alert className="rejection" role="alert" title={texts.plan.ct.tooMuch} />;
  if (upload.wasStopped) return <p role="status">{texts.rest.cancelled}</p>;
  if (upload.phase === null) return null;
  const percent = Math.round(upload.ratio * 100);
  return (
    <div className="job" role="status">
      <p>
        {texts.plan.ct.phase[upload.phase]} · {percent} %
      </p>
      <Progress value={percent} size="lg" aria-label={texts.plan.ct.phase[upload.phase]} />
      <Button size="lg" variant="default" onClick={upload.stop}>
        {texts.rest.cancel}
      </Button>
    </div>
  );
}

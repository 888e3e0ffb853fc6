import { Alert, Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postCtUploadsByUploadIdSeriesBySeries } from "../../../api";
import { JobProgress } from "../../../rest/JobProgress";
import { useRehearsal } from "../../../rest/useRehearsal";
import { useAction } from "../../../rest/useAction";
import { RejectionNote } from "../../../rest/RejectionNote";
import { isOver, useJob } from "../../../rest/useJob";
import { useTexts } from "../../../texts/TextsContext";
import { useMadeBy } from "../state/madeBy";
import { FileButtons } from "./FileButtons";
import { ReadingPreview } from "./ReadingPreview";
import { ReceivedList } from "./ReceivedList";
import { seriesOf, SeriesChoice } from "./SeriesChoice";
import { UploadProgress } from "./UploadProgress";
import { useUpload } from "./useUpload";

interface CtIntakeProps {
  /** Whether the case already has a CT that other documents depend on. */
  isSecond: boolean;
  onTaken: () => void;
}

/** Receives a CT: upload, reading, and choice of the series if there are several. */
export function CtIntake({ isSecond, onTaken }: CtIntakeProps): ReactNode {
  const all = useTexts();
  const texts = all.plan.ct;
  const madeBy = useMadeBy();
  const [uploadId, setUploadId] = useState("");
  const [isAgreed, setAgreed] = useState(false);
  const rehearsal = useRehearsal();
  const choosing = useAction();
  const job = useJob((ended) => {
    if (ended.state === "done" && seriesOf(ended).length === 0) onTaken();
  });
  const upload = useUpload(
    () => `/api/ct?${new URLSearchParams({ made_by: madeBy }).toString()}`,
    (begun) => {
      setUploadId(begun.upload_id ?? "");
      job.follow(begun);
    },
  );
  const isBusy = upload.phase !== null || (job.job !== null && !isOver(job.job));
  const series = job.job?.state === "done" ? seriesOf(job.job) : [];
  // Its slices are on their way: nothing else is to be chosen.
  const isTaken = job.job?.state === "done" && series.length === 0;

  const choose = (one: string): void => {
    void choosing.run(async () => {
      const path = { upload_id: uploadId, series: one };
      job.follow(await postCtUploadsByUploadIdSeriesBySeries({ path }));
    });
  };

  if (isSecond && !isAgreed && !isBusy) {
    return (
      <Alert className="consequence" title={texts.second.title} data-testid="second-ct">
        <p>{texts.second.sentence}</p>
        <Button
          size="xl"
          mt="sm"
          onClick={() => {
            setAgreed(true);
          }}
        >
          {texts.second.agree}
        </Button>
      </Alert>
    );
  }
  return (
    <div className="ct-intake" data-testid="ct-intake">
      {!isBusy && !isTaken && series.length === 0 && (
        <>
          <p>{texts.hint}</p>
          <FileButtons
            texts={texts.buttons}
            disabled={isBusy}
            onFiles={(files) => {
              job.forget();
              upload.send(files);
            }}
          />
          <ReceivedList
            onBegun={(begun) => {
              setUploadId(begun.upload_id);
              job.follow(begun);
            }}
          />
          {rehearsal.data !== null && (
            <div className="rehearsal-offer">
              <p>{texts.rehearsal.hint}</p>
              <Button
                size="xl"
                variant="default"
                data-testid="rehearsal-ct"
                onClick={() => {
                  job.forget();
                  upload.sendFrom("/api/rehearsal/ct");
                }}
              >
                {texts.rehearsal.take}
              </Button>
            </div>
          )}
        </>
      )}
      <UploadProgress upload={upload} />
      <RejectionNote rejection={choosing.rejection} />
      <JobProgress followed={job} />
      {isTaken && <p role="status">{all.rest.loading}</p>}
      {job.job !== null && !isOver(job.job) && (
        <ReadingPreview key={uploadId} uploadId={uploadId} of={job.job} />
      )}
      <SeriesChoice series={series} busy={choosing.busy} onChoose={choose} />
    </div>
  );
}

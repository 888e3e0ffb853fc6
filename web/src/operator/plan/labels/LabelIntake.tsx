import { Switch } from "@mantine/core";
import { useRef, type ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { JobProgress } from "../../../rest/JobProgress";
import { isOver, useJob } from "../../../rest/useJob";
import { useTexts } from "../../../texts/TextsContext";
import { Remarks } from "../../parts/Remarks";
import { FileButtons } from "../ct/FileButtons";
import { UploadProgress } from "../ct/UploadProgress";
import { useUpload } from "../ct/useUpload";
import { useMadeBy } from "../state/madeBy";
import { useLabels } from "./LabelsContext";
import { namesOf } from "./maskNames";

/** The segmentation of the vertebrae: received, listed, and shown or hidden. */
export function LabelIntake(): ReactNode {
  const texts = useTexts().plan.labels;
  const madeBy = useMadeBy();
  const { labels, isShown, setShown, refetch } = useLabels();
  const names = useRef("");
  const job = useJob((ended) => {
    if (ended.state === "done") refetch();
  });
  const upload = useUpload(
    () => `/api/labels?${new URLSearchParams({ made_by: madeBy, names: names.current }).toString()}`,
    job.follow,
  );
  const isBusy = upload.phase !== null || (job.job !== null && !isOver(job.job));
  return (
    <section data-testid="label-intake">
      <h3>{texts.title}</h3>
      {labels === null ? (
        <p>{texts.hint}</p>
      ) : (
        <>
          <dl className="figures">
            {labels.vertebrae.map((one) => (
              <div key={one.level} data-testid={`label-${one.level}`}>
                <dt>{one.level}</dt>
                <dd>
                  {formatNumber(one.volume_ml, 0)} ml{one.is_cut ? `, ${texts.cut}` : ""}
                </dd>
              </div>
            ))}
          </dl>
          <Remarks remarks={labels.warnings} />
          <Switch
            size="lg"
            label={texts.show}
            checked={isShown}
            data-testid="show-labels"
            onChange={(event) => {
              setShown(event.currentTarget.checked);
            }}
          />
        </>
      )}
      <FileButtons
        texts={texts.buttons}
        disabled={isBusy}
        onFiles={(files) => {
          job.forget();
          names.current = namesOf(files);
          upload.send(files);
        }}
      />
      <UploadProgress upload={upload} />
      <JobProgress followed={job} />
    </section>
  );
}

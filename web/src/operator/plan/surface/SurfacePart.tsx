import { Alert, Button, NativeSelect } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { getSurface, postSurfaceFromCt } from "../../../api";
import { JobProgress } from "../../../rest/JobProgress";
import { RejectionNote } from "../../../rest/RejectionNote";
import { QueryStatus } from "../../../rest/QueryStatus";
import { useQuery } from "../../../rest/useQuery";
import { useAction } from "../../../rest/useAction";
import { isOver, useJob } from "../../../rest/useJob";
import { useTexts } from "../../../texts/TextsContext";
import { FileButtons } from "../ct/FileButtons";
import { UploadProgress } from "../ct/UploadProgress";
import { useUpload } from "../ct/useUpload";
import { hasDocument } from "../state/documents";
import { usePlanning } from "../state/PlanContext";
import { useMadeBy } from "../state/madeBy";
import { useWork } from "../state/WorkContext";
import { SurfaceNumbers } from "./SurfaceNumbers";

const UNITS = ["mm", "cm", "m", "inch", "um"] as const;

/** The bone surface, created from the CT or uploaded, and shown in the 3-D scene. */
export function SurfacePart(): ReactNode {
  const texts = useTexts().plan.surface;
  const madeBy = useMadeBy();
  const [unit, setUnit] = useState("");
  const { caseId } = usePlanning();
  const { refreshSurfaces } = useWork();
  const surface = useQuery(async (signal) => {
    const isThere = await hasDocument(caseId, "surface", signal);
    return isThere ? getSurface({ signal }) : "none";
  });
  const action = useAction();
  const job = useJob((ended) => {
    if (ended.state !== "done") return;
    surface.refetch();
    refreshSurfaces();
  });
  const upload = useUpload(() => {
    const query = new URLSearchParams({ made_by: madeBy, ...(unit === "" ? {} : { unit }) });
    return `/api/surface?${query.toString()}`;
  }, job.follow);
  const isBusy = action.busy || upload.phase !== null || (job.job !== null && !isOver(job.job));
  const make = (): void => {
    void action.run(async () => {
      job.follow(
        await postSurfaceFromCt({
          body: { made_by: madeBy, largest_part_only: true, smoothing_rounds: 10, max_faces: 60_000 },
        }),
      );
    });
  };
  const found = surface.data === "none" ? null : surface.data;
  const proposed = job.job?.problem?.context["proposed_unit"];
  return (
    <>
      <h3>{texts.title}</h3>
      <p>{texts.hint}</p>
      {surface.data === "none" && <p className="soft">{texts.none}</p>}
      {surface.data === null && <QueryStatus query={surface} />}
      {found !== null && <SurfaceNumbers surface={found} />}
      <Button size="xl" fullWidth disabled={isBusy} data-testid="make-surface" onClick={make}>
        {found === null ? texts.make : texts.makeAnew}
      </Button>
      <RejectionNote rejection={action.rejection} />
      <JobProgress followed={job} />
      {typeof proposed === "string" && (
        <Alert className="consequence" title={`${texts.proposedUnit} ${proposed}`}>
          {texts.sayUnit}
        </Alert>
      )}
      <UploadProgress upload={upload} />
      <NativeSelect
        size="lg"
        label={texts.unit}
        value={unit}
        data={[
          { value: "", label: texts.unitUnsaid },
          ...UNITS.map((one) => ({ value: one, label: texts.units[one] })),
        ]}
        onChange={(event) => {
          setUnit(event.currentTarget.value);
        }}
      />
      <FileButtons
        texts={{ file: texts.send }}
        accept=".stl,.obj,.ply"
        disabled={isBusy}
        onFiles={(files) => {
          job.forget();
          upload.send(files);
        }}
      />
      <p className="soft">
        {formatNumber(100, 0)} MB {texts.max}
      </p>
    </>
  );
}

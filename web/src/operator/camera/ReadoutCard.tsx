import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { formatNumber } from "../../live/rounding";
import {
  deleteCameraReadoutCollection,
  getCameraReadout,
  postCameraReadoutCollection,
  postCameraReadoutMeasurement,
} from "../../api";
import { Rejection } from "../../rest/client";
import { JobProgress } from "../../rest/JobProgress";
import { RejectionNote } from "../../rest/RejectionNote";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useAction } from "../../rest/useAction";
import { isOver, useJob } from "../../rest/useJob";
import { interpolate } from "../../texts/interpolate";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";
import { useMaker } from "../parts/useMaker";
import { isBoard, type Board } from "./board";
import { BurstProgress } from "./BurstProgress";
import { readoutText } from "./readoutText";
import { StatedReadout } from "./StatedReadout";

const ASK_EVERY_MS = 2000;

interface ReadoutCardProps {
  board: Board;
  onChange: () => void;
}

/** Readout time of a rolling shutter: from the data sheet, or measured with a moving board. */
export function ReadoutCard({ board, onChange }: ReadoutCardProps): ReactNode {
  const texts = useTexts().camera.readout;
  const madeBy = useMaker();
  const doing = useAction();
  const [rejected, setRejected] = useState<Rejection | null>(null);
  const query = useQuery((signal) => getCameraReadout({ signal }), {
    everyMs: ASK_EVERY_MS,
  });
  const { data, refetch } = query;
  const changed = (): void => {
    refetch();
    onChange();
  };
  const end = (): void => {
    void doing
      .run(async () => {
        await deleteCameraReadoutCollection();
      })
      .then(refetch);
  };
  const followed = useJob((job) => {
    // States what the motion did not determine, and captures another burst.
    if (job.state !== "done" && job.problem !== null) setRejected(new Rejection(job.problem));
    if (job.state !== "done") end();
    changed();
  });
  const begin = (): void => {
    setRejected(null);
    void doing
      .run(async () => {
        await postCameraReadoutCollection({ body: { board } });
      })
      .then(refetch);
  };
  const measure = (): void => {
    void doing.run(async () => {
      const body = { made_by: madeBy };
      followed.follow(await postCameraReadoutMeasurement({ body }));
    });
  };
  if (data === null) return <QueryStatus query={query} />;
  const working = followed.job !== null && !isOver(followed.job);
  return (
    <Card title={texts.title} testId="readout">
      <p>{texts.lead}</p>
      <p data-testid="readout-stored">
        {readoutText(data, texts)}
        {data.found_by === "measured" &&
          ` ${interpolate(texts.spread, { sd: formatNumber(data.sd_ms ?? NaN) })}`}
      </p>
      {data.collecting ? (
        <>
          <BurstProgress working={working} onReady={measure} onEnd={end} />
          <JobProgress followed={followed} />
        </>
      ) : (
        <>
          <StatedReadout readoutMs={data.readout_ms} onStored={changed} />
          <div>
            <Button
              size="lg"
              variant="default"
              disabled={!isBoard(board)}
              loading={doing.busy}
              data-testid="measure-readout"
              onClick={begin}
            >
              {texts.measure}
            </Button>
          </div>
          <p className="soft">{texts.versionHint}</p>
        </>
      )}
      <RejectionNote rejection={rejected ?? doing.rejection} />
    </Card>
  );
}

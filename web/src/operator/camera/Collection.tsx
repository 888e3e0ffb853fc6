import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { deleteCameraCollection, getCameraCollection, postCameraCalibration } from "../../api";
import { Rejection } from "../../rest/client";
import { JobProgress } from "../../rest/JobProgress";
import { RejectionNote } from "../../rest/RejectionNote";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useAction } from "../../rest/useAction";
import { isOver, useJob } from "../../rest/useJob";
import { useTexts } from "../../texts/TextsContext";
import { StepActions } from "../StepActions";
import { Card } from "../parts/Card";
import { Measure } from "../parts/Measure";
import { sentence } from "../parts/format";
import { ConfirmButton } from "../parts/ConfirmButton";
import type { Gates } from "../parts/useGates";
import { useMaker } from "../parts/useMaker";
import { Coverage } from "./Coverage";
import { SentViews } from "./SentViews";
import { TiltCross } from "./TiltCross";

const ASK_EVERY_MS = 350;

interface CollectionProps {
  gates: Gates;
  /** A calibration was started. */
  onCalibrating: () => void;
  onDiscarded: () => void;
  /** The calibration has ended; if it succeeded, so has the collection. */
  onOver: () => void;
}

/** Collected views: coverage, tilts, missing conditions; then the calibration. */
export function Collection({ gates, onCalibrating, onDiscarded, onOver }: CollectionProps): ReactNode {
  const texts = useTexts().camera;
  const madeBy = useMaker();
  const doing = useAction();
  const query = useQuery((signal) => getCameraCollection({ signal }), {
    everyMs: ASK_EVERY_MS,
  });
  const { data, refetch } = query;
  const discard = async (): Promise<void> => {
    await doing.run(async () => {
      await deleteCameraCollection();
    });
    onDiscarded();
  };
  const followed = useJob(onOver);
  const calibrate = (): void => {
    void doing.run(async () => {
      followed.follow(await postCameraCalibration({ body: { made_by: madeBy } }));
      onCalibrating();
    });
  };
  // The calibration was stored, here or elsewhere: the page around asks for it a moment later.
  if (query.rejection?.problem.code === "COLLECTION_MISSING") return null;
  if (data === null) return <QueryStatus query={query} />;
  const working = followed.job !== null && !isOver(followed.job);
  const enough = data.missing.length === 0;
  const { collecting } = gates;
  return (
    <Card title={texts.collecting} testId="collection">
      <p className="newest" data-taking={data.is_taken ? "taken" : ""} role="status">
        {data.running ? sentence(data.message) : texts.ended}
      </p>
      <RejectionNote rejection={data.problem === null ? null : new Rejection(data.problem)} />
      <div className="coverage-row">
        <Coverage collected={data} />
        <TiltCross tiltDeg={data.tilt_deg} wantedDeg={collecting.min_tilt_deg} />
      </div>
      <dl className="measures">
        <Measure
          name={texts.views}
          value={data.views.length}
          unit=""
          decimals={0}
          limit={{ kind: "min", value: collecting.min_views }}
          bar
          testId="views"
        />
        <Measure
          name={texts.coverage}
          value={100 * data.coverage_ratio}
          unit="%"
          decimals={0}
          limit={{ kind: "min", value: 100 * collecting.min_coverage_ratio }}
          bar
        />
      </dl>
      <ul className="missing" aria-label={texts.missing} data-testid="missing" data-enough={enough}>
        {data.missing.map((one) => (
          <li key={one}>{one}</li>
        ))}
        {enough && <li className="good">✓ {texts.enough}</li>}
      </ul>
      <JobProgress followed={followed} />
      <StepActions>
        <ConfirmButton
          confirmLabel={texts.throwAwaySure}
          onConfirm={() => void discard()}
          testId="throw-away"
        >
          {texts.throwAway}
        </ConfirmButton>
        <Button
          size="xl"
          variant={enough ? "filled" : "default"}
          disabled={data.views.length === 0 || working}
          loading={doing.busy}
          data-testid="calibrate"
          onClick={calibrate}
        >
          {enough ? texts.calibrate : texts.calibrateAlready}
        </Button>
      </StepActions>
      <RejectionNote rejection={doing.rejection} />
      <SentViews disabled={working} onAdded={refetch} />
    </Card>
  );
}

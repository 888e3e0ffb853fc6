import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { useLocation } from "wouter";
import { QueryStatus } from "../../../rest/QueryStatus";
import { useQuery } from "../../../rest/useQuery";
import { useAction } from "../../../rest/useAction";
import {
  deleteRegistrationPoints,
  deleteRegistrationPointsCaptures,
  getRegistrationPoints,
  type PointsMessage,
  postRegistrationPointsCaptures,
  postRegistrationPointsConclusion,
  putRegistrationPointsUse,
} from "../../../api";
import { useTexts } from "../../../texts/TextsContext";
import { useProcedure } from "../../../app/procedure";
import { Icon } from "../../../panes/Icon";
import { StepActions } from "../../StepActions";
import { WorkPicture } from "../WorkPicture";
import { RegistrationRejection } from "../RegistrationRejection";
import { ConfirmOrCancelButton } from "../ConfirmOrCancelButton";
import { useMadeBy } from "../useMadeBy";
import { CapturePanel } from "./CapturePanel";
import { FitPanel } from "./FitPanel";
import { LandmarkList } from "./LandmarkList";
import { nextLandmark } from "./nextLandmark";
import { WhereToTouch } from "./WhereToTouch";

export type Points = PointsMessage;
const ASK_EVERY_MS = 250;

/** Captures the landmarks, shows their fit, excludes or repeats some, and registers. */
export function PointsWork({ onOver }: { onOver: () => void }): ReactNode {
  const texts = useTexts().registration;
  const procedure = useProcedure();
  const madeBy = useMadeBy();
  const [, navigate] = useLocation();
  const query = useQuery((signal) => getRegistrationPoints({ signal }), {
    everyMs: ASK_EVERY_MS,
  });
  const [picked, setPicked] = useState<string | null>(null);
  const [order, setOrder] = useState<string[]>([]);
  const doing = useAction();
  const { data } = query;
  if (data === null) return <QueryStatus query={query} Note={RegistrationRejection} />;
  const wanted = nextLandmark(data, picked);
  const landmark = data.landmarks.find((one) => one.name === wanted) ?? null;

  const run = (action: () => Promise<unknown>): void => {
    void doing
      .run(async () => {
        await action();
      })
      .then(query.refetch);
  };
  const forget = (name: string): void => {
    setPicked(name);
    setOrder((before) => before.filter((one) => one !== name));
    run(() => deleteRegistrationPointsCaptures({ query: { landmark: name } }));
  };
  const capture = (name: string): void => {
    setPicked(null);
    setOrder((before) => [...before.filter((one) => one !== name), name]);
    run(() => postRegistrationPointsCaptures({ body: { landmark: name } }));
  };
  const looking = data.capture?.state === "looking";
  const touched = data.landmarks.filter((one) => one.touched).map((one) => one.name);
  const last = order.findLast((name) => touched.includes(name)) ?? touched.at(-1) ?? null;
  return (
    <div className="work">
      <WorkPicture scene="landmarks" />
      <div className="work-side">
        <CapturePanel points={data} wanted={wanted} />
        {landmark !== null && <WhereToTouch name={landmark.name} pointMm={landmark.point_lps_mm} />}
        <RegistrationRejection rejection={doing.rejection ?? query.rejection} />
        <FitPanel points={data} />
        <LandmarkList
          points={data}
          wanted={wanted}
          onPick={setPicked}
          onForget={forget}
          onUse={(name, used) => {
            run(() => putRegistrationPointsUse({ body: { landmark: name, used } }));
          }}
        />
      </div>
      <StepActions>
        <ConfirmOrCancelButton
          needsConfirmation
          variant="default"
          confirmLabel={texts.throwAwaySure}
          testId="points-end"
          onConfirm={() => {
            void doing
              .run(async () => {
                await deleteRegistrationPoints();
              })
              .then(onOver);
          }}
        >
          {texts.throwAway}
        </ConfirmOrCancelButton>
        <Button
          size="lg"
          variant="default"
          disabled={last === null || looking || doing.busy}
          data-testid="undo-last"
          onClick={() => {
            if (last !== null) forget(last);
          }}
        >
          <Icon name="undo" /> {texts.points.undo}
        </Button>
        <ConfirmOrCancelButton
          needsConfirmation={
            procedure.data?.steps.some((one) => one.step === "register" && one.state === "done") === true
          }
          confirmLabel={texts.replaceSure}
          disabled={data.missing.length > 0}
          busy={doing.busy}
          testId="points-conclude"
          onConfirm={() => {
            void doing
              .run(async () => {
                await postRegistrationPointsConclusion({ body: { made_by: madeBy } });
              })
              .then((done) => {
                procedure.refetch();
                if (done) navigate("/operator/register");
              });
          }}
        >
          {texts.points.conclude}
        </ConfirmOrCancelButton>
        <Button
          size="xl"
          disabled={wanted === null || looking}
          variant={data.missing.length > 0 ? "filled" : "default"}
          loading={doing.busy}
          data-testid="capture"
          onClick={() => {
            if (wanted !== null) capture(wanted);
          }}
        >
          {landmark?.touched === true ? texts.points.captureAgain : texts.points.capture}
        </Button>
      </StepActions>
    </div>
  );
}

import { Button } from "@mantine/core";
import { useRef, useState, type ReactNode } from "react";
import { postPlanVertebraeByNamePediclesBySide, putPlanVertebraeByNameChannelsBySide } from "../../../api";
import { JobProgress } from "../../../rest/JobProgress";
import { RejectionNote } from "../../../rest/RejectionNote";
import { useAction } from "../../../rest/useAction";
import { isOver, useJob } from "../../../rest/useJob";
import { useTexts } from "../../../texts/TextsContext";
import { useIntoView } from "../../parts/useIntoView";
import { StepActions } from "../../StepActions";
import { MeasureBoth } from "../labels/MeasureBoth";
import { CursorPad } from "../slices/CursorPad";
import { useSlices } from "../slices/SlicesContext";
import { vec3 } from "../slices/vectors";
import { usePlanning } from "../state/PlanContext";
import { recordOf } from "../state/shape";
import { useWork } from "../state/WorkContext";
import { PedicleNumbers } from "./PedicleNumbers";
import { SideChooser } from "./SideChooser";
import { VertebraChooser } from "./VertebraChooser";

/** Names a level, and measures a pedicle at the cross. */
export function PediclePart(): ReactNode {
  const texts = useTexts().plan.pedicle;
  const { plan, vertebra, side, by, change, changedTo, busy } = usePlanning();
  const { look, goTo } = useSlices();
  const { setPart } = useWork();
  const action = useAction();
  const [measuredHere, setMeasuredHere] = useState<string | null>(null);
  const now = `${vertebra?.name ?? ""} ${side} ${String(plan?.heading.version ?? 0)}`;
  const numbers = useIntoView<HTMLDivElement>(measuredHere === now ? now : null);
  const documentBefore = useRef<string | null>(null);
  const job = useJob((ended) => {
    const made = (ended.result as { version?: number } | null)?.version;
    if (ended.state !== "done" || made === undefined) return;
    setMeasuredHere(`${vertebra?.name ?? ""} ${side} ${String(made)}`);
    changedTo(made, documentBefore.current);
  });
  if (vertebra === null) {
    return (
      <>
        <h3>{texts.title}</h3>
        <p>{texts.noVertebra}</p>
        <VertebraChooser />
      </>
    );
  }
  const { name } = vertebra;
  const record = recordOf(vertebra, side);
  const isMeasuring = action.busy || (job.job !== null && !isOver(job.job));
  const measure = (): void => {
    documentBefore.current = plan?.heading.id ?? null;
    void action.run(async () => {
      job.follow(
        await postPlanVertebraeByNamePediclesBySide({
          path: { name, side },
          body: { ...by, seed_lps_mm: [...look.cursor] },
        }),
      );
    });
  };
  const layChannel = (): void => {
    const path = { name, side };
    void change((on) => putPlanVertebraeByNameChannelsBySide({ path, body: on })).then((made) => {
      if (made) setPart("channel");
    });
  };
  const doubtfulAt = vec3(job.job?.problem?.context["isthmus_lps_mm"]);
  return (
    <>
      <VertebraChooser />
      <MeasureBoth key={name} vertebra={name} />
      <SideChooser />
      <p>{texts.tap[side]}</p>
      <CursorPad />
      <RejectionNote rejection={action.rejection} />
      <JobProgress followed={job} />
      {doubtfulAt !== null && (
        <Button
          size="lg"
          variant="default"
          onClick={() => {
            goTo(doubtfulAt);
          }}
        >
          {texts.showDoubtful}
        </Button>
      )}
      {record !== null && (
        <div className="measured" ref={numbers}>
          <PedicleNumbers key={now} record={record} vertebra={name} />
        </div>
      )}
      <StepActions>
        <Button
          size="xl"
          variant={record === null ? "filled" : "default"}
          disabled={isMeasuring || busy}
          data-testid="measure"
          onClick={measure}
        >
          {record === null ? texts.measure[side] : texts.again[side]}
        </Button>
        {record !== null && !vertebra.channels.some((one) => one.side === side) && (
          <Button size="xl" disabled={busy} data-testid="lay-channel" onClick={layChannel}>
            {texts.layChannel}
          </Button>
        )}
      </StepActions>
    </>
  );
}

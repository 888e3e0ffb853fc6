import { Button } from "@mantine/core";
import { useRef, type ReactNode } from "react";
import { getLabelsStartsByLevel, postPlanVertebraeByNamePediclesBySide } from "../../../api";
import { JobProgress } from "../../../rest/JobProgress";
import { RejectionNote } from "../../../rest/RejectionNote";
import { useAction } from "../../../rest/useAction";
import { useJob, type Job } from "../../../rest/useJob";
import { useTexts } from "../../../texts/TextsContext";
import { usePlanning } from "../state/PlanContext";
import { vec3 } from "../slices/vectors";
import { useLabels } from "./LabelsContext";

/** Measures both pedicles of a level without a click, from the start points of its label. */
export function MeasureBoth({ vertebra }: { vertebra: string }): ReactNode {
  const texts = useTexts().plan.labels;
  const { labels } = useLabels();
  const { plan, by, changedTo, busy } = usePlanning();
  const action = useAction();
  const onOver = useRef<(ended: Job) => void>(() => undefined);
  const job = useJob((ended) => {
    onOver.current(ended);
  });
  const measure = (): void => {
    const documentBefore = plan?.heading.id ?? null;
    void action.run(async () => {
      const { starts } = await getLabelsStartsByLevel({ path: { level: vertebra } });
      let version = by.expected_version;
      for (const { side, point_lps_mm } of starts) {
        const seed = vec3(point_lps_mm);
        if (seed === null) return;
        const begun = await postPlanVertebraeByNamePediclesBySide({
          path: { name: vertebra, side },
          body: { ...by, expected_version: version, seed_lps_mm: [...seed] },
        });
        const ended = await new Promise<Job>((resolve) => {
          onOver.current = resolve;
          job.follow(begun);
        });
        const made = (ended.result as { version?: number } | null)?.version;
        // A doubtful pedicle is reported by its job; the other one is not measured then.
        if (ended.state !== "done" || made === undefined) return;
        version = made;
        changedTo(made, documentBefore);
      }
    });
  };
  if (labels?.vertebrae.every((one) => one.level !== vertebra) !== false) return null;
  return (
    <>
      <Button
        size="xl"
        fullWidth
        variant="default"
        disabled={action.busy || busy}
        data-testid="measure-both"
        onClick={measure}
      >
        {texts.measureBoth}
      </Button>
      <RejectionNote rejection={action.rejection} />
      <JobProgress followed={job} />
    </>
  );
}

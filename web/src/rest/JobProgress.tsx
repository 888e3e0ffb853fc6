import { Button, Progress } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import { Rejection } from "./client";
import { RejectionNote } from "./RejectionNote";
import { isOver, type JobFollowed } from "./useJob";

/** Progress of a job with a cancel button, or the reason of its failure. */
export function JobProgress({ followed }: { followed: JobFollowed }): ReactNode {
  const texts = useTexts().rest;
  const { job, cancel } = followed;
  if (job === null) return null;
  if (job.problem !== null) return <RejectionNote rejection={new Rejection(job.problem)} />;
  if (isOver(job)) return job.state === "cancelled" ? <p role="status">{texts.cancelled}</p> : null;
  const percent = Math.round(job.progress_ratio * 100);
  return (
    <div className="job" role="status">
      <p>
        {job.title} · {job.doing || texts.waiting} · {percent} %
      </p>
      <Progress value={percent} size="lg" aria-label={job.title} />
      <Button size="lg" variant="default" disabled={job.state === "concluding"} onClick={cancel}>
        {texts.cancel}
      </Button>
    </div>
  );
}

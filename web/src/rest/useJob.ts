// Polls a job until it ends, also across lost connections.
import { useCallback, useEffect, useEffectEvent, useState } from "react";
import { deleteJobsByJobId, getJobsByJobId, type JobMessage } from "../api";
import { Rejection } from "./client";

export type Job = JobMessage;

const ASK_EVERY_MS = 300;
const OVER: ReadonlySet<Job["state"]> = new Set<Job["state"]>(["done", "failed", "cancelled"]);

export const isOver = (job: Job): boolean => OVER.has(job.state);

export interface JobFollowed {
  job: Job | null;
  /** Follow this job from now on. */
  follow: (job: Job) => void;
  cancel: () => void;
  forget: () => void;
}

/** `onOver` is called once, with the ended job. */
export function useJob(onOver: (job: Job) => void): JobFollowed {
  const [job, setJob] = useState<Job | null>(null);
  const onEnd = useEffectEvent(onOver);
  const id = job !== null && !isOver(job) ? job.id : null;

  useEffect(() => {
    if (id === null) return;
    let stopped = false;
    const timer = setInterval(() => {
      getJobsByJobId({ path: { job_id: id } })
        .then((now) => {
          if (stopped) return;
          setJob(now);
          if (!isOver(now)) return;
          stopped = true;
          onEnd(now);
        })
        .catch((error: unknown) => {
          // A restarted server does not know the job any more; a server that does not answer may return.
          if (error instanceof Rejection && error.problem.code !== "NO_ANSWER" && !stopped) setJob(null);
        });
    }, ASK_EVERY_MS);
    return () => {
      stopped = true;
      clearInterval(timer);
    };
  }, [id]);

  const cancel = useCallback(() => {
    if (id === null) return;
    // Its end is seen by the next question, which also calls `onOver`.
    deleteJobsByJobId({ path: { job_id: id } }).catch(() => undefined);
  }, [id]);
  const forget = useCallback(() => {
    setJob(null);
  }, []);
  const follow = (begun: Job): void => {
    setJob(begun);
    if (isOver(begun)) onOver(begun);
  };
  return { job, follow, cancel, forget };
}

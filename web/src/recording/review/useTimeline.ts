// The timeline of a recording, which is indexed on first use.
import { useEffect, useEffectEvent, useState } from "react";
import { getRecordingsByNameTimeline } from "../../api";
import { useJob, type JobFollowed } from "../../rest/useJob";
import { useQuery, type QueryState } from "../../rest/useQuery";
import type { Span } from "./span";
import { MAX_SAMPLES, type Curves, type Timeline } from "./timeline";

export interface LoadedTimeline {
  timeline: Timeline;
  /** Curves of the whole recording; the timeline has those of its visible part. */
  whole: Curves;
}

export interface TimelineState {
  loaded: LoadedTimeline | null;
  query: QueryState<unknown>;
  followed: JobFollowed;
  /** Whether the recording is being indexed. */
  isIndexing: boolean;
  span: Span | null;
  setSpan: (span: Span) => void;
}

export function useTimeline(name: string): TimelineState {
  const [span, setSpan] = useState<Span | null>(null);
  const query = useQuery(
    (signal) =>
      getRecordingsByNameTimeline({
        path: { name },
        query: { samples: MAX_SAMPLES, ...(span === null ? {} : { from_s: span.fromS, to_s: span.toS }) },
        signal,
      }),
    { key: `${name} ${span?.fromS ?? ""} ${span?.toS ?? ""}` },
  );
  const { data, refetch } = query;
  const followed = useJob((job) => {
    if (job.state === "done") refetch();
  });
  const [job, setJob] = useState(data?.job ?? null);
  if (data?.job != null && data.job.id !== job?.id) setJob(data.job);
  const onJob = useEffectEvent(followed.follow);
  useEffect(() => {
    if (job !== null) onJob(job);
  }, [job]);
  // While another part is being fetched, the previous curves are shown shifted.
  const [timeline, setTimeline] = useState<Timeline | null>(null);
  if (data?.timeline != null && data.timeline !== timeline) setTimeline(data.timeline);
  const [whole, setWhole] = useState<Curves | null>(null);
  if (whole === null && timeline !== null) setWhole(timeline.curves);
  const loaded = timeline === null || whole === null ? null : { timeline, whole };
  return { loaded, query, followed, isIndexing: data?.job != null, span, setSpan };
}

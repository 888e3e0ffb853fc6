import { Button } from "@mantine/core";
import { useEffect, useRef, type ReactNode } from "react";
import { getCameraReadoutCollection } from "../../api";
import { Rejection } from "../../rest/client";
import { RejectionNote } from "../../rest/RejectionNote";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { interpolate } from "../../texts/interpolate";
import { useTexts } from "../../texts/TextsContext";

const ASK_EVERY_MS = 350;

interface BurstProgressProps {
  working: boolean;
  onReady: () => void;
  onEnd: () => void;
}

/** Instructions for the board, and progress of capture and detection. */
export function BurstProgress({ working, onReady, onEnd }: BurstProgressProps): ReactNode {
  const texts = useTexts().camera.readout;
  const query = useQuery((signal) => getCameraReadoutCollection({ signal }), {
    everyMs: ASK_EVERY_MS,
  });
  const { data } = query;
  const ready = useRef(false);
  useEffect(() => {
    // Fit each burst once: a rejected burst is captured again instead.
    if (data?.stage === "ready" && !ready.current) {
      ready.current = true;
      onReady();
    }
  }, [data?.stage, onReady]);
  if (data === null) return <QueryStatus query={query} />;
  const done = data.stage === "taking" ? data.taken_images : data.read_images;
  return (
    <>
      <p className="newest" role="status" data-testid="burst-stage">
        {texts.stages[data.stage]}
      </p>
      {(data.stage === "taking" || data.stage === "reading") && (
        <>
          <progress max={data.images} value={done} aria-label={texts.stages[data.stage]} />
          <p className="soft">
            {interpolate(texts.progress, { done, all: data.images, found: data.found_images })}
          </p>
        </>
      )}
      <RejectionNote rejection={data.problem === null ? null : new Rejection(data.problem)} />
      <div>
        <Button size="lg" variant="default" disabled={working} onClick={onEnd}>
          {texts.end}
        </Button>
      </div>
    </>
  );
}

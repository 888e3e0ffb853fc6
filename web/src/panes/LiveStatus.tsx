import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { useWords } from "../words/WordsContext";
import { Fact } from "./Fact";
import { heardOf } from "./heard";

/** Whether there are numbers, a camera and a server: in words, on every view. */
export function LiveStatus({ withTracking = false }: { withTracking?: boolean }): ReactNode {
  const words = useWords();
  const { view } = useLive();
  const { linkState, source, isOfNow } = heardOf(view);
  const cameraState = source?.state ?? "unknown";
  const isLoading = view.firstMessage === "awaited";
  const well = isOfNow ? "good" : "waiting";
  return (
    <dl className="facts facts-status" aria-label={words.shell.status}>
      {withTracking && (
        <Fact
          name={words.shell.tracking}
          value={isLoading ? words.rest.loading : view.numbers.live ? words.shell.live : words.shell.none}
          mood={isLoading ? "waiting" : view.numbers.live ? "good" : "bad"}
          testid="tracking-state"
        />
      )}
      <Fact
        name={words.header.camera}
        value={isLoading ? words.rest.loading : words.cameraState[cameraState]}
        mood={isLoading || cameraState === "opening" ? "waiting" : cameraState === "running" ? well : "bad"}
        testid="camera-state"
      />
      <Fact
        name={words.header.server}
        value={words.linkState[linkState]}
        mood={linkState === "open" ? "good" : linkState === "connecting" ? "waiting" : "bad"}
        testid="link-state"
      />
    </dl>
  );
}

import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { formatDuration } from "../live/rounding";
import { interpolate } from "../texts/interpolate";
import { useTexts } from "../texts/TextsContext";
import { Fact } from "./Fact";
import { serverStateOf } from "./serverState";

/** State of numbers, camera and server in words, on every view. */
export function LiveStatus({ withTracking = false }: { withTracking?: boolean }): ReactNode {
  const texts = useTexts();
  const { view } = useLive();
  const { linkState, source, isOfNow } = serverStateOf(view);
  const cameraState = source?.state ?? "unknown";
  const isLoading = view.firstMessage === "awaited";
  const well = isOfNow ? "good" : "waiting";
  return (
    <dl className="facts facts-status" aria-label={texts.shell.status}>
      {withTracking && (
        <Fact
          name={texts.shell.tracking}
          value={isLoading ? texts.rest.loading : view.numbers.live ? texts.shell.live : texts.shell.none}
          mood={isLoading ? "waiting" : view.numbers.live ? "good" : "bad"}
          testid="tracking-state"
        />
      )}
      <Fact
        name={texts.header.camera}
        value={isLoading ? texts.rest.loading : texts.cameraState[cameraState]}
        mood={isLoading || cameraState === "opening" ? "waiting" : cameraState === "running" ? well : "bad"}
        testid="camera-state"
      />
      <Fact
        name={texts.header.server}
        value={interpolate(texts.linkState[linkState], { age: formatDuration(view.silentMs) })}
        mood={linkState === "open" ? "good" : linkState === "connecting" ? "waiting" : "bad"}
        testid="link-state"
      />
    </dl>
  );
}

import type { ReactNode } from "react";
import { formatNumber } from "../live/rounding";
import { formatBytes } from "../operator/parts/format";
import { interpolate } from "../texts/interpolate";
import { useTexts } from "../texts/TextsContext";
import type { CameraStream } from "./useCameraStream";

/** What is sent and what the server reports; unknown values are omitted. */
export function StreamFacts({ sending }: { sending: CameraStream }): ReactNode {
  const all = useTexts();
  const texts = all.phone;
  const { welcome, facts, last, note } = sending;
  const isSent = last !== null && sending.state === "sending";
  return (
    <dl className="phone-facts">
      {facts !== null && welcome !== null && isSent && (
        <Fact name={texts.image}>
          {interpolate(texts.imageValue, {
            width: facts.width_px,
            height: facts.height_px,
            size: formatBytes(last.bytes),
            quality: Math.round(welcome.quality_ratio * 100),
          })}
        </Fact>
      )}
      {isSent && (
        <Fact name={texts.rate} id="sent">
          {interpolate(texts.perSecond, { rate: formatNumber(last.rateHz, 1) })}
        </Fact>
      )}
      {facts !== null && (
        <Fact name={texts.focus} id="focus" bad={facts.focus !== "locked"}>
          {texts.focusState[facts.focus]}
          {facts.focus_mm !== null &&
            ` ${interpolate(texts.focusAt, { distance: formatNumber(facts.focus_mm / 1000, 2) })}`}
        </Fact>
      )}
      {isSent && (
        <Fact name={texts.times} bad={last.clock !== "capture"}>
          {texts.clock[last.clock]}
        </Fact>
      )}
      {note !== null && (
        <Fact name={texts.server} id="server">
          {interpolate(texts.serverValue, {
            state: all.cameraState[note.source_state ?? "unknown"],
            rate: formatNumber(note.rate_hz, 1),
          })}
        </Fact>
      )}
      {note?.delay_ms != null && note.clock_error_ms !== null && (
        <Fact name={texts.delay}>
          {interpolate(texts.delayValue, {
            min: Math.max(0, Math.floor(note.delay_ms - note.clock_error_ms)),
            max: Math.ceil(note.delay_ms),
          })}
        </Fact>
      )}
    </dl>
  );
}

function Fact(props: { name: string; id?: string; bad?: boolean; children: ReactNode }): ReactNode {
  return (
    <div className="fact" data-mood={props.bad === true ? "bad" : undefined}>
      <dt>{props.name}</dt>
      <dd data-testid={props.id === undefined ? undefined : `phone-${props.id}`}>{props.children}</dd>
    </div>
  );
}

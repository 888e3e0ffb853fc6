import type { ReactNode } from "react";
import { useProcedure } from "../app/procedure";
import { useTexts } from "../texts/TextsContext";
import { detailsLine, recordingText, type RecordingText } from "./recordingText";

const SYMBOL: Record<RecordingText["state"], string> = { on: "●", off: "○", stopped: "▲" };

/** Whether images and figures are being recorded; nothing if the server does not record. */
export function RecordingState({ testId = "recording-state" }: { testId?: string }): ReactNode {
  const { recording: texts, language } = useTexts();
  const { data, rejection } = useProcedure();
  if (data === null) {
    return rejection === null ? null : (
      <p className="recording" data-state="unknown" data-testid={testId}>
        <span className="recording-title">? {texts.unknown}</span>
      </p>
    );
  }
  if (data.recording === null) return null;
  const text = recordingText(data.recording, texts, language);
  const { state, title, warnings, serverReason } = text;
  const all = detailsLine(text);
  return (
    <p className="recording" data-state={state} data-testid={testId}>
      <span className="recording-title">
        <span aria-hidden="true">{SYMBOL[state]}</span> {title}
      </span>
      <span className="recording-details" data-warns={warnings.length > 0} title={all || serverReason}>
        {all}
        {serverReason !== "" && <span lang={data.recording.problem?.language}>{serverReason}</span>}
      </span>
    </p>
  );
}

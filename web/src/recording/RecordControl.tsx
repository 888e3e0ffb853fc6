import { Button, Modal } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { useProcedure } from "../app/procedure";
import { postRecordingsStart, postRecordingsStop } from "../api";
import { RejectionNote } from "../rest/RejectionNote";
import { useAction } from "../rest/useAction";
import { useTexts } from "../texts/TextsContext";
import { isConsented } from "./consent";
import { ConsentAnswers } from "./ConsentQuestion";
import { RecordingState } from "./RecordingState";

/** State of the recording and its start/stop button; asks for consent first if needed. */
export function RecordControl(): ReactNode {
  const texts = useTexts().recording;
  const { data, refetch } = useProcedure();
  const doing = useAction();
  const [isAsking, setIsAsking] = useState(false);
  const recording = data?.recording ?? null;
  const isOn = recording?.is_recording === true;
  const start = async (): Promise<void> => {
    await doing.run(async () => {
      await postRecordingsStart();
    });
    refetch();
  };
  const startOrAsk = async (): Promise<void> => {
    if (recording !== null && isConsented(recording.consent)) await start();
    else setIsAsking(true);
  };
  const stop = async (): Promise<void> => {
    await doing.run(async () => {
      await postRecordingsStop();
    });
    refetch();
  };
  return (
    <>
      <div className="record-control">
        <RecordingState />
        {recording !== null && data?.case_id != null && (isOn || recording.when !== "never") && (
          <Button
            size="lg"
            variant="default"
            loading={doing.busy}
            data-testid="record"
            onClick={() => void (isOn ? stop() : startOrAsk())}
          >
            <span aria-hidden="true" className="record-sign" data-state={isOn ? "on" : "off"}>
              {isOn ? "■" : "●"}
            </span>{" "}
            {isOn ? texts.stop : texts.start}
          </Button>
        )}
      </div>
      {data?.case_id != null && (
        <Modal
          opened={isAsking}
          onClose={() => {
            setIsAsking(false);
          }}
          title={<strong className="consent-title">{texts.consent.title}</strong>}
          size="lg"
          withCloseButton={false}
          // At the lower edge, below alarm, headline and figures.
          classNames={{ inner: "consent-place", content: "consent-card" }}
          transitionProps={{ duration: 0 }}
          // No dimming: alarms stay bright and can be acknowledged while the question is open.
          withOverlay={false}
          trapFocus={false}
          lockScroll={false}
          closeOnClickOutside={false}
        >
          <p>{texts.consent.sentence}</p>
          <ConsentAnswers
            caseId={data.case_id}
            onAnswer={(isGiven) => {
              setIsAsking(false);
              if (isGiven) void start();
              else refetch();
            }}
          />
        </Modal>
      )}
      {doing.rejection !== null && (
        <div className="record-rejection">
          <RejectionNote rejection={doing.rejection} />
        </div>
      )}
    </>
  );
}

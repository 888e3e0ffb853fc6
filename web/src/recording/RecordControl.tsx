import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { useProcedure } from "../app/procedure";
import { answered, server } from "../rest/client";
import { RejectionNote } from "../rest/RejectionNote";
import { useAction } from "../rest/useAction";
import { useTexts } from "../texts/TextsContext";
import { RecordingState } from "./RecordingState";

/** The state of the recording, and the one button that starts and stops it. */
export function RecordControl(): ReactNode {
  const texts = useTexts().recording;
  const { data, refetch } = useProcedure();
  const doing = useAction();
  const recording = data?.recording ?? null;
  const isOn = recording?.is_recording === true;
  const start = async (): Promise<void> => {
    await doing.run(async () => {
      await answered(server.POST("/api/recordings/start"));
    });
    refetch();
  };
  const stop = async (): Promise<void> => {
    await doing.run(async () => {
      await answered(server.POST("/api/recordings/stop"));
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
            onClick={() => void (isOn ? stop() : start())}
          >
            <span aria-hidden="true" className="record-sign" data-state={isOn ? "on" : "off"}>
              {isOn ? "■" : "●"}
            </span>{" "}
            {isOn ? texts.stop : texts.start}
          </Button>
        )}
      </div>
      {doing.rejection !== null && (
        <div className="record-rejection">
          <RejectionNote rejection={doing.rejection} />
        </div>
      )}
    </>
  );
}

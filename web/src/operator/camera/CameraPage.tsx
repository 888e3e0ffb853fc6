import { useState, type ReactNode } from "react";
import { EmptyState } from "../../panes/EmptyState";
import { VideoPane } from "../../panes/VideoPane";
import { getCamera } from "../../api";
import { PageLink } from "../../rest/PageLink";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useTexts } from "../../texts/TextsContext";
import { useGates } from "../parts/useGates";
import { useProcedure } from "../../app/procedure";
import { LatencyCard } from "../latency/LatencyCard";
import { RehearsalStrip } from "../registration/RehearsalStrip";
import { Accuracy } from "./Accuracy";
import { startingBoard, type Board } from "./board";
import { BoardCard } from "./BoardCard";
import { CalibrationReport } from "./CalibrationReport";
import { CameraTest } from "./CameraTest";
import { Collection } from "./Collection";
import { Markers } from "./Markers";
import { ReadoutCard } from "./ReadoutCard";

const ASK_EVERY_MS = 2000;

/** The camera page: test, markers, calibration with live coverage, accuracy. */
export function CameraPage(): ReactNode {
  const texts = useTexts().camera;
  const procedure = useProcedure();
  const gatesQuery = useGates();
  const [calibratedHere, setCalibratedHere] = useState(false);
  const [board, setBoard] = useState<Board>(startingBoard);
  const query = useQuery((signal) => getCamera({ signal }), {
    everyMs: ASK_EVERY_MS,
  });
  const { data, refetch } = query;
  const gates = gatesQuery.data;
  const changed = (): void => {
    refetch();
    procedure.refetch();
  };
  const caseId = procedure.data?.case_id ?? null;
  return (
    <div className="beside">
      <div className="beside-picture">
        <VideoPane />
        <RehearsalStrip scenes={["board"]} />
      </div>
      <div className="cards">
        {gates !== null && data === null && <QueryStatus query={query} />}
        {procedure.data !== null && caseId === null && (
          <EmptyState drawing="case" sentence={texts.noCase}>
            <PageLink page="case" />
          </EmptyState>
        )}
        {data !== null && gates !== null && caseId !== null && (
          <>
            {data.collecting && (
              <Collection
                gates={gates}
                onCalibrating={() => {
                  setCalibratedHere(true);
                }}
                onDiscarded={() => {
                  setCalibratedHere(false);
                  changed();
                }}
                onOver={changed}
              />
            )}
            {data.calibration !== null && (
              <CalibrationReport
                caseId={caseId}
                calibration={data.calibration}
                gate={gates.calibration}
                // Mounted after the views, so that it does not move again.
                fresh={calibratedHere && !data.collecting ? data.calibration.heading.id : null}
              />
            )}
            {!data.collecting && (
              <BoardCard
                board={board}
                first={data.calibration === null}
                onBoard={setBoard}
                onBegun={() => {
                  setCalibratedHere(false);
                  changed();
                }}
              />
            )}
            {data.calibration?.heading.current === true && (
              <>
                <ReadoutCard board={board} onChange={changed} />
                <Accuracy board={board} check={data.accuracy} gate={gates.calibration} onChecked={changed} />
              </>
            )}
          </>
        )}
        {gates === null ? (
          <QueryStatus query={gatesQuery} />
        ) : (
          <Markers
            gate={gates.tracker}
            canAdd={procedure.data === null ? null : caseId !== null}
            onChange={changed}
          />
        )}
        <CameraTest />
        <LatencyCard />
      </div>
    </div>
  );
}

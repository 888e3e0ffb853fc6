import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { type CalibrationConfig, type DocumentMessage, postCameraAccuracy } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";
import { Maker } from "../parts/Maker";
import { Measure } from "../parts/Measure";
import { formatTime } from "../parts/format";
import { DocumentValidity } from "../parts/DocumentValidity";
import { useMaker } from "../parts/useMaker";
import { number } from "../tool/toolRecord";
import { isBoard, type Board } from "./board";

interface AccuracyProps {
  board: Board;
  check: DocumentMessage | null;
  gate: CalibrationConfig;
  onChecked: () => void;
}

/** Known distances on a board, measured with the calibrated camera, as in the paper's Table 2. */
export function Accuracy({ board, check, gate, onChecked }: AccuracyProps): ReactNode {
  const all = useTexts();
  const texts = all.camera;
  const madeBy = useMaker();
  const checking = useAction();
  const [checkedHere, setCheckedHere] = useState(false);
  const run = (): void => {
    void checking
      .run(async () => {
        await postCameraAccuracy({ body: { board, made_by: madeBy } });
      })
      .then((done) => {
        setCheckedHere(done);
        onChecked();
      });
  };
  const limit = { kind: "max", value: gate.max_error_mm } as const;
  return (
    <Card
      title={texts.accuracyTitle}
      testId="accuracy"
      fresh={checkedHere ? (check?.heading.id ?? null) : null}
    >
      <p>{texts.accuracyLead}</p>
      {check !== null && (
        <>
          <DocumentValidity heading={check.heading} documents={[]} />
          <p className="soft">
            {formatTime(check.heading.made_at, all.language)} · <Maker of={check.heading} />
          </p>
          <dl className="measures">
            <Measure
              name={texts.accuracyMax}
              value={number(check.content["maximum_error_mm"])}
              unit="mm"
              limit={limit}
            />
            <Measure name={texts.accuracyRms} value={number(check.content["rms_error_mm"])} unit="mm" />
            <Measure
              name={texts.accuracyDistance}
              value={number(check.content["plane_distance_mm"])}
              unit="mm"
              decimals={0}
            />
          </dl>
        </>
      )}
      <div>
        <Button size="lg" variant="default" disabled={!isBoard(board)} loading={checking.busy} onClick={run}>
          {check === null ? texts.accuracy : texts.accuracyAgain}
        </Button>
      </div>
      <RejectionNote rejection={checking.rejection} />
    </Card>
  );
}

import { Button, SegmentedControl, Select } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postCameraBoard, postCameraCollection } from "../../api";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { useTexts } from "../../texts/TextsContext";
import { StepActions } from "../StepActions";
import { Card } from "../parts/Card";
import { saved } from "../parts/saved";
import { boardOf, isBoard, type Board, type Pattern } from "./board";
import { BoardNumbers } from "./BoardNumbers";

type Paper = "A4" | "A3" | "letter";

interface BoardCardProps {
  board: Board;
  first: boolean;
  onBoard: (board: Board) => void;
  onBegun: () => void;
}

/** Choice of the board, its print-out, and the start of collecting. */
export function BoardCard({ board, first, onBoard, onBegun }: BoardCardProps): ReactNode {
  const texts = useTexts().camera;
  const [paper, setPaper] = useState<Paper>("A4");
  const beginning = useAction();
  const printing = useAction();
  const usable = isBoard(board);
  const begin = (): void => {
    void beginning
      .run(async () => {
        await postCameraCollection({ body: { board } });
      })
      .then(onBegun);
  };
  const print = (): void => {
    void printing.run(async () => {
      saved(await postCameraBoard({ body: { board, paper, file: "pdf" } }), `board-${paper}.pdf`);
    });
  };
  return (
    <Card title={first ? texts.calibrateTitle : texts.calibrateAnew} testId="board">
      <p>{texts.calibrateLead}</p>
      <SegmentedControl
        size="lg"
        fullWidth
        aria-label={texts.pattern}
        data={Object.entries(texts.patterns).map(([value, label]) => ({ value, label }))}
        value={board.pattern}
        onChange={(value) => {
          onBoard(boardOf(value as Pattern));
        }}
      />
      <BoardNumbers board={board} onBoard={onBoard} />
      {!usable && <p className="bad">▲ {texts.boardWrong}</p>}
      <div className="row">
        <Button size="lg" variant="default" disabled={!usable} loading={printing.busy} onClick={print}>
          {texts.print}
        </Button>
        <Select
          size="lg"
          aria-label={texts.paper}
          allowDeselect={false}
          className="paper"
          data={["A4", "A3", "letter"]}
          value={paper}
          onChange={(value) => {
            if (value !== null) setPaper(value);
          }}
        />
      </div>
      <p className="soft">{texts.printHint}</p>
      <StepActions>
        <Button
          size="xl"
          variant={first ? "filled" : "default"}
          disabled={!usable}
          loading={beginning.busy}
          data-testid="collect"
          onClick={begin}
        >
          {texts.collect}
        </Button>
      </StepActions>
      <RejectionNote rejection={beginning.rejection ?? printing.rejection} />
    </Card>
  );
}

import { NumberInput, Select } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import type { Board } from "./board";

const DICTIONARIES = [4, 5, 6, 7].flatMap((bits) =>
  [50, 100, 250, 1000].map((size) => `DICT_${String(bits)}X${String(bits)}_${String(size)}`),
);

/** Dimensions of a board, with units. */
export function BoardNumbers({
  board,
  onBoard,
}: {
  board: Board;
  onBoard: (board: Board) => void;
}): ReactNode {
  const texts = useTexts().camera;
  const counts = texts.counts[board.pattern];
  return (
    <div className="numbers-grid">
      <Count
        label={counts.columns}
        value={board.columns}
        onChange={(columns) => {
          onBoard({ ...board, columns });
        }}
      />
      <Count
        label={counts.rows}
        value={board.rows}
        onChange={(rows) => {
          onBoard({ ...board, rows });
        }}
      />
      {board.pattern === "dots" ? (
        <>
          <Size
            label={texts.pitch}
            value={board.pitch_mm}
            onChange={(pitch_mm) => {
              onBoard({ ...board, pitch_mm });
            }}
          />
          <Select
            size="lg"
            label={texts.layout}
            allowDeselect={false}
            data={Object.entries(texts.layouts).map(([value, label]) => ({ value, label }))}
            value={board.layout}
            onChange={(layout) => {
              if (layout !== null) onBoard({ ...board, layout: layout as typeof board.layout });
            }}
          />
        </>
      ) : board.pattern === "aprilgrid" ? (
        <>
          <Size
            label={texts.tag}
            value={board.tag_mm}
            onChange={(tag_mm) => {
              onBoard({ ...board, tag_mm });
            }}
          />
          <Size
            label={texts.gap}
            value={board.gap_mm}
            onChange={(gap_mm) => {
              onBoard({ ...board, gap_mm });
            }}
          />
        </>
      ) : (
        <Size
          label={texts.square}
          value={board.square_mm}
          onChange={(square_mm) => {
            onBoard({ ...board, square_mm });
          }}
        />
      )}
      {board.pattern === "charuco" && (
        <>
          <Size
            label={texts.marker}
            value={board.marker_mm}
            onChange={(marker_mm) => {
              onBoard({ ...board, marker_mm });
            }}
          />
          <Select
            size="lg"
            label={texts.dictionary}
            allowDeselect={false}
            data={DICTIONARIES}
            value={board.dictionary}
            onChange={(dictionary) => {
              if (dictionary !== null) onBoard({ ...board, dictionary });
            }}
          />
        </>
      )}
    </div>
  );
}

interface NumberProps {
  label: string;
  value: number;
  onChange: (value: number) => void;
}

function Count({ label, value, onChange }: NumberProps): ReactNode {
  return (
    <NumberInput
      hideControls
      inputMode="decimal"
      size="lg"
      label={label}
      min={2}
      max={200}
      step={1}
      allowDecimal={false}
      value={shown(value)}
      onChange={(given) => {
        onChange(typed(given));
      }}
    />
  );
}

function Size({ label, value, onChange }: NumberProps): ReactNode {
  return (
    <NumberInput
      hideControls
      inputMode="decimal"
      size="lg"
      label={`${label} (mm)`}
      min={0.1}
      max={1000}
      step={1}
      decimalScale={3}
      value={shown(value)}
      onChange={(given) => {
        onChange(typed(given));
      }}
    />
  );
}

const shown = (value: number): number | string => (Number.isFinite(value) ? value : "");
const typed = (given: number | string): number => (typeof given === "number" ? given : Number.NaN);

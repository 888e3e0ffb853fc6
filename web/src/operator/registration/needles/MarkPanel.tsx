import { Button } from "@mantine/core";
import { useState, type ReactNode, type RefObject } from "react";
import { Icon } from "../../../panes/Icon";
import { useTexts } from "../../../texts/TextsContext";
import { interpolate } from "../../../texts/interpolate";
import { ConcludeNeedles } from "./ConcludeNeedles";
import { Magnifier } from "./Magnifier";
import { nextEnd, withEnd, type End, type Mark } from "./marks";
import type { NeedleRequest } from "./order";
import type { Px } from "./overlay";
import { useMarkOnStage } from "./useMarkOnStage";
import { useNeedleNames } from "./useNeedleNames";

const WAYS: readonly [string, "left" | "up" | "down" | "right", Px][] = [
  ["←", "left", [-1, 0]],
  ["↑", "up", [0, -1]],
  ["↓", "down", [0, 1]],
  ["→", "right", [1, 0]],
];

interface MarkPanelProps {
  order: NeedleRequest;
  names: readonly string[];
  marks: Mark[];
  onMarks: (marks: Mark[]) => void;
  stage: RefObject<HTMLDivElement | null>;
  picture: RefObject<HTMLCanvasElement | null>;
  isFrozen: boolean;
}

/** Marks the needles one after another: first at the bone, then at the head. */
export function MarkPanel({
  order,
  names,
  marks,
  onMarks,
  stage,
  picture,
  isFrozen,
}: MarkPanelProps): ReactNode {
  const texts = useTexts().registration;
  const nameOf = useNeedleNames();
  const [chosen, setChosen] = useState<End | null>(null);
  const placed = marks.filter(
    (one) => one.head_px[0] !== one.entry_px[0] || one.head_px[1] !== one.entry_px[1],
  );
  const open = placed.length < marks.length ? (marks.at(-1)?.entry_px ?? null) : null;
  const next = nextEnd(placed, open, names.length);

  useMarkOnStage(stage, marks, {
    onPlace: (at) => {
      if (next === null) return;
      // Until its head is marked, a needle has zero length.
      if (next.end === "entry_px") onMarks([...marks, { entry_px: [...at], head_px: [...at] }]);
      else onMarks(withEnd(marks, next, at));
      setChosen(next);
    },
    onTake: setChosen,
    onMove: (end, at) => {
      onMarks(withEnd(marks, end, at));
    },
  });

  const at = chosen === null ? null : (marks[chosen.needle]?.[chosen.end] ?? null);
  const nudge = ([x, y]: Px): void => {
    if (chosen === null || at === null) return;
    onMarks(withEnd(marks, chosen, [at[0] + x, at[1] + y]));
  };
  return (
    <section className="card">
      <p data-testid="mark-next">
        {next === null
          ? texts.mark.all
          : interpolate(next.end === "entry_px" ? texts.mark.entry : texts.mark.head, {
              needle: nameOf(names[next.needle] ?? ""),
              number: next.needle + 1,
            })}
      </p>
      <div className="row">
        <Magnifier picture={picture} at={at} name={texts.mark.magnifier} />
        <div className="pad" role="group" aria-label={texts.mark.adjust}>
          {WAYS.map(([symbol, way, by]) => (
            <Button
              key={way}
              size="lg"
              variant="default"
              aria-label={texts.overlay[way]}
              disabled={at === null}
              onClick={() => {
                nudge(by);
              }}
            >
              {symbol}
            </Button>
          ))}
        </div>
      </div>
      <div className="row">
        <Button
          size="lg"
          variant="default"
          disabled={marks.length === 0}
          data-testid="mark-undo"
          onClick={() => {
            setChosen(null);
            onMarks(marks.slice(0, -1));
          }}
        >
          <Icon name="undo" /> {texts.mark.undo}
        </Button>
        <Button
          size="lg"
          variant="default"
          disabled={marks.length === 0}
          onClick={() => {
            setChosen(null);
            onMarks([]);
          }}
        >
          {texts.mark.clear}
        </Button>
      </div>
      <p className="quiet">{texts.mark.hint}</p>
      <ConcludeNeedles
        order={order}
        marked={placed}
        isFrozen={isFrozen}
        disabled={next !== null || names.length === 0}
      >
        {texts.mark.conclude}
      </ConcludeNeedles>
    </section>
  );
}

import { useState, type ReactNode } from "react";
import { CommentForm } from "./CommentForm";
import { Exports } from "./Exports";
import { ReviewPanel } from "./ReviewPanel";
import type { Span } from "./span";
import { TimelineStatus } from "./TimelineStatus";
import { useShownInstant } from "./useShownInstant";
import { useTimeline, type LoadedTimeline, type TimelineState } from "./useTimeline";

/** Review of one recording, with comments and exports. */
export function Review({ name, mayExport }: { name: string; mayExport: boolean }): ReactNode {
  const state = useTimeline(name);
  return state.loaded === null ? (
    <TimelineStatus state={state} />
  ) : (
    <Loaded name={name} mayExport={mayExport} state={state} loaded={state.loaded} />
  );
}

interface LoadedProps {
  name: string;
  mayExport: boolean;
  state: TimelineState;
  loaded: LoadedTimeline;
}

function Loaded({ name, mayExport, state, loaded }: LoadedProps): ReactNode {
  const [number, setNumber] = useState(0);
  const [piece, setPiece] = useState<Span | null>(null);
  const { shown, isLoading } = useShownInstant(name, number);
  const atS = shown.instant?.at_s ?? 0;
  const { duration_s: durationS } = loaded.timeline;
  return (
    <ReviewPanel
      name={name}
      loaded={loaded}
      span={state.span}
      onSpan={state.setSpan}
      piece={piece}
      number={number}
      shown={shown}
      isLoading={isLoading}
      onNumber={setNumber}
    >
      <CommentForm name={name} atS={atS} onWritten={state.query.refetch} />
      {mayExport && <Exports name={name} atS={atS} durationS={durationS} piece={piece} onPiece={setPiece} />}
    </ReviewPanel>
  );
}

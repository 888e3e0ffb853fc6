import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { useRoomWords } from "../room/RoomContext";
import { useWords } from "../words/WordsContext";
import type { Tool } from "./hand";
import { useMarking } from "./MarkingContext";

const TOOLS: readonly Tool[] = ["point", "pen", "arrow", "circle"];
const SYMBOL: Record<Tool | "undo" | "clear" | "clearAll", string> = {
  point: "●",
  pen: "✎",
  arrow: "➚",
  circle: "◯",
  undo: "↶",
  clear: "✕",
  clearAll: "✕✕",
};

/** What the hand does on the video, and how it is taken back. */
export function MarksTools(): ReactNode {
  const words = useWords().marks;
  const marking = useMarking();
  const { stands, you } = useRoomWords();
  const { view } = useLive();
  if (marking === null) return null;
  const trouble = !stands ? words.lineGone : !view.video.live ? words.noPicture : "";
  return (
    <div className="marks-tools" role="toolbar" aria-label={words.tools}>
      {TOOLS.map((tool) => (
        <button
          key={tool}
          type="button"
          data-testid={`tool-${tool}`}
          aria-pressed={tool === marking.tool}
          onClick={() => {
            marking.choose(tool);
          }}
        >
          <span aria-hidden="true">{SYMBOL[tool]}</span> {words.tool[tool]}
        </button>
      ))}
      <button
        type="button"
        data-testid="marks-undo"
        disabled={!stands}
        onClick={() => {
          marking.hand.undo();
        }}
      >
        <span aria-hidden="true">{SYMBOL.undo}</span> {words.undo}
      </button>
      <button
        type="button"
        data-testid="marks-clear"
        disabled={!stands}
        onClick={() => {
          marking.hand.clear("own");
        }}
      >
        <span aria-hidden="true">{SYMBOL.clear}</span> {words.clear}
      </button>
      {you?.role === "operator" && (
        <button
          type="button"
          data-testid="marks-clear-all"
          disabled={!stands}
          onClick={() => {
            marking.hand.clear("all");
          }}
        >
          <span aria-hidden="true">{SYMBOL.clearAll}</span> {words.clearAll}
        </button>
      )}
      <p role="status" className="marks-trouble">
        {trouble === "" ? words.seenBy : `▲ ${trouble}`}
      </p>
    </div>
  );
}

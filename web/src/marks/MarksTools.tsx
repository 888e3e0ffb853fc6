import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { formatNumber } from "../live/rounding";
import { useRoomSnapshot } from "../room/RoomContext";
import { Icon } from "../panes/Icon";
import { useTexts } from "../texts/TextsContext";
import type { Tool } from "./marksInput";
import { useMarking } from "./MarkingContext";

const TOOLS: readonly Tool[] = ["point", "pen", "arrow", "circle"];

/** Choice of the drawing tool, undo and clear. */
export function MarksTools(): ReactNode {
  const { marks: texts, rest } = useTexts();
  const marking = useMarking();
  const { isConnected, firstMessage, you, fadesAfterS } = useRoomSnapshot();
  const { view } = useLive();
  if (marking === null) return null;
  const isLoading = firstMessage === "awaited" || view.firstMessage === "awaited";
  const gone = !isConnected ? texts.lineGone : !view.video.live ? texts.noPicture : "";
  const problem = isLoading ? rest.loading : gone === "" ? "" : `▲ ${gone}`;
  return (
    <div className="marks-tools" role="toolbar" aria-label={texts.tools}>
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
          <Icon name={tool} /> {texts.tool[tool]}
        </button>
      ))}
      <button
        type="button"
        data-testid="marks-undo"
        disabled={!isConnected}
        onClick={() => {
          marking.input.undo();
        }}
      >
        <Icon name="undo" /> {texts.undo}
      </button>
      <button
        type="button"
        data-testid="marks-clear"
        disabled={!isConnected}
        onClick={() => {
          marking.input.clear("own");
        }}
      >
        <Icon name="cross" /> {texts.clear}
      </button>
      {you?.role === "operator" && (
        <button
          type="button"
          data-testid="marks-clear-all"
          disabled={!isConnected}
          onClick={() => {
            marking.input.clear("all");
          }}
        >
          <Icon name="cross" /> {texts.clearAll}
        </button>
      )}
      <p role="status" className="marks-problem" data-problem={problem !== "" || undefined}>
        {problem !== ""
          ? problem
          : fadesAfterS === null
            ? texts.seenBy
            : `${texts.seenBy} ${texts.fades.replace("#", formatNumber(fadesAfterS, 0))}`}
      </p>
    </div>
  );
}

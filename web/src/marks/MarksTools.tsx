import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { shownNumber } from "../live/rounding";
import { useRoomWords } from "../room/RoomContext";
import { Icon } from "../panes/Icon";
import { useWords } from "../words/WordsContext";
import type { Tool } from "./hand";
import { useMarking } from "./MarkingContext";

const TOOLS: readonly Tool[] = ["point", "pen", "arrow", "circle"];

/** What the hand does on the video, and how it is taken back. */
export function MarksTools(): ReactNode {
  const { marks: words, rest } = useWords();
  const marking = useMarking();
  const { stands, firstMessage, you, fadesAfterS } = useRoomWords();
  const { view } = useLive();
  if (marking === null) return null;
  const isLoading = firstMessage === "awaited" || view.firstMessage === "awaited";
  const gone = !stands ? words.lineGone : !view.video.live ? words.noPicture : "";
  const problem = isLoading ? rest.loading : gone === "" ? "" : `▲ ${gone}`;
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
          <Icon name={tool} /> {words.tool[tool]}
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
        <Icon name="undo" /> {words.undo}
      </button>
      <button
        type="button"
        data-testid="marks-clear"
        disabled={!stands}
        onClick={() => {
          marking.hand.clear("own");
        }}
      >
        <Icon name="cross" /> {words.clear}
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
          <Icon name="cross" /> {words.clearAll}
        </button>
      )}
      <p role="status" className="marks-trouble">
        {problem !== ""
          ? problem
          : fadesAfterS === null
            ? words.seenBy
            : `${words.seenBy} ${words.fades.replace("#", shownNumber(fadesAfterS, 0))}`}
      </p>
    </div>
  );
}

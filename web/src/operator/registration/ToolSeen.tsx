import { useRef, type ReactNode } from "react";
import { usePainter } from "../../live/LiveContext";
import { formatNumber } from "../../live/rounding";
import { setData, setText } from "../../panes/setText";
import { useTexts } from "../../texts/TextsContext";

/** Whether the tool is seen in the newest image, and how sure its tip is; painted with every image. Says nothing
 *  without a tool or a live image: why there is none stands over the picture. */
export function ToolSeen({ tool }: { tool: string }): ReactNode {
  const texts = useTexts().registration.tool;
  const line = useRef<HTMLParagraphElement>(null);
  usePainter(({ newest, video }) => {
    const now = newest?.snapshot?.tools.find((one) => one.name === tool);
    const pose = video.live && now?.pose.kind === "tool" ? now.pose : null;
    setData(line.current, "seen", String(pose !== null));
    if (tool === "" || !video.live) {
      setText(line.current, "");
      return;
    }
    setText(
      line.current,
      pose === null
        ? `▲ ${tool} ${texts.unseen}`
        : `✓ ${tool} ${texts.seen} · ${texts.tip} ± ${formatNumber(pose.tip_sd_mm, 2)} mm`,
    );
  });
  return <p className="tool-seen" data-testid="tool-seen" ref={line} />;
}

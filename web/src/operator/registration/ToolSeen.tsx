import { useRef, type ReactNode } from "react";
import { usePainter } from "../../live/LiveContext";
import { formatNumber } from "../../live/rounding";
import { setData, setText } from "../../panes/setText";
import { useTexts } from "../../texts/TextsContext";

/**
 * Whether the tool is visible in the newest image, and the uncertainty of its tip; painted with every image. Empty
 *  * without a tool or a live image; the picture's cover states the reason.
 */
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

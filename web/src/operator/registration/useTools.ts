import { useLive } from "../../live/LiveContext";

/** The tools that the live images know, and whether the marker of each is seen now; null without an image. */
export function useTools(): { name: string; seen: boolean }[] | null {
  const { view } = useLive();
  const snapshot = view.newest?.snapshot;
  if (!snapshot) return null;
  return snapshot.tools.map((tool) => ({ name: tool.name, seen: tool.pose.kind === "tool" }));
}

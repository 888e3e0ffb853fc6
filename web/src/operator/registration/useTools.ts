import { useLive } from "../../live/LiveContext";

/** Tools in the live images, and whether their markers are visible; null without an image. */
export function useTools(): { name: string; seen: boolean }[] | null {
  const { view } = useLive();
  const snapshot = view.newest?.snapshot;
  if (!snapshot) return null;
  return snapshot.tools.map((tool) => ({ name: tool.name, seen: tool.pose.kind === "tool" }));
}

import { useLive } from "../../live/LiveContext";

/** The tools that the live images know, and whether the marker of each is seen now. */
export function useTools(): { name: string; seen: boolean }[] {
  const { view } = useLive();
  const snapshot = view.newest?.snapshot;
  if (!snapshot) return [];
  return snapshot.tools.map((tool) => ({ name: tool.name, seen: tool.pose.kind === "tool" }));
}

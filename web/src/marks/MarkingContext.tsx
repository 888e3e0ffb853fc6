// Inside this provider video and cuts can be pointed at and drawn on; outside, marks are read-only.
import { createContext, use, useMemo, useState, type ReactNode } from "react";
import { useRoom } from "../room/RoomContext";
import { MarksInput, type Tool } from "./marksInput";

interface Marking {
  tool: Tool;
  choose: (tool: Tool) => void;
  input: MarksInput;
}

const MarkingContext = createContext<Marking | null>(null);

export function MarkingProvider({ children }: { children: ReactNode }): ReactNode {
  const room = useRoom();
  const [tool, choose] = useState<Tool>("point");
  const input = useMemo(() => new MarksInput((message) => room?.send(message) ?? false), [room]);
  const value = useMemo(() => ({ tool, choose, input }), [tool, input]);
  return <MarkingContext value={value}>{children}</MarkingContext>;
}

/** Null if marking is not possible. */
export function useMarking(): Marking | null {
  return use(MarkingContext);
}

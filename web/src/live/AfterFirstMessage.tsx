import type { ReactNode } from "react";
import { useLive } from "./LiveContext";

interface AfterFirstMessageProps {
  loading: ReactNode;
  children: ReactNode;
}

/** Renders live content; until the first message has arrived or is overdue, `loading`. */
export function AfterFirstMessage({ loading, children }: AfterFirstMessageProps): ReactNode {
  return useLive().view.firstMessage === "awaited" ? loading : children;
}

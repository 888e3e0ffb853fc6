import type { ReactNode } from "react";
import { useLive } from "./LiveContext";

interface AfterFirstMessageProps {
  loading: ReactNode;
  children: ReactNode;
}

/** What states something of the live state; until the first message has come, or is overdue, `loading`. */
export function AfterFirstMessage({ loading, children }: AfterFirstMessageProps): ReactNode {
  return useLive().view.firstMessage === "awaited" ? loading : children;
}

import type { ReactNode } from "react";

export function ToolPage(): ReactNode {
  return null;
}

import type { ReactNode } from "react";

export function NavigatePage(): ReactNode {
  return null;
}

import type { ReactNode } from "react";

export function CameraPage(): ReactNode {
  return null;
}

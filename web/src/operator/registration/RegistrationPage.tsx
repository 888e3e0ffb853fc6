import type { ReactNode } from "react";

export function RegistrationPage(): ReactNode {
  return null;
}

import type { ShellWords } from "./en";

export const shellDe: ShellWords = {
  views: "Ansichten",
  view: { theatre: "Operationssaal", operator: "Bedienung", supervisor: "Aufsicht" },
};

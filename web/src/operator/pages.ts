// Pages of the operator's view, in the order of the procedure; the address is `/operator/<name>`.
import type { ReactNode } from "react";
import { CameraPage } from "./camera/CameraPage";
import { CasePage } from "./case/CasePage";
import { CheckPage } from "./check/CheckPage";
import { NavigatePage } from "./navigate/NavigatePage";
import { PeoplePage } from "./people/PeoplePage";
import { PlanPage } from "./plan/PlanPage";
import type { Step } from "../app/procedure";
import { RecordingsPage } from "./recordings/RecordingsPage";
import { RegistrationPage } from "./registration/RegistrationPage";
import { ReportPage } from "./report/ReportPage";
import { ToolPage } from "./tool/ToolPage";

type PageName =
  | "case"
  | "camera"
  | "tool"
  | "plan"
  | "register"
  | "check"
  | "navigate"
  | "recordings"
  | "report"
  | "people";

export interface OperatorPage {
  name: PageName;
  /** The page's step of the procedure; null if it has none. */
  step: Step["step"] | null;
  Page: () => ReactNode;
}

export const PAGES: readonly OperatorPage[] = [
  { name: "case", step: null, Page: CasePage },
  { name: "camera", step: "camera", Page: CameraPage },
  { name: "tool", step: "tool", Page: ToolPage },
  { name: "plan", step: "plan", Page: PlanPage },
  { name: "register", step: "register", Page: RegistrationPage },
  { name: "check", step: "check", Page: CheckPage },
  { name: "navigate", step: "navigate", Page: NavigatePage },
  { name: "recordings", step: null, Page: RecordingsPage },
  { name: "report", step: null, Page: ReportPage },
  { name: "people", step: null, Page: PeoplePage },
];

export function pageAt(path: string): OperatorPage | null {
  const name = path.split("/")[2] ?? "";
  return PAGES.find((page) => page.name === name) ?? null;
}

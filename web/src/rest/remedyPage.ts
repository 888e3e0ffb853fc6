// On which page of the operator an error is remedied. `tests/web/test_remedy_pages.py` checks that the server has each code.
import type { Texts } from "../texts/catalogue";

export type PageName = keyof Texts["operator"]["page"];

const CODES_OF_PAGE: Partial<Record<PageName, readonly string[]>> = {
  case: ["NO_CASE_OPEN", "CASE_NOT_OPEN", "CASE_UNKNOWN"],
  camera: [
    "CAMERA_NOT_CALIBRATED",
    "CAMERA_CHANGED",
    "CAMERA_DIFFERS",
    "CAMERA_SIZE_MISMATCH",
    "CAMERA_ASPECT_DIFFERS",
  ],
  tool: [
    "TOOL_TIP_MISSING",
    "TOOL_UNKNOWN",
    "CERTIFICATE_MISSING",
    "CERTIFICATE_CAMERA_CHANGED",
    "CERTIFICATE_TOOL_CHANGED",
  ],
  plan: [
    "CT_MISSING",
    "CT_REPLACED",
    "PLAN_EMPTY",
    "NO_ACTIVE_CHANNEL",
    "CHANNEL_MISSING",
    "LANDMARKS_TOO_FEW",
    "REFERENCE_MISSING",
    "SURFACE_MISSING",
  ],
  register: ["REGISTRATION_DOCUMENT_INVALID", "REGISTRATION_CONTEXT_CHANGED"],
  check: ["REGISTRATION_CHANGED"],
  people: ["PHONE_ABSENT"],
};

/** A step that is requested too early has the code of the step that it waits for, with that step's state. */
const STEP_TO_WAIT_FOR = /^(CAMERA|TOOL|PLAN|REGISTER|CHECK)_(?:MISSING|OUT_OF_DATE|FAILED)$/;

const PAGE_OF_CODE = new Map(
  Object.entries(CODES_OF_PAGE).flatMap(([page, codes]) =>
    codes.map((code) => [code, page as PageName] as const),
  ),
);

/** The page that remedies an error; null if there is none, or if it is the present one. */
export function remedyPageOf(code: string, path: string): PageName | null {
  const step = STEP_TO_WAIT_FOR.exec(code)?.[1]?.toLowerCase() as PageName | undefined;
  const page = step ?? PAGE_OF_CODE.get(code);
  // Only the operator's view has these pages.
  if (page === undefined || !path.startsWith("/operator")) return null;
  return path.split("/")[2] === page ? null : page;
}

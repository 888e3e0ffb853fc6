import { expect, test } from "vitest";
import { remedyPageOf } from "./remedyPage";

test.each([
  ["CAMERA_NOT_CALIBRATED", "/operator/tool", "camera"],
  ["CAMERA_NOT_CALIBRATED", "/operator/register/points", "camera"],
  ["CAMERA_NOT_CALIBRATED", "/operator/camera", null],
  ["NO_CASE_OPEN", "/operator", "case"],
  ["CT_MISSING", "/operator/navigate", "plan"],
  ["LANDMARKS_TOO_FEW", "/operator/register/points", "plan"],
  ["REGISTER_MISSING", "/operator/register/points", null],
  ["PLAN_OUT_OF_DATE", "/operator/register/points", "plan"],
  ["REGISTER_FAILED", "/operator/check", "register"],
  ["LANDMARK_CHECK_FAILED", "/operator/check", null],
  ["TOOL_UNKNOWN", "/operator/check", "tool"],
  ["CAMERA_NOT_CALIBRATED", "/theatre", null],
  ["CAMERA_NOT_CALIBRATED", "/supervisor", null],
  ["DISK_FULL", "/operator/camera", null],
  ["constructor", "/operator/camera", null],
])("%s on %s is remedied on the page %s", (code, path, page) => {
  expect(remedyPageOf(code, path)).toBe(page);
});

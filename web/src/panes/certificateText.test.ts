import { expect, test } from "vitest";
import type { ToolCertification } from "../rest/useCertificates";
import { certificateDe } from "../texts/certificate/de";
import { certificateEn } from "../texts/certificate/en";
import { certificateText } from "./certificateText";

const drill: ToolCertification = {
  tool: "drill",
  marker: "drill",
  certified: true,
  problem: null,
  error_95_mm: 0.49,
  valid_until: "2027-02-25T16:33:00+00:00",
  issued_at: "2026-11-27T16:33:00+00:00",
  issued_by: "ito",
};

test("a certified tool is shown with its error and the last day", () => {
  expect(certificateText({ tools: [drill] }, certificateEn)).toBe("certified until 2027-02-25 to 0.49 mm");
  expect(certificateText({ tools: [drill] }, certificateDe)).toBe("zertifiziert bis 2027-02-25 auf 0.49 mm");
});

test("a void certificate shows neither error nor date", () => {
  const expired = { ...drill, certified: false };
  expect(certificateText({ tools: [expired] }, certificateEn)).toBe("not certified");
});

test("several tools are named", () => {
  const awl = { ...drill, tool: "awl", certified: false };
  expect(certificateText({ tools: [awl, drill] }, certificateEn)).toBe(
    "awl: not certified; drill: certified until 2027-02-25 to 0.49 mm",
  );
});

test("without a tool in an image nothing is certified", () => {
  expect(certificateText({ tools: [] }, certificateEn)).toBe("not certified");
});

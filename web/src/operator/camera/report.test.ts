import { expect, test } from "vitest";
import { reportIn } from "./report";

test("a calibration's numbers, views, warnings and pictures are read", () => {
  const report = reportIn({
    report: {
      rms_px: 0.12,
      noise_px: 0.1,
      coverage: { cells_ratio: 0.9 },
      size_wh_px: [1280, 720],
      model: { reason: "five coefficients" },
      parameters: [{ name: "fx", value: 1500.5, low_95: 1499, high_95: 1502 }],
      views: [{ image: "image 7", used: false, rms_px: null, points: 140, reason: "too far off" }],
      warnings: [{ code: "X", message: "the board bends", remedy: "Take a stiff one." }],
    },
    plots: { residuals: "abc.svg", odd: 3 },
  });
  expect(report.rmsPx).toBe(0.12);
  expect(report.parameters).toEqual([{ name: "fx", value: 1500.5, low95: 1499, high95: 1502 }]);
  expect(report.views[0]).toMatchObject({
    image: "image 7",
    used: false,
    rmsPx: null,
    reason: "too far off",
  });
  expect(report.warnings[0]?.remedy).toBe("Take a stiff one.");
  expect(report.plots).toEqual([["residuals", "abc.svg"]]);
});

test("a document without a report, as another program would write it, breaks nothing", () => {
  expect(reportIn({ camera: {} })).toMatchObject({ rmsPx: null, parameters: [], views: [], plots: [] });
  expect(reportIn({ report: "none", plots: null }).warnings).toEqual([]);
});

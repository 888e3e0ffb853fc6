// Parses a calibration document; its content is not trusted.
import type { Remark } from "../parts/Remarks";

interface Parameter {
  name: string;
  value: number;
  low95: number | null;
  high95: number | null;
}

export interface View {
  image: string;
  used: boolean;
  rmsPx: number | null;
  points: number | null;
  reason: string;
}

interface Report {
  rmsPx: number | null;
  noisePx: number | null;
  cellsRatio: number | null;
  sizePx: readonly number[];
  model: string;
  parameters: readonly Parameter[];
  views: readonly View[];
  warnings: readonly Remark[];
  /** File ids by the name of the plot. */
  plots: readonly (readonly [string, string])[];
}

export function reportIn(content: Record<string, unknown>): Report {
  const report = part(content["report"]);
  return {
    rmsPx: number(report["rms_px"]),
    noisePx: number(report["noise_px"]),
    cellsRatio: number(part(report["coverage"])["cells_ratio"]),
    sizePx: list(report["size_wh_px"]).filter((one): one is number => typeof one === "number"),
    model: text(part(report["model"])["reason"]),
    parameters: list(report["parameters"])
      .map(part)
      .map((one) => ({
        name: text(one["name"]),
        value: number(one["value"]) ?? Number.NaN,
        low95: number(one["low_95"]),
        high95: number(one["high_95"]),
      })),
    views: list(report["views"])
      .map(part)
      .map((one) => ({
        image: text(one["image"]),
        used: one["used"] === true,
        rmsPx: number(one["rms_px"]),
        points: number(one["points"]),
        reason: text(one["reason"]),
      })),
    warnings: list(report["warnings"])
      .map(part)
      .map((one) => ({
        code: text(one["code"]),
        message: text(one["message"]),
        remedy: text(one["remedy"]),
      })),
    plots: Object.entries(part(content["plots"])).filter(
      (entry): entry is [string, string] => typeof entry[1] === "string",
    ),
  };
}

function part(value: unknown): Record<string, unknown> {
  return typeof value === "object" && value !== null ? (value as Record<string, unknown>) : {};
}

const list = (value: unknown): unknown[] => (Array.isArray(value) ? (value as unknown[]) : []);
const text = (value: unknown): string => (typeof value === "string" ? value : "");
const number = (value: unknown): number | null =>
  typeof value === "number" && Number.isFinite(value) ? value : null;

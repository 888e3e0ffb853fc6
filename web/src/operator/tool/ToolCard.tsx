import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import type { HeadingMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { StepActions } from "../StepActions";
import { Card } from "../parts/Card";
import { Maker } from "../parts/Maker";
import { Measure } from "../parts/Measure";
import { DocumentValidity } from "../parts/DocumentValidity";
import { formatTime } from "../parts/format";
import {
  toolRecordFrom,
  nextPurpose,
  number,
  type KnownTool,
  type Purpose,
  type ToolGate,
} from "./toolRecord";

const PURPOSES: readonly Purpose[] = ["pivot", "spin", "tip_check"];

interface ToolCardProps {
  tool: KnownTool;
  gate: ToolGate;
  documents: readonly HeadingMessage[] | null;
  busy: boolean;
  /** Whether its next action is the main button of the page. */
  hasMainButton: boolean;
  /** Identifies a tool of which something was just saved here. */
  fresh: string | null;
  onBegin: (tool: string, purpose: Purpose, marker: string | null) => void;
}

/** One tool: calibration values with limits, and available actions. */
export function ToolCard({
  tool,
  gate,
  documents,
  busy,
  hasMainButton,
  fresh,
  onBegin,
}: ToolCardProps): ReactNode {
  const all = useTexts();
  const texts = all.tool;
  const stored = tool.calibration === null ? null : toolRecordFrom(tool.calibration.content);
  const radiusMm = stored?.radiusMm ?? tool.radius_mm;
  const next = nextPurpose(tool);
  const canPivotOnly = tool.calibration?.heading.current !== true;
  const begin = (purpose: Purpose): ReactNode => (
    <Button
      key={purpose}
      size={purpose === next ? "xl" : "lg"}
      variant={purpose === next ? "filled" : "default"}
      disabled={busy || (canPivotOnly && purpose !== "pivot")}
      data-testid={`begin-${purpose}`}
      onClick={() => {
        onBegin(tool.name, purpose, null);
      }}
    >
      {purpose === "pivot" && tool.calibration !== null ? texts.pivotAnew : texts.begin[purpose]}
    </Button>
  );
  return (
    <Card title={tool.name} testId={`tool-${tool.name}`} fresh={fresh}>
      {tool.calibration === null && (
        <p className="soft">{tool.from_settings ? texts.ofSettings : texts.nothing}</p>
      )}
      {tool.calibration !== null && (
        <>
          <DocumentValidity heading={tool.calibration.heading} documents={documents} />
          <p className="soft">
            {texts.made} {formatTime(tool.calibration.heading.made_at, all.language)} ·{" "}
            <Maker of={tool.calibration.heading} />
          </p>
        </>
      )}
      <dl className="measures">
        {stored !== null && (
          <>
            <Measure
              name={texts.tipRms}
              value={stored.tipRmsMm}
              unit="mm"
              limit={{ kind: "max", value: gate.max_rms_3d_mm }}
            />
            <Measure
              name={texts.tilt}
              value={stored.tiltDeg}
              unit="°"
              decimals={0}
              limit={{ kind: "min", value: gate.min_tilt_deg }}
            />
            <Measure
              name={texts.axisSd}
              value={stored.axisSdDeg}
              unit="°"
              limit={{ kind: "max", value: gate.max_axis_sd_deg }}
            />
            <Measure
              name={texts.wobble}
              value={stored.wobbleDeg}
              unit="°"
              limit={{ kind: "max", value: gate.max_wobble_deg }}
            />
          </>
        )}
        <Measure
          name={texts.diameter}
          value={radiusMm === null ? null : 2 * radiusMm}
          unit="mm"
          decimals={1}
        />
        <Measure name={texts.length} value={stored?.lengthMm ?? tool.length_mm} unit="mm" decimals={0} />
        {tool.check?.heading.current === true && (
          <Measure name={texts.checkMax} value={number(tool.check.content["max_mm"])} unit="mm" />
        )}
        {tool.check?.heading.current === true && (
          <Measure
            name={texts.checkRms}
            value={number(tool.check.content["rms_3d_mm"])}
            unit="mm"
            limit={{ kind: "max", value: gate.max_rms_3d_mm }}
          />
        )}
      </dl>
      {stored?.hasAxis === false && <p className="bad">▲ {texts.noAxis}</p>}
      <div className="row">{PURPOSES.filter((one) => !hasMainButton || one !== next).map(begin)}</div>
      {hasMainButton && <StepActions>{begin(next)}</StepActions>}
    </Card>
  );
}

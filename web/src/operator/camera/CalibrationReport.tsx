import { Table } from "@mantine/core";
import type { ReactNode } from "react";
import { formatFigure } from "../../live/rounding";
import type { CalibrationConfig, DocumentMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";
import { Maker } from "../parts/Maker";
import { Measure } from "../parts/Measure";
import { Remarks } from "../parts/Remarks";
import { formatTime, sentence } from "../parts/format";
import { interpolate } from "../../texts/interpolate";
import { DocumentValidity } from "../parts/DocumentValidity";
import { Plot } from "./Plot";
import { reportIn, type View } from "./report";

interface CalibrationReportProps {
  caseId: string;
  calibration: DocumentMessage;
  gate: CalibrationConfig;
  /** Identifies a calibration that was just made here. */
  fresh: string | null;
}

/** Calibration of the case: values with limits, warnings, plots and views. */
export function CalibrationReport({ caseId, calibration, gate, fresh }: CalibrationReportProps): ReactNode {
  const all = useTexts();
  const texts = all.camera;
  const report = reportIn(calibration.content);
  const used = report.views.filter((one) => one.used).length;
  return (
    <Card title={texts.reportTitle} testId="calibration" fresh={fresh}>
      <DocumentValidity heading={calibration.heading} documents={[]} />
      <p className="soft">
        {formatTime(calibration.heading.made_at, all.language)} · <Maker of={calibration.heading} /> ·{" "}
        {report.sizePx.join(" × ")} px
      </p>
      <dl className="measures">
        <Measure
          name={texts.rms}
          value={report.rmsPx}
          unit="px"
          limit={{ kind: "max", value: gate.max_rms_px }}
          testId="calibration-rms"
        />
        <Measure name={texts.noise} value={report.noisePx} unit="px" />
        <Measure
          name={texts.cells}
          value={report.cellsRatio === null ? null : 100 * report.cellsRatio}
          unit="%"
          decimals={0}
        />
      </dl>
      <Remarks remarks={report.warnings} />
      <details className="more">
        <summary>{texts.parameters}</summary>
        <Table.ScrollContainer minWidth={420}>
          <Table>
            <Table.Thead>
              <Table.Tr>
                <Table.Th scope="col">{texts.parameter}</Table.Th>
                <Table.Th scope="col">{texts.value}</Table.Th>
                <Table.Th scope="col">{texts.interval}</Table.Th>
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {report.parameters.map((one) => (
                <Table.Tr key={one.name}>
                  <Table.Th scope="row">{one.name}</Table.Th>
                  <Table.Td className="figure">{formatFigure(one.value, 4)}</Table.Td>
                  <Table.Td className="figure">
                    {formatFigure(one.low95, 4)} … {formatFigure(one.high95, 4)}
                  </Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </Table.ScrollContainer>
        {report.model !== "" && <p className="soft">{sentence(report.model)}</p>}
      </details>
      <details className="more">
        <summary>{interpolate(texts.viewsUsed, { used, all: report.views.length })}</summary>
        <Views views={report.views} />
      </details>
      <details className="more">
        <summary>{texts.pictures}</summary>
        {report.plots.map(([name, file]) => (
          <Plot key={file} caseId={caseId} file={file} name={texts.plots[name] ?? name} />
        ))}
      </details>
    </Card>
  );
}

function Views({ views }: { views: readonly View[] }): ReactNode {
  const texts = useTexts().camera;
  return (
    <ul className="rows">
      {views.map((one) => (
        <li key={one.image} className="row">
          <span className="grow">
            {one.used ? "✓" : "✕"} {one.image}
          </span>
          <span className="soft">
            {formatFigure(one.rmsPx, 2)} px · {one.points ?? "—"} {texts.points}
            {one.reason !== "" && ` · ${one.reason}`}
          </span>
        </li>
      ))}
    </ul>
  );
}

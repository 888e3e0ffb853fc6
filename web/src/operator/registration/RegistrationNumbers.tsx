import type { ReactNode } from "react";
import { formatNumber } from "../../live/rounding";
import type { RegistrationMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { interpolate } from "../../texts/interpolate";
import { Measure } from "./Measure";

type Registration = RegistrationMessage;

interface RegistrationNumbersProps {
  method: Registration["method"];
  numbers: Registration["numbers"];
}

/** Values of a registration with limits, and in words what it cannot determine. */
export function RegistrationNumbers({ method, numbers }: RegistrationNumbersProps): ReactNode {
  const texts = useTexts().registration.numbers;
  const of = (name: string): number | null => {
    const value = numbers[name];
    return typeof value === "number" ? value : null;
  };
  const target = (
    <Measure
      name={texts.atEntry}
      hint={texts.atEntryHint}
      value={of("tre_at_entry_mm")}
      unit="mm"
      max={of("max_tre_mm")}
    />
  );
  switch (method) {
    case "needles":
      return (
        <>
          <dl className="limits">
            {target}
            <Measure
              name={texts.worstOffset}
              hint={texts.worstOffsetHint}
              value={of("worst_offset_mm")}
              unit="mm"
            />
            <Measure name={texts.worstOffsetPx} value={of("worst_offset_px")} unit="px" digits={1} />
          </dl>
          <ul className="said" data-testid="needles-said">
            <li>{interpolate(texts.depthSaid, { mm: formatNumber(of("depth_sd_mm"), 1) })}</li>
            <li>{interpolate(texts.acrossSaid, { mm: formatNumber(of("across_sd_mm"), 1) })}</li>
            <li>{interpolate(texts.tiltSaid, { deg: formatNumber(of("tilt_sd_deg"), 1) })}</li>
            <li>{interpolate(texts.turnSaid, { deg: formatNumber(of("turn_sd_deg"), 1) })}</li>
          </ul>
        </>
      );
    case "points":
      return (
        <dl className="limits">
          {target}
          <Measure
            name={texts.fre}
            hint={texts.freHint}
            value={of("fre_rms_mm")}
            unit="mm"
            max={of("max_fre_mm")}
          />
          <Measure
            name={texts.leftOut}
            hint={texts.leftOutHint}
            value={of("leave_one_out_mm")}
            unit="mm"
            max={of("max_left_out_mm")}
          />
        </dl>
      );
    case "surface":
      return (
        <dl className="limits">
          {target}
          <Measure
            name={texts.rms}
            hint={texts.rmsHint}
            value={of("rms_mm")}
            unit="mm"
            max={of("max_rms_mm")}
          />
          <Measure name={texts.movedMm} value={of("moved_mm")} unit="mm" />
          <Measure name={texts.movedDeg} value={of("moved_deg")} unit="°" />
          <Measure name={texts.weakest} value={of("weakest_sd_mm")} unit="mm" />
        </dl>
      );
    case "rehearsal":
      return <dl className="limits">{target}</dl>;
  }
}

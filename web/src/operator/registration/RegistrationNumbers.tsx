import type { ReactNode } from "react";
import { shownNumber } from "../../live/rounding";
import type { components } from "../../schema";
import { useWords } from "../../words/WordsContext";
import { filled } from "../../words/filled";
import { Measure } from "./Measure";

type Registration = components["schemas"]["RegistrationMessage"];

interface RegistrationNumbersProps {
  method: Registration["method"];
  numbers: Registration["numbers"];
}

/** What a registration states of itself, with what is allowed, and in words what it cannot see. */
export function RegistrationNumbers({ method, numbers }: RegistrationNumbersProps): ReactNode {
  const words = useWords().registration.numbers;
  const of = (name: string): number | null => {
    const value = numbers[name];
    return typeof value === "number" ? value : null;
  };
  const target = (
    <Measure
      name={words.atEntry}
      hint={words.atEntryHint}
      value={of("tre_at_entry_mm")}
      unit="mm"
      most={of("max_tre_mm")}
    />
  );
  if (method === "needles")
    return (
      <>
        <dl className="limits">
          {target}
          <Measure
            name={words.worstOffset}
            hint={words.worstOffsetHint}
            value={of("worst_offset_mm")}
            unit="mm"
          />
          <Measure name={words.worstOffsetPx} value={of("worst_offset_px")} unit="px" digits={1} />
        </dl>
        <ul className="said" data-testid="needles-said">
          <li>{filled(words.depthSaid, { mm: shownNumber(of("depth_sd_mm"), 1) })}</li>
          <li>{filled(words.acrossSaid, { mm: shownNumber(of("across_sd_mm"), 1) })}</li>
          <li>{filled(words.tiltSaid, { deg: shownNumber(of("tilt_sd_deg"), 1) })}</li>
          <li>{filled(words.turnSaid, { deg: shownNumber(of("turn_sd_deg"), 1) })}</li>
        </ul>
      </>
    );
  if (method === "points")
    return (
      <dl className="limits">
        {target}
        <Measure
          name={words.fre}
          hint={words.freHint}
          value={of("fre_rms_mm")}
          unit="mm"
          most={of("max_fre_mm")}
        />
        <Measure
          name={words.leftOut}
          hint={words.leftOutHint}
          value={of("leave_one_out_mm")}
          unit="mm"
          most={of("max_left_out_mm")}
        />
      </dl>
    );
  if (method === "surface")
    return (
      <dl className="limits">
        {target}
        <Measure
          name={words.rms}
          hint={words.rmsHint}
          value={of("rms_mm")}
          unit="mm"
          most={of("max_rms_mm")}
        />
        <Measure name={words.movedMm} value={of("moved_mm")} unit="mm" />
        <Measure name={words.movedDeg} value={of("moved_deg")} unit="°" />
        <Measure name={words.weakest} value={of("weakest_sd_mm")} unit="mm" />
      </dl>
    );
  return <dl className="limits">{target}</dl>;
}

import type { ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import { Measure } from "../parts/Measure";
import { sentence } from "../parts/shown";
import type { Gathered, ToolGate } from "./kept";

const KINDS = ["not_seen", "too_uncertain", "jumped", "nothing_new"] as const;

/** The numbers of a gathering against the gate, and how many images were passed over and why. */
export function GatheringMeasures({ gathered, gate }: { gathered: Gathered; gate: ToolGate }): ReactNode {
  const texts = useTexts().tool;
  const { outcome, purpose } = gathered;
  const tilt = { kind: "least", value: gate.min_tilt_deg } as const;
  const rms = { kind: "most", value: gate.max_rms_3d_mm } as const;
  const passedOver = KINDS.filter((kind) => (gathered.rejected_images[kind] ?? 0) > 0);
  return (
    <>
      <dl className="measures">
        <Measure
          name={texts.poses}
          value={gathered.taken}
          unit=""
          decimals={0}
          limit={{ kind: "least", value: gate.min_poses }}
          bar
          testId="poses"
        />
        {purpose === "spin" ? (
          <Measure
            name={texts.spinRange}
            value={gathered.spin_range_deg}
            unit="°"
            decimals={0}
            limit={{ kind: "least", value: gate.min_spin_deg }}
            bar
          />
        ) : (
          <>
            <Measure
              name={texts.tilt}
              value={gathered.tilt_range_deg}
              unit="°"
              decimals={0}
              limit={tilt}
              bar
            />
            <Measure
              name={texts.tiltAcross}
              value={gathered.tilt_range_across_deg}
              unit="°"
              decimals={0}
              limit={tilt}
              bar
            />
          </>
        )}
        {purpose === "spin" ? (
          <>
            <Measure
              name={texts.axisSd}
              value={outcome?.axis_sd_deg ?? null}
              unit="°"
              limit={{ kind: "most", value: gate.max_axis_sd_deg }}
            />
            <Measure
              name={texts.wobble}
              value={outcome?.wobble_deg ?? null}
              unit="°"
              limit={{ kind: "most", value: gate.max_wobble_deg }}
            />
          </>
        ) : (
          <Measure
            name={texts.tipRms}
            value={outcome?.rms_3d_mm ?? null}
            unit="mm"
            limit={rms}
            testId="rms"
          />
        )}
        {purpose === "pivot" && (
          <Measure
            name={texts.tipSd}
            value={outcome?.tip_sd_mm ?? null}
            unit="mm"
            limit={{ kind: "most", value: gate.max_tip_sd_mm }}
          />
        )}
        {purpose === "tip_check" && (
          <Measure name={texts.checkMost} value={outcome?.max_mm ?? null} unit="mm" />
        )}
      </dl>
      {gathered.outcome_problem !== null && gathered.taken > 0 && (
        <p className="soft">{sentence(gathered.outcome_problem.message)}</p>
      )}
      {passedOver.length > 0 && (
        <p className="soft">
          {texts.passedOver}:{" "}
          {passedOver
            .map((kind) => `${texts.passed[kind]} ${String(gathered.rejected_images[kind] ?? 0)}`)
            .join(" · ")}
        </p>
      )}
    </>
  );
}

import type { ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import { Measure } from "../parts/Measure";
import { sentence } from "../parts/format";
import type { PoseCollectionState, ToolGate } from "./toolRecord";

const KINDS = ["not_seen", "too_uncertain", "jumped", "nothing_new"] as const;

/** Values of a collection with limits. */
export function PoseCollectionMeasures({
  collection,
  gate,
}: {
  collection: PoseCollectionState;
  gate: ToolGate;
}): ReactNode {
  const texts = useTexts().tool;
  const { outcome, purpose } = collection;
  const tilt = { kind: "min", value: gate.min_tilt_deg } as const;
  const rms = { kind: "max", value: gate.max_rms_3d_mm } as const;
  return (
    <>
      <dl className="measures">
        <Measure
          name={texts.poses}
          value={collection.taken}
          unit=""
          decimals={0}
          limit={{ kind: "min", value: gate.min_poses }}
          bar
          testId="poses"
        />
        {purpose === "spin" ? (
          <Measure
            name={texts.spinRange}
            value={collection.spin_range_deg}
            unit="°"
            decimals={0}
            limit={{ kind: "min", value: gate.min_spin_deg }}
            bar
          />
        ) : (
          <>
            <Measure
              name={texts.tilt}
              value={collection.tilt_range_deg}
              unit="°"
              decimals={0}
              limit={tilt}
              bar
            />
            <Measure
              name={texts.tiltAcross}
              value={collection.tilt_range_across_deg}
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
              limit={{ kind: "max", value: gate.max_axis_sd_deg }}
            />
            <Measure
              name={texts.wobble}
              value={outcome?.wobble_deg ?? null}
              unit="°"
              limit={{ kind: "max", value: gate.max_wobble_deg }}
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
            limit={{ kind: "max", value: gate.max_tip_sd_mm }}
          />
        )}
        {purpose === "tip_check" && (
          <Measure name={texts.checkMax} value={outcome?.max_mm ?? null} unit="mm" />
        )}
      </dl>
      {collection.outcome_problem !== null && collection.taken > 0 && (
        <p className="soft">{sentence(collection.outcome_problem.message)}</p>
      )}
    </>
  );
}

/** Images that gave no pose, by reason. */
export function UnusedImages({ collection }: { collection: PoseCollectionState }): ReactNode {
  const texts = useTexts().tool;
  const kinds = KINDS.filter((kind) => (collection.rejected_images[kind] ?? 0) > 0);
  if (kinds.length === 0) return null;
  return (
    <p className="soft">
      {texts.passedOver}:{" "}
      {kinds
        .map((kind) => `${texts.passed[kind]} ${String(collection.rejected_images[kind] ?? 0)}`)
        .join(" · ")}
    </p>
  );
}

import type { ReactNode } from "react";
import { formatNumber } from "../../live/rounding";
import type { CheckRuleMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { useProcedure } from "../../app/procedure";
import { useIntoView } from "../parts/useIntoView";
import { interpolate } from "../../texts/interpolate";
import { minutesLeft } from "./due";

interface CheckDueProps {
  rule: CheckRuleMessage;
  /** Identifies a check that was just saved here. */
  fresh: string | null;
}

/** Result of the last check, and when the next is due. */
export function CheckDue({ rule, fresh }: CheckDueProps): ReactNode {
  const texts = useTexts().check;
  const step = useProcedure().data?.steps.find((one) => one.step === "check");
  const left = minutesLeft(step?.numbers["age_min"], rule.again_after_min);
  const every = interpolate(texts.every, {
    minutes: rule.again_after_min,
    max: formatNumber(rule.max_mm, 1),
  });
  const text = useIntoView<HTMLParagraphElement>(fresh);
  if (step?.state === "due")
    return (
      <p className="warning" ref={text}>
        ▲ {texts.dueNow}
      </p>
    );
  if (step?.state === "failed")
    return (
      <p className="warning" role="status" data-testid="check-failed" ref={text}>
        ▲▲ {texts.lastFailed} {every}
      </p>
    );
  return (
    <p className="quiet" data-testid="check-due" ref={text}>
      {step?.state === "done" && left !== null
        ? `${interpolate(texts.dueIn, { minutes: formatNumber(left, 0) })} ${every}`
        : every}
    </p>
  );
}

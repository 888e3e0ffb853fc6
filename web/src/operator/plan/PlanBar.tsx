import { Alert, Button } from "@mantine/core";
import type { ReactNode } from "react";
import { putPlan } from "../../api";
import { RejectionNote } from "../../rest/RejectionNote";
import { useTexts } from "../../texts/TextsContext";
import { Maker } from "../parts/Maker";
import { PartTabs } from "./PartTabs";
import { usePlanning } from "./state/PlanContext";
import { UndoRedo } from "./UndoRedo";

/** Tabs, undo and redo, and conflicts of the plan. */
export function PlanBar(): ReactNode {
  const texts = useTexts().plan.bar;
  const { plan, planRejection, rejection, conflict, change, busy, forget } = usePlanning();
  const heading = plan?.heading ?? null;
  const isOld = heading !== null && !heading.current;
  const put = (content: Record<string, unknown>): void => {
    void change((by) => putPlan({ body: { ...by, plan: content } }));
  };
  return (
    <div className="plan-bar">
      <div className="plan-bar-row">
        <PartTabs />
        <UndoRedo />
      </div>
      <RejectionNote rejection={planRejection} />
      {isOld && (
        <Alert className="consequence" title={texts.old.title} data-testid="plan-old">
          <p>{texts.old.sentence}</p>
          <div className="buttons">
            <Button
              size="lg"
              disabled={busy}
              onClick={() => {
                put(plan?.plan ?? {});
              }}
            >
              {texts.old.take}
            </Button>
            <Button
              size="lg"
              variant="default"
              disabled={busy}
              data-testid="begin-anew"
              onClick={() => {
                put({ format_version: plan?.plan["format_version"], vertebrae: [] });
              }}
            >
              {texts.old.anew}
            </Button>
          </div>
        </Alert>
      )}
      {conflict !== null && (
        <Alert
          className="consequence"
          role="alert"
          title={texts.conflict.title}
          data-testid="conflict"
          withCloseButton
          closeButtonLabel={texts.close}
          onClose={forget}
        >
          {texts.conflict.by} <Maker of={conflict} /> · {texts.version} {conflict.version}.{" "}
          {texts.conflict.sentence}
        </Alert>
      )}
      {conflict === null && <RejectionNote rejection={rejection} />}
    </div>
  );
}

import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { getRehearsal } from "../../../api";
import { RejectionNote } from "../../../rest/RejectionNote";
import { useRehearsal } from "../../../rest/useRehearsal";
import { useAction } from "../../../rest/useAction";
import { useTexts } from "../../../texts/TextsContext";
import { vec3 } from "../slices/vectors";
import type { Landmark } from "../state/shape";

/** In a rehearsal: uses the landmarks that its drill touches. */
export function RehearsedLandmarks({
  busy,
  onTake,
}: {
  busy: boolean;
  onTake: (landmarks: Landmark[]) => void;
}): ReactNode {
  const texts = useTexts().plan.landmarks;
  const query = useRehearsal();
  const action = useAction();
  if (query.data === null) return null;
  const take = (): void => {
    void action.run(async () => {
      const rehearsal = await getRehearsal({ query: { truth: true } });
      if (rehearsal.truth === null) return;
      const all = [...rehearsal.truth.landmarks, rehearsal.truth.check_landmark];
      onTake(all.map((one) => ({ name: one.name, point_lps_mm: vec3(one.point_lps_mm) ?? [0, 0, 0] })));
    });
  };
  return (
    <div className="rehearsal-offer">
      <p>{texts.rehearsal}</p>
      <Button
        size="lg"
        variant="default"
        disabled={busy || action.busy}
        data-testid="rehearsed-landmarks"
        onClick={take}
      >
        {texts.takeRehearsed}
      </Button>
      <RejectionNote rejection={action.rejection} />
    </div>
  );
}

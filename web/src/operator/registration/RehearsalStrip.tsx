import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { useRehearsal, type Rehearsed } from "../../rest/useRehearsal";
import { putRehearsal, type SceneRequest } from "../../api";
import { useTexts } from "../../texts/TextsContext";

type Scene = SceneRequest["scene"];

const ASK_EVERY_MS = 400;

interface RehearsalStripProps {
  scenes: readonly Scene[];
  /** Additional state known only in a rehearsal. */
  children?: (rehearsal: Rehearsed) => ReactNode;
}

/** In a rehearsal: the scene for this step, so that it can be done without hardware. */
export function RehearsalStrip({ scenes, children }: RehearsalStripProps): ReactNode {
  const all = useTexts();
  const texts = all.registration.rehearsal;
  const { data, refetch } = useRehearsal({ everyMs: ASK_EVERY_MS, truth: true });
  const playing = useAction();
  if (data === null) return null;
  return (
    <aside className="rehearsal" aria-label={texts.title} data-testid="rehearsal" data-begun={data.begun}>
      <p>
        <strong>{texts.title}</strong> <small>{texts.hint}</small>
      </p>
      <div className="row">
        {scenes.map((scene) => (
          <Button
            key={scene}
            size="md"
            variant={data.scene === scene ? "filled" : "default"}
            aria-pressed={data.scene === scene}
            loading={playing.busy && data.scene !== scene}
            data-testid={`scene-${scene}`}
            onClick={() => {
              void playing
                .run(async () => {
                  await putRehearsal({ body: { scene, skill: null, events: data.events } });
                })
                .then(refetch);
            }}
          >
            {all.case.rehearsal.scenes[scene]}
          </Button>
        ))}
        {children?.(data)}
      </div>
      <RejectionNote rejection={playing.rejection} />
    </aside>
  );
}

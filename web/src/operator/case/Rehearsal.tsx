import { Button, Select } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { useRehearsal } from "../../rest/useRehearsal";
import { putRehearsal, type SceneRequest } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";

type Wish = SceneRequest;
type Scene = Wish["scene"];
type Skill = NonNullable<Wish["skill"]>;
type Board = NonNullable<Wish["board"]>;
interface Played {
  scene: Scene;
  skill: Skill;
  board: Board;
}

const SCENES: readonly Scene[] = ["board", "pivot", "spin", "landmarks", "sweep", "check", "operation"];

const ASK_EVERY_MS = 1500;

/** Choice of the played scene; shown only with the simulated theatre. */
export function Rehearsal(): ReactNode {
  const texts = useTexts().case.rehearsal;
  const query = useRehearsal({ everyMs: ASK_EVERY_MS });
  // The new choice, until the server reports it.
  const [wish, setWish] = useState<Partial<Played>>({});
  const playing = useAction();
  const { data, refetch } = query;
  if (data === null) return <RejectionNote rejection={query.rejection} />;
  // Strings in the answer; they are valid choices, since they were sent as such.
  const played: Played = {
    scene: data.scene as Scene,
    skill: data.skill as Skill,
    board: data.board as Board,
    ...wish,
  };
  const play = (chosen: Partial<Played>): void => {
    setWish(chosen);
    void playing
      .run(async () => {
        const body = { ...played, ...chosen, events: [] };
        await putRehearsal({ body });
      })
      .then(() => {
        refetch();
        setWish({});
      });
  };
  return (
    <Card
      title={texts.title}
      testId="rehearsal"
      aside={<span className="badge-rehearsal">{texts.badge}</span>}
    >
      <p>{texts.lead}</p>
      <div className="row" role="group" aria-label={texts.scene}>
        {SCENES.map((scene) => (
          <Button
            key={scene}
            size="lg"
            variant={played.scene === scene ? "filled" : "default"}
            aria-pressed={played.scene === scene}
            data-testid={`scene-${scene}`}
            disabled={playing.busy}
            onClick={() => {
              play({ scene });
            }}
          >
            {texts.scenes[scene]}
          </Button>
        ))}
      </div>
      <p className="soft" role="status" data-begun={data.begun}>
        {data.begun ? texts.sceneLeads[played.scene] : texts.coming}
      </p>
      <div className="row">
        <Select
          size="lg"
          label={texts.skill}
          allowDeselect={false}
          data={Object.entries(texts.skills).map(([value, label]) => ({ value, label }))}
          value={played.skill}
          disabled={playing.busy}
          data-testid="skill"
          onChange={(value) => {
            play({ skill: value as Skill });
          }}
        />
        <Select
          size="lg"
          label={texts.board}
          allowDeselect={false}
          data={Object.entries(texts.boards).map(([value, label]) => ({ value, label }))}
          value={played.board}
          disabled={playing.busy}
          data-testid="rehearsed-board"
          onChange={(value) => {
            play({ board: value as Board });
          }}
        />
      </div>
      <p className="soft">{texts.atOnce}</p>
      <RejectionNote rejection={playing.rejection} />
    </Card>
  );
}

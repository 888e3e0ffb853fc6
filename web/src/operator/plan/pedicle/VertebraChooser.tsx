import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postPlanVertebrae } from "../../../api";
import { Dialog } from "../../../panes/Dialog";
import { useTexts } from "../../../texts/TextsContext";
import { usePlanning } from "../state/PlanContext";

const range = (letter: string, last: number): string[] =>
  Array.from({ length: last }, (_, i) => `${letter}${i + 1}`);
const LEVELS = [range("C", 7), range("T", 12), range("L", 5), ["S1"]];

/** Choice of the vertebra, and of a level to add. */
export function VertebraChooser(): ReactNode {
  const texts = useTexts().plan.vertebra;
  const { vertebrae, vertebra, setVertebra, change, busy } = usePlanning();
  const [isAdding, setAdding] = useState(false);
  const add = (name: string): void => {
    setAdding(false);
    void change((by) => postPlanVertebrae({ body: { ...by, name } })).then((made) => {
      if (made) setVertebra(name);
    });
  };
  return (
    <div className="vertebrae" role="group" aria-label={texts.title}>
      {vertebrae.map((one) => (
        <button
          key={one.name}
          type="button"
          className="chip"
          aria-pressed={one === vertebra}
          data-testid={`vertebra-${one.name}`}
          onClick={() => {
            setVertebra(one.name);
          }}
        >
          {one.name}
        </button>
      ))}
      <button
        type="button"
        className="chip chip-add"
        disabled={busy}
        data-testid="add-vertebra"
        onClick={() => {
          setAdding(true);
        }}
      >
        + {texts.add}
      </button>
      <Dialog
        opened={isAdding}
        onClose={() => {
          setAdding(false);
        }}
        title={texts.which}
        size="lg"
        closeButtonProps={{ size: 48, "aria-label": texts.close }}
      >
        {LEVELS.map((levels) => (
          <div key={levels[0]} className="levels">
            {levels.map((name) => (
              <Button
                key={name}
                size="lg"
                variant="default"
                px={0}
                disabled={vertebrae.some((one) => one.name === name)}
                data-testid={`level-${name}`}
                onClick={() => {
                  add(name);
                }}
              >
                {name}
              </Button>
            ))}
          </div>
        ))}
      </Dialog>
    </div>
  );
}

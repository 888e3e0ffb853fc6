import { Button } from "@mantine/core";
import { useEffect, useEffectEvent, type ReactNode } from "react";
import { Icon } from "../../panes/Icon";
import { useTexts } from "../../texts/TextsContext";
import { usePlanning } from "./state/PlanContext";
import { historyKey, isTyping } from "./state/undo";
import { useWork } from "./state/WorkContext";

/** Undo and redo, also by Ctrl+Z, Ctrl+Shift+Z and Ctrl+Y while nobody types. */
export function UndoRedo(): ReactNode {
  const texts = useTexts().plan.bar;
  const { canUndo, undo, canRedo, redo } = usePlanning();
  const { setDraft } = useWork();
  const ways = {
    undo: { label: texts.undo, can: canUndo, act: undo },
    redo: { label: texts.redo, can: canRedo, act: redo },
  };
  const take = (way: "undo" | "redo"): void => {
    setDraft(null);
    ways[way].act();
  };
  const onKey = useEffectEvent((event: KeyboardEvent): void => {
    const way = historyKey(event);
    if (way === null || isTyping(event.target)) return;
    event.preventDefault();
    // A key that is held would undo one stored version after another.
    if (ways[way].can && !event.repeat) take(way);
  });
  useEffect(() => {
    const listener = (event: KeyboardEvent): void => {
      onKey(event);
    };
    addEventListener("keydown", listener);
    return () => {
      removeEventListener("keydown", listener);
    };
  }, []);
  return (
    <div className="undo-redo">
      {(["undo", "redo"] as const).map((way) => (
        <Button
          key={way}
          size="lg"
          variant="default"
          disabled={!ways[way].can}
          aria-label={ways[way].label}
          title={ways[way].label}
          data-testid={way}
          onClick={() => {
            take(way);
          }}
        >
          <Icon name={way} />
        </Button>
      ))}
    </div>
  );
}

import { useState, type ReactNode } from "react";
import { AfterFirstMessage } from "../live/AfterFirstMessage";
import { LoadingPane } from "../panes/LoadingPane";
import { ScenePane } from "../panes/ScenePane";
import { useTexts } from "../texts/TextsContext";
import { CutPane } from "./CutPane";
import { choicesOf, FIRST_CHOICE, hasPlane, switched, type TileChoice, type TileName } from "./tileChoice";

interface CutTileProps {
  name: TileName;
  choices?: readonly TileName[];
  choice: TileChoice;
  onChoose: (choice: TileChoice) => void;
  /** Whether the planes can be chosen here. */
  hasKind?: boolean;
}

/** One cut or the 3-D scene, with a choice of alternatives. */
export function CutTile({ name, choices = [], choice, onChoose, hasKind = false }: CutTileProps): ReactNode {
  const texts = useTexts();
  const t = texts.theatre.cuts;
  const tabs = choices.length > 0 && (
    <div className="tile-tabs" role="group" aria-label={t.tabs}>
      {choices.map((one) => (
        <button
          key={one}
          type="button"
          aria-pressed={one === name}
          data-testid={`tile-${one}`}
          onClick={() => {
            onChoose({ ...choice, name: one });
          }}
        >
          {one === "scene" ? texts.scene.title : t.short[one]}
        </button>
      ))}
    </div>
  );
  const kind = hasKind && (
    <button
      type="button"
      aria-pressed={choice.isAnatomical}
      data-testid="tile-anatomical"
      onClick={() => {
        onChoose(switched(choice));
      }}
    >
      {t.anatomical}
    </button>
  );
  if (name === "scene") return <ScenePane tabs={tabs} />;
  return (
    <AfterFirstMessage loading={<LoadingPane id={`cut-${name}`} title={t.title[name]} />}>
      <CutPane key={name} name={name} tabs={tabs} tools={kind} />
    </AfterFirstMessage>
  );
}

interface OnlyTileProps {
  choice: TileChoice;
  onChoose: (choice: TileChoice) => void;
}

/** The only tile of a small page, with all alternatives. */
export function OnlyTile({ choice, onChoose }: OnlyTileProps): ReactNode {
  return (
    <div className="tiles tiles-one">
      <CutTile
        name={choice.name}
        choices={choicesOf(choice)}
        choice={choice}
        onChoose={onChoose}
        hasKind={hasPlane(choice)}
      />
    </div>
  );
}

/** The same, starting with the probe's eye. */
export function ChosenTile(): ReactNode {
  const [choice, setChoice] = useState(FIRST_CHOICE);
  return <OnlyTile choice={choice} onChoose={setChoice} />;
}

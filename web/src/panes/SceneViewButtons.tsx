import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import { VIEWS, type ViewName } from "./sceneFrame";

interface SceneViewButtonsProps {
  chosen: ViewName;
  onView: (view: ViewName) => void;
}

/** Viewpoints of a 3-D scene. */
export function SceneViewButtons({ chosen, onView }: SceneViewButtonsProps): ReactNode {
  const texts = useTexts();
  return (
    <div className="scene-views" role="group" aria-label={texts.scene.views}>
      {VIEWS.map((name) => (
        <button
          key={name}
          type="button"
          aria-pressed={name === chosen}
          data-testid={`view-${name}`}
          onClick={() => {
            onView(name);
          }}
        >
          {texts.scene.view[name]}
        </button>
      ))}
    </div>
  );
}

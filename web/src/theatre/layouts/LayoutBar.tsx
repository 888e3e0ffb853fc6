import type { ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import { LAYOUTS } from "./layout";
import type { Layouts } from "./useLayouts";

/** Chooses the layout by one touch with a glove, or lets it follow the drill. */
export function LayoutBar({ layouts }: { layouts: Layouts }): ReactNode {
  const texts = useTexts().theatre.layouts;
  return (
    <div className="layout-bar" role="group" aria-label={texts.title}>
      {LAYOUTS.map((layout) => (
        <button
          key={layout}
          type="button"
          aria-pressed={layout === layouts.layout}
          data-testid={`layout-${layout}`}
          onClick={() => {
            layouts.choose(layout);
          }}
        >
          {texts.name[layout]}
        </button>
      ))}
      <button
        type="button"
        className="layout-automatic"
        aria-pressed={layouts.isAutomatic}
        data-testid="layout-automatic"
        onClick={() => {
          layouts.setAutomatic(!layouts.isAutomatic);
        }}
      >
        {texts.automatic} {layouts.isAutomatic ? texts.on : texts.off}
      </button>
    </div>
  );
}

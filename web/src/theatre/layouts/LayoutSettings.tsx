import { useEffect, useEffectEvent, useState, type ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import { isFiguresScreen, screenAddress } from "./layout";
import { isAssignable, KEY_ACTIONS, withKey, withoutKey, type KeyAction } from "./keys";
import type { Layouts } from "./useLayouts";

/** Keys of the layouts, and the screen with figures only. */
export function LayoutSettings({ layouts }: { layouts: Layouts }): ReactNode {
  const texts = useTexts().theatre.layouts;
  const [waiting, setWaiting] = useState<KeyAction | null>(null);
  const isFigures = isFiguresScreen(location.search);
  return (
    <section className="layout-settings" aria-labelledby="layout-settings">
      <h2 id="layout-settings">{texts.title}</h2>
      <p>
        {isFigures ? (
          <a href={screenAddress(location.search, "theatre")}>{texts.theatreScreen}</a>
        ) : (
          <a href={screenAddress(location.search, "figures")} target="_blank" data-testid="figures-screen">
            {texts.figuresScreen}
          </a>
        )}
      </p>
      {!isFigures && (
        <>
          <p className="quiet">{texts.keysHint}</p>
          <ul>
            {KEY_ACTIONS.map((action) => (
              <li key={action} data-testid={`key-${action}`}>
                <span>{action === "next" ? texts.next : texts.name[action]}</span>
                <kbd>{layouts.keys[action] ?? texts.noKey}</kbd>
                <button
                  type="button"
                  aria-pressed={waiting === action}
                  onClick={() => {
                    setWaiting(waiting === action ? null : action);
                  }}
                >
                  {waiting === action ? texts.pressKey : texts.setKey}
                </button>
                {layouts.keys[action] !== undefined && (
                  <button
                    type="button"
                    onClick={() => {
                      layouts.setKeys(withoutKey(layouts.keys, action));
                    }}
                  >
                    {texts.removeKey}
                  </button>
                )}
              </li>
            ))}
          </ul>
        </>
      )}
      {waiting !== null && (
        <NextKey
          onKey={(code) => {
            if (code !== null) layouts.setKeys(withKey(layouts.keys, waiting, code));
            setWaiting(null);
          }}
        />
      )}
    </section>
  );
}

/** Takes the next key that may be set, before anything else does; Escape ends the wait. */
function NextKey({ onKey }: { onKey: (code: string | null) => void }): null {
  const take = useEffectEvent(onKey);
  useEffect(() => {
    const onDown = (event: KeyboardEvent): void => {
      if (event.code === "Tab") return;
      event.preventDefault();
      event.stopPropagation();
      if (event.code === "Escape") take(null);
      else if (isAssignable(event)) take(event.code);
    };
    addEventListener("keydown", onDown, { capture: true });
    return () => {
      removeEventListener("keydown", onDown, { capture: true });
    };
  }, []);
  return null;
}

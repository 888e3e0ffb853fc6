// The layout of this screen: chosen by a touch, by a key, or by the position of the drill.
import { useEffect, useEffectEvent, useState } from "react";
import { alarmsVerdict } from "../../alarms/verdict";
import { usePainter } from "../../live/LiveContext";
import { layoutInAddress, type Layout } from "./layout";
import { layoutByKey, type Keys } from "./keys";
import { PhaseDetector } from "./phase";
import { storedLayout, storeLayout, type LayoutChoice } from "./storedLayout";

export interface Layouts {
  layout: Layout;
  isAutomatic: boolean;
  keys: Keys;
  /** Shows a layout; it no longer follows the drill. */
  choose: (layout: Layout) => void;
  setAutomatic: (isAutomatic: boolean) => void;
  setKeys: (keys: Keys) => void;
}

/** @param hasLayouts whether this screen has them; another one follows nothing and takes no keys. */
export function useLayouts(hasLayouts: boolean): Layouts {
  const [choice, setChoice] = useState(() => {
    const stored = storedLayout();
    const layout = layoutInAddress(location.search);
    return layout === null ? stored : { ...stored, layout, isAutomatic: false };
  });
  const [detector] = useState(() => new PhaseDetector());
  const change = (changes: Partial<LayoutChoice>): void => {
    const next = { ...choice, ...changes };
    storeLayout(next);
    setChoice(next);
  };
  const choose = (layout: Layout): void => {
    change({ layout, isAutomatic: false });
  };

  usePainter((view) => {
    if (!hasLayouts || !choice.isAutomatic) return;
    const alarms = alarmsVerdict(view, view.firstMessage === "received");
    const layout = detector.update({ ...view, alarms }, choice.layout);
    if (layout !== null) change({ layout });
  });
  useKeys((event) => {
    const layout = hasLayouts ? layoutByKey(event, choice.keys, choice.layout) : null;
    if (layout !== null) choose(layout);
    return layout !== null;
  });

  return {
    ...choice,
    choose,
    setAutomatic: (isAutomatic) => {
      change({ isAutomatic });
    },
    setKeys: (keys) => {
      change({ keys });
    },
  };
}

/** Calls `take` with each key that no field or dialog takes, also while the 3-D scene has the focus. */
function useKeys(take: (event: KeyboardEvent) => boolean): void {
  const onKey = useEffectEvent((event: KeyboardEvent) => {
    if (event.defaultPrevented || isTyping(event.target)) return;
    if (take(event)) event.preventDefault();
  });
  useEffect(() => {
    const stop = new AbortController();
    const options = { signal: stop.signal };
    const listened = new WeakSet<Window>();
    const listen = (to: Window): void => {
      to.addEventListener(
        "keydown",
        (event) => {
          onKey(event);
        },
        options,
      );
    };
    listen(window);
    // A frame with the focus gets the keys; the scene is of this origin.
    addEventListener(
      "blur",
      () => {
        const frame = document.activeElement;
        const scene = frame instanceof HTMLIFrameElement ? frame.contentWindow : null;
        if (scene === null || listened.has(scene)) return;
        listened.add(scene);
        listen(scene);
      },
      options,
    );
    return () => {
      stop.abort();
    };
  }, []);
}

function isTyping(target: EventTarget | null): boolean {
  return (
    target instanceof Element && target.closest("input, textarea, select, dialog, [role=dialog]") !== null
  );
}

// A click on the bone in the 3-D scene marks its point for everybody, inside a `MarkingProvider`.
import { useEffect, useEffectEvent, type RefObject } from "react";
import { useLive } from "../live/LiveContext";
import { vec3, type Vec3 } from "../operator/plan/slices/vectors";
import { markSurfaceAt } from "./cutMarks";
import { useMarking } from "./MarkingContext";

/** Listens to the scene in this frame; returns whether a click marks. */
export function useBoneMarks(frame: RefObject<HTMLIFrameElement | null>): boolean {
  const marking = useMarking();
  const { live } = useLive();
  const onPoint = useEffectEvent((point: Vec3) => {
    const view = live.update();
    const snapshot = view.newest?.snapshot ?? null;
    const ctId = snapshot?.channel?.ct_id ?? null;
    if (marking === null || snapshot === null || ctId === null || view.scene.state !== "live") return;
    marking.input.dot(markSurfaceAt(point, ctId, snapshot), performance.now());
  });
  useEffect(() => {
    const listen = ({ origin, source, data }: MessageEvent<unknown>): void => {
      if (origin !== location.origin || source !== frame.current?.contentWindow) return;
      const point = bonePoint(data);
      if (point !== null) onPoint(point);
    };
    addEventListener("message", listen);
    return () => {
      removeEventListener("message", listen);
    };
  }, [frame]);
  return marking !== null;
}

/** The point of a message of `watch.js`; null for another one. */
export function bonePoint(data: unknown): Vec3 | null {
  if (typeof data !== "object" || data === null) return null;
  const { kind, point_in_vertebra_mm } = data as Record<string, unknown>;
  return kind === "coaxial-bone-point" ? vec3(point_in_vertebra_mm) : null;
}

// What is rehearsed; asked only where the camera is the theatre in software.
import { useLive } from "../live/LiveContext";
import type { components } from "../schema";
import { answered, server } from "./client";
import { useAsked, type Asked } from "./useAsked";

type Rehearsal = components["schemas"]["RehearsalMessage"];

export function useRehearsal(): Asked<Rehearsal | null> {
  const isRehearsal = useLive().view.newest?.source.name === "rehearsal";
  return useAsked<Rehearsal | null>(
    async (signal) => (isRehearsal ? answered(server.GET("/api/rehearsal", { signal })) : null),
    { key: String(isRehearsal) },
  );
}

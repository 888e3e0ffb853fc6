import type { ReactNode } from "react";
import type { Problem } from "../rest/client";
import { QueryStatus } from "../rest/QueryStatus";
import { useTexts } from "../texts/TextsContext";
import { isHubSilent, type Heard } from "./heard";

interface HubNoteProps {
  heard: Heard | null;
  problem: Problem | null;
  nowMs: number;
}

/** Why nothing is known of the theatres: the hub does not answer, or its NATS server does not; otherwise nothing. */
export function HubNote({ heard, problem, nowMs }: HubNoteProps): ReactNode {
  const texts = useTexts().hub;
  const stated = problem ?? heard?.message.problem ?? null;
  if (heard !== null && isHubSilent(heard, nowMs) && problem === null) {
    return (
      <p className="hub-note" role="alert" data-testid="hub-note">
        ▲ {texts.silent}
      </p>
    );
  }
  if (stated !== null) {
    return (
      <p className="hub-note" role="alert" data-testid="hub-note" lang={stated.language}>
        ▲ {stated.message}. {stated.remedy}
      </p>
    );
  }
  return heard === null ? <QueryStatus query={{ rejection: null, refetch: () => undefined }} /> : null;
}

// What the page says of the alarms now. Pure: what is known and a time go in.
import { SILENT_AFTER_MS } from "../live/assess";
import type { LinkState } from "../live/viewConnection";
import type { AlarmsMessage, LiveMessage, Sound } from "../live/messages";

export interface ServerContact {
  link: LinkState;
  silentMs: number;
  newest: LiveMessage | null;
}

/** Nothing is claimed of alarms that may be over, or of silence that may not be: the server is not heard. */
export type AlarmsVerdict = { known: true; alarms: AlarmsMessage } | { known: false; everReceived: boolean };

export function alarmsVerdict(
  { link, silentMs, newest }: ServerContact,
  everReceived: boolean,
): AlarmsVerdict {
  const isConnected = link === "open" && silentMs <= SILENT_AFTER_MS;
  return isConnected && newest !== null
    ? { known: true, alarms: newest.alarms }
    : { known: false, everReceived };
}

export interface RequestedSound {
  sound: Sound;
  /** A new number begins the sound anew. */
  number: number;
}

const SILENCE: RequestedSound = { sound: "silent", number: 0 };
/** The screen's own alarm: the server that decides is not heard. It is no alarm of the server's. */
const SERVER_GONE: RequestedSound = { sound: "medium", number: -1 };
/** A line that is made anew at once is no alarm. */
export const GONE_SOUNDS_AFTER_MS = 2000;

/** What this screen, if its sound is armed, is to be heard with. */
export function requestedSound(
  verdict: AlarmsVerdict,
  goneMs: number,
  ownPauseLeftMs: number,
): RequestedSound {
  if (verdict.known) {
    const { sound, sound_number: number } = verdict.alarms;
    return sound === "silent" ? SILENCE : { sound, number };
  }
  const sounds = verdict.everReceived && goneMs > GONE_SOUNDS_AFTER_MS && ownPauseLeftMs <= 0;
  return sounds ? SERVER_GONE : SILENCE;
}

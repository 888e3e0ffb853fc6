// Which alarm state the page shows. Pure.
import { isServerHeard } from "../live/assess";
import type { LinkState } from "../live/viewConnection";
import type { AlarmsMessage, LiveMessage, Sound } from "../live/messages";

interface ServerContact {
  link: LinkState;
  silentMs: number;
  newest: LiveMessage | null;
}

/** Without the server neither alarms nor their absence are claimed. */
export type AlarmsVerdict = { known: true; alarms: AlarmsMessage } | { known: false; everReceived: boolean };

export function alarmsVerdict(contact: ServerContact, everReceived: boolean): AlarmsVerdict {
  return contact.newest !== null && isServerHeard(contact)
    ? { known: true, alarms: contact.newest.alarms }
    : { known: false, everReceived };
}

export interface RequestedSound {
  sound: Sound;
  /** A new number restarts the sound. */
  number: number;
}

const SILENCE: RequestedSound = { sound: "silent", number: 0 };
/** The screen's own alarm: the server that evaluates alarms does not answer. */
const SERVER_GONE: RequestedSound = { sound: "medium", number: -1 };
/** A connection that returns at once raises no alarm. */
const GONE_SOUNDS_AFTER_MS = 2000;

/** The sound of this screen, if it is armed. */
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

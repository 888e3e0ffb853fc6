// Alarm messages for tests.
import type { AlarmMessage, AlarmsMessage } from "./messages";

export function alarms(changes: Partial<AlarmsMessage> = {}): AlarmsMessage {
  return { revision: 0, sound: "silent", sound_number: 0, pause_left_s: 0, alarms: [], ...changes };
}

/** A present breach. */
export function alarm(changes: Partial<AlarmMessage> = {}): AlarmMessage {
  const text = (en: string) => ({ en, de: en });
  return {
    number: 1,
    condition: "BREACH",
    priority: "high",
    kind: "physiological",
    state: "active",
    presence: "yes",
    raised_at: "2026-01-01T10:00:00Z",
    raised_s_ago: 1,
    measure: { value: -0.4, limit: 0, unit: "mm" },
    site: null,
    worst: { value: -0.8, limit: 0, unit: "mm" },
    worst_at: "2026-01-01T10:00:00Z",
    worst_site: null,
    earlier_worst: null,
    earlier_worst_at: null,
    acknowledged_by: "",
    by: "",
    title: text("BREACH"),
    sentence: text("Drill 0.4 mm through the medial wall."),
    remedy: text("Stop. Withdraw the drill."),
    sentence_without_figures: text("Not tracked. Was 0.8 mm through the medial wall."),
    remedy_without_figures: text("Stop."),
    known: text(""),
    ...changes,
  };
}

import { expect, test } from "vitest";
import { alarms } from "../live/alarmBuilders";
import { message } from "../live/builders";
import { alarmsVerdict, requestedSound, type AlarmsVerdict } from "./verdict";

const ringing = alarms({ sound: "high", sound_number: 4 });
const heard = { link: "open" as const, silentMs: 100, newest: message({ alarms: ringing }) };
const gone: AlarmsVerdict = { known: false, everReceived: true };

test("the server's alarms are shown while it answers", () => {
  expect(alarmsVerdict(heard, true)).toEqual({ known: true, alarms: ringing });
  expect(alarmsVerdict({ ...heard, silentMs: 801 }, true)).toEqual(gone);
  expect(alarmsVerdict({ ...heard, link: "lost" }, true)).toEqual(gone);
  expect(alarmsVerdict({ ...heard, newest: null }, false)).toEqual({ known: false, everReceived: false });
});

test("before the first message a page has no alarms and raises none", () => {
  const loading = alarmsVerdict({ link: "lost", silentMs: 5000, newest: null }, false);
  expect(loading).toEqual({ known: false, everReceived: false });
  expect(requestedSound(loading, 60_000, 0).sound).toBe("silent");
});

test("the server's sound is played, and no other", () => {
  expect(requestedSound({ known: true, alarms: ringing }, 0, 0)).toEqual({ sound: "high", number: 4 });
  expect(requestedSound({ known: true, alarms: alarms() }, 0, 0).sound).toBe("silent");
});

test("a server that is not heard for two seconds is the screen's own alarm, which can be paused", () => {
  expect(requestedSound(gone, 1999, 0).sound).toBe("silent");
  expect(requestedSound(gone, 2001, 0).sound).toBe("medium");
  expect(requestedSound(gone, 60_000, 5000).sound).toBe("silent");
  expect(requestedSound({ known: false, everReceived: false }, 60_000, 0).sound).toBe("silent");
});

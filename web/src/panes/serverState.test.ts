import { expect, test } from "vitest";
import { alarmsVerdict } from "../alarms/verdict";
import { message } from "../live/builders";
import { Live } from "../live/live";
import { REACHED_WITHIN_MS } from "../live/firstMessage";
import { serverStateOf } from "./serverState";

function page() {
  const clock = { nowMs: 0 };
  const live = new Live(() => clock.nowMs);
  return { clock, live };
}

test.each(["connecting", "open", "lost"] as const)(
  "while a page loads, a line that is %s is connecting",
  (link) => {
    const { live, clock } = page();
    live.setLink(link);
    clock.nowMs = REACHED_WITHIN_MS;
    expect(serverStateOf(live.update())).toEqual({
      linkState: "connecting",
      source: null,
      snapshot: null,
      isOfNow: false,
    });
    clock.nowMs += 1;
    expect(serverStateOf(live.update()).linkState).toBe("not-reached");
  },
);

test("after the first message, nothing of a lost or silent server is shown", async () => {
  const { live, clock } = page();
  live.setLink("open");
  await live.receive({ message: message(), jpeg: new Uint8Array() });
  expect(serverStateOf(live.update())).toMatchObject({
    linkState: "open",
    source: { name: "rehearsal" },
    isOfNow: true,
  });
  clock.nowMs = 700;
  expect(serverStateOf(live.update()), "heard, and what stood on the page is too old").toMatchObject({
    linkState: "open",
    isOfNow: false,
  });
  clock.nowMs = 801;
  expect(serverStateOf(live.update())).toEqual({
    linkState: "late",
    source: null,
    snapshot: null,
    isOfNow: false,
  });
  live.setLink("lost");
  expect(serverStateOf(live.update()).linkState).toBe("lost");
});

test("the header says connected exactly while the alarms are known", async () => {
  const { live, clock } = page();
  const agree = (): [string, boolean] => {
    const view = live.update();
    const { linkState } = serverStateOf(view);
    const { known } = alarmsVerdict(view, true);
    expect(linkState === "open").toBe(known);
    return [linkState, known];
  };
  agree();
  live.setLink("open");
  agree();
  await live.receive({ message: message(), jpeg: new Uint8Array() });
  for (clock.nowMs = 0; clock.nowMs <= 3000; clock.nowMs += 100) agree();
  expect(agree(), "silent under load").toEqual(["late", false]);
  live.setLink("lost");
  expect(agree()).toEqual(["lost", false]);
  live.setLink("open");
  expect(agree()[0], "back, and without a message so far").not.toBe("open");
  await live.receive({ message: message({ sequence: 2 }), jpeg: new Uint8Array() });
  expect(agree()).toEqual(["open", true]);
});

import { expect, test } from "vitest";
import { message } from "../live/builders";
import { Live } from "../live/live";
import { REACHED_WITHIN_MS } from "../live/firstMessage";
import { heardOf } from "./heard";

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
    expect(heardOf(live.look())).toEqual({
      linkState: "connecting",
      source: null,
      snapshot: null,
      isOfNow: false,
    });
    clock.nowMs += 1;
    expect(heardOf(live.look()).linkState).toBe("not-reached");
  },
);

test("once it was heard, a lost or silent server is gone, and nothing of it is told any more", async () => {
  const { live, clock } = page();
  live.setLink("open");
  await live.take({ message: message(), jpeg: new Uint8Array() });
  expect(heardOf(live.look())).toMatchObject({
    linkState: "open",
    source: { name: "rehearsal" },
    isOfNow: true,
  });
  clock.nowMs = 700;
  expect(heardOf(live.look()), "heard, and what stood on the page is too old").toMatchObject({
    linkState: "open",
    isOfNow: false,
  });
  clock.nowMs = 801;
  expect(heardOf(live.look())).toEqual({
    linkState: "lost",
    source: null,
    snapshot: null,
    isOfNow: false,
  });
  live.setLink("lost");
  expect(heardOf(live.look()).linkState).toBe("lost");
});

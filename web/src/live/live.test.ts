import { beforeEach, expect, test } from "vitest";
import { message, snapshot } from "./builders";
import { Live } from "./live";

let nowMs: number;
let live: Live;
const jpeg = new Uint8Array([1]);
const frame = (imageNumber: number, ageMs = 20) => ({
  message: message({
    sequence: imageNumber,
    image_age_ms: ageMs,
    snapshot: snapshot({ image_number: imageNumber }),
  }),
  jpeg,
});

beforeEach(() => {
  nowMs = 1000;
  live = new Live(() => nowMs);
  live.setDraw(() => Promise.resolve(true));
  live.setLink("open");
});

test("numbers go by themselves 150 ms after their image was grabbed, with no message at all", async () => {
  await live.receive(frame(1));
  nowMs = 1130;
  expect(live.update().numbers.live).toBe(true);
  nowMs = 1131;
  expect(live.update().numbers).toMatchObject({ live: false, cause: "old" });
  expect(live.update().video.live).toBe(true);
  nowMs = 1481;
  expect(live.update().video).toMatchObject({ live: false, cause: "old" });
});

test("states when figures and picture expire, to the millisecond", async () => {
  expect(live.update().expiresAtMs).toBeNull();
  await live.receive(frame(1));
  expect(live.update().expiresAtMs).toBe(1131);
  nowMs = 1131;
  const withoutFigures = live.update();
  expect(withoutFigures.numbers.live).toBe(false);
  expect(withoutFigures.expiresAtMs).toBe(1481);
  nowMs = 1481;
  expect(live.update().expiresAtMs).toBeNull();
});

test("the time without numbers is counted from the last image that had them", async () => {
  await live.receive(frame(1));
  nowMs = 2180;
  expect(live.update().untrackedMs).toBe(1200);
});

test("numbers that were too old twice within a second return only after a while of recent images", async () => {
  await live.receive(frame(1, 200));
  nowMs = 1100;
  await live.receive(frame(2));
  expect(live.update().numbers.live).toBe(true);
  nowMs = 1300;
  expect(live.update().numbers).toMatchObject({ live: false, cause: "old" });
  await live.receive(frame(3));
  expect(live.update().numbers).toMatchObject({ live: false, cause: "old" });
  nowMs = 1551;
  await live.receive(frame(4));
  expect(live.update().numbers.live).toBe(true);
});

test("a removed picture never returns; only a new one is shown", async () => {
  await live.receive(frame(1));
  live.setHidden(true);
  live.setHidden(false);
  expect(live.update().video.live).toBe(false);
  await live.receive(frame(2));
  expect(live.update().video).toMatchObject({ live: true, imageNumber: 2 });
});

test("numbers do not wait for their picture", async () => {
  await live.receive(frame(1));
  let done: (drawn: boolean) => void = () => undefined;
  live.setDraw(
    () =>
      new Promise((resolve) => {
        done = resolve;
      }),
  );
  const taking = live.receive(frame(2));
  expect(live.update()).toMatchObject({ numbers: { imageNumber: 2 }, video: { imageNumber: 1 } });
  done(true);
  await taking;
  expect(live.update()).toMatchObject({ numbers: { imageNumber: 2 }, video: { imageNumber: 2 } });
});

test("a message without a picture brings numbers and alarms, and a slower picture does not undo them", async () => {
  await live.receive(frame(1));
  const alarms = { ...frame(4).message.alarms, revision: 7 };
  live.receiveMessage({ ...frame(4).message, alarms });
  expect(live.update()).toMatchObject({
    numbers: { imageNumber: 4 },
    newest: { alarms: { revision: 7 } },
    video: { imageNumber: 1 },
  });
  await live.receive(frame(3));
  live.receiveMessage(frame(2).message);
  expect(live.update()).toMatchObject({ numbers: { imageNumber: 4 }, video: { imageNumber: 3 } });
  live.receiveMessage({ ...frame(5).message, snapshot: null });
  expect(live.update().numbers).toMatchObject({ live: false, cause: "no-image" });
});

test("messages alone show nothing before the first picture, and nothing on a lost connection", async () => {
  live.receiveMessage(frame(1).message);
  expect(live.update().numbers).toMatchObject({ live: false, cause: "connecting" });
  await live.receive(frame(2));
  expect(live.update().numbers.live).toBe(true);
  live.setLink("lost");
  live.receiveMessage(frame(3).message);
  live.setLink("open");
  expect(live.update().newest).toBeNull();
});

test("a picture that cannot be drawn leaves its numbers", async () => {
  await live.receive(frame(1));
  live.setDraw(() => Promise.resolve(false));
  await live.receive(frame(2));
  expect(live.update()).toMatchObject({ numbers: { imageNumber: 2 }, video: { imageNumber: 1 } });
});

test("what was being drawn when the line was lost is not shown on the next line", async () => {
  let done: (drawn: boolean) => void = () => undefined;
  live.setDraw(
    () =>
      new Promise((resolve) => {
        done = resolve;
      }),
  );
  const taking = live.receive(frame(1));
  live.setLink("lost");
  live.setLink("open");
  done(true);
  expect(await taking).toMatchObject({ isDisplayed: false });
  expect(live.update().numbers.live).toBe(false);
});

test("time on the line counts as age: the clocks are compared, the stated age is not enough", async () => {
  // Requested at 1000, answered at 1000: the server's clock is 100.02 s.
  live.receiveAnswer(message(), nowMs, live.currentGeneration);
  nowMs = 1400;
  await live.receive(frame(8)); // captured at 100.0 s, 20 ms old when sent, 400 ms in transfer
  expect(live.update().numbers).toMatchObject({ live: false, ageMs: 420 });
});

test("an answer that came too late for its line is not heard", () => {
  const generation = live.currentGeneration;
  live.setLink("lost");
  live.setLink("open");
  live.receiveAnswer(message(), nowMs, generation);
  expect(live.update().newest).toBeNull();
});

test("the true age of everything can be read, clocks compared", async () => {
  await live.receive(frame(1));
  expect(live.update().ages).toEqual({
    pictureMs: 20,
    numbersMs: 20,
    sceneMs: null,
    clockAheadMs: null,
  });
  live.receiveAnswer(message(), nowMs, live.currentGeneration);
  nowMs = 1100;
  expect(live.update().ages).toMatchObject({ pictureMs: 120, clockAheadMs: 99_020 });
});

test("the page's own time for an image is separated from the network's", async () => {
  live.setDraw((_jpeg, _isCurrent, onDecoded) => {
    nowMs += 30;
    onDecoded();
    nowMs += 10;
    return Promise.resolve(true);
  });
  expect(await live.receive(frame(1))).toEqual({ isDisplayed: true, showingMs: 40 });
});

test("a page that was too busy to hear counts that as its own time", async () => {
  live.load.tick(nowMs);
  nowMs += 250;
  expect(await live.receive(frame(1))).toMatchObject({ showingMs: 200 });
});

test("a chosen size is reported at once, and the picture has the received size", async () => {
  const choices: string[] = [];
  live.setOnChoice((choice) => choices.push(choice));
  live.choosePicture("half");
  const { message: full, jpeg: picture } = frame(1);
  await live.receive({ message: { ...full, shown_scale_ratio: 0.5 }, jpeg: picture });
  expect(choices).toEqual(["half"]);
  expect(live.update().pictureDelivery).toMatchObject({ choice: "half", widthPx: 640, heightPx: 360 });
});

test("a silent server counts as lost within a second", async () => {
  await live.receive(frame(1));
  nowMs = 1801;
  expect(live.update().video).toMatchObject({ live: false, cause: "server-gone" });
});

test("a measurement receives each drawn picture with its message and time of arrival", async () => {
  const shown: [number, number][] = [];
  live.onShown = ({ message, receivedAtMs }) => {
    shown.push([message.sequence, receivedAtMs]);
  };
  await live.receive(frame(1));
  live.setDraw(() => Promise.resolve(false));
  nowMs = 1030;
  await live.receive(frame(2));
  expect(shown).toEqual([[1, 1000]]);
});

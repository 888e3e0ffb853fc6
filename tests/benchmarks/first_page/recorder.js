// Records what stands on the page whenever that changes. Nothing runs in between, and nothing is asked from outside:
// both would take time from the page, and a loop over the screen's images makes the browser draw all of them.
(() => {
  "use strict";
  if (window.top !== window) return;
  const CLOCK_SAMPLES = 9;
  const part = (name) => document.querySelector(`[data-testid="${name}"]`);
  const isLive = (name) => part(name)?.dataset.live === "true";
  const text = (name) => part(name)?.textContent ?? "";
  const stamp = (name) => {
    const found = /(\d+)\D+?(\d+) ms/.exec(text(name).replace(/\(.*\)/, ""));
    return found === null ? null : { image: Number(found[1]), ageMs: Number(found[2]) };
  };
  const begun = () => ({
    beganAt: performance.now(), numbersMs: { live: 0, late: 0, unseen: 0 }, videoMs: 0, sceneMs: 0,
    pictures: 0, sceneImages: 0, minWidthPx: null, widthMs: {}, agesMs: [], messageAgesMs: [], noteMs: {},
  });
  let seen = begun();
  let last = { at: performance.now(), numbers: "late", video: false, scene: false, note: "", widthPx: 0 };
  let images = { picture: null, scene: null };
  let serverAheadMs = null;

  // Numbers of a marker that is out of view are not late: the page says what it is that it does not see.
  const numbersAre = () => {
    if (isLive("numbers")) return "live";
    return part("numbers")?.dataset.cause === "unread" ? "unseen" : "late";
  };
  const count = () => {
    const at = performance.now();
    const spanMs = at - last.at;
    seen.numbersMs[last.numbers] += spanMs;
    if (last.video) seen.videoMs += spanMs;
    if (last.scene) seen.sceneMs += spanMs;
    if (last.note !== "") seen.noteMs[last.note] = (seen.noteMs[last.note] ?? 0) + spanMs;
    if (last.widthPx > 0) seen.widthMs[last.widthPx] = (seen.widthMs[last.widthPx] ?? 0) + spanMs;
    last = {
      at, numbers: numbersAre(), video: isLive("video"), scene: isLive("scene"),
      note: text("line-note").split(":")[0], widthPx: document.querySelector("canvas.sharp")?.width ?? 0,
    };
    const picture = stamp("video-stamp");
    if (picture !== null && picture.image !== images.picture) {
      seen.pictures += 1;
      seen.agesMs.push(picture.ageMs);
      seen.minWidthPx = Math.min(seen.minWidthPx ?? last.widthPx, last.widthPx);
    }
    const scene = stamp("scene-stamp");
    if (scene !== null && scene.image !== images.scene) seen.sceneImages += 1;
    images = { picture: picture?.image ?? null, scene: scene?.image ?? null };
  };
  const changes = new MutationObserver(count);

  // The age of each message as it reaches the page, by the server's clock.
  const Plain = window.WebSocket;
  window.WebSocket = class extends Plain {
    constructor(...given) {
      super(...given);
      if (!String(given[0]).includes("/ws/live")) return;
      this.addEventListener("message", ({ data }) => {
        const found = /"captured_at_s":([\d.]+)/.exec(data);
        if (found === null || serverAheadMs === null) return;
        seen.messageAgesMs.push(performance.now() + serverAheadMs - 1000 * Number(found[1]));
      });
    }
  };
  const compareClocks = async () => {
    let bestMs = Infinity;
    for (let sample = 0; sample < CLOCK_SAMPLES; sample += 1) {
      const askedAt = performance.now();
      const { sent_at_s } = await (await fetch("/api/live", { cache: "no-store" })).json();
      const answeredAt = performance.now();
      if (answeredAt - askedAt >= bestMs) continue;
      bestMs = answeredAt - askedAt;
      serverAheadMs = 1000 * sent_at_s - (askedAt + answeredAt) / 2;
    }
  };

  window.coaxialRecorder = {
    begin: async () => {
      await compareClocks();
      const watched = { subtree: true, childList: true, characterData: true };
      changes.observe(document.body, { ...watched, attributeFilter: ["data-live", "data-cause"] });
      count();
      seen = begun();
    },
    seen: () => {
      count();
      changes.disconnect();
      return { ...seen, spanMs: performance.now() - seen.beganAt };
    },
  };
})();

// Reads what stands on the page with every image of the screen. Nothing is asked of the page from outside while it is
// watched: each question would take time from it.
(() => {
  "use strict";
  if (window.top !== window) return;
  const part = (name) => document.querySelector(`[data-testid="${name}"]`);
  const isLive = (name) => part(name)?.dataset.live === "true";
  const text = (name) => part(name)?.textContent ?? "";
  const stamp = (name) => {
    const found = /(\d+)\D+?(\d+) ms/.exec(text(name).replace(/\(.*\)/, ""));
    return found === null ? null : { image: Number(found[1]), ageMs: Number(found[2]) };
  };
  const begun = () => ({
    beganAt: performance.now(), screenImages: 0, longestGapMs: 0,
    numbersMs: { live: 0, late: 0, unseen: 0 }, videoMs: 0, sceneMs: 0, pictures: 0, sceneImages: 0,
    minWidthPx: null, widthMs: {}, agesMs: [], noteMs: {}, sceneSizes: {},
  });
  let seen = begun();
  let last = { at: performance.now(), picture: null, scene: null };

  // Numbers of a marker that is out of view are not late: the picture beside them is live and young.
  const numbersAre = () => {
    if (isLive("numbers")) return "live";
    return isLive("video") && part("video")?.dataset.late !== "true" ? "unseen" : "late";
  };
  const look = () => {
    requestAnimationFrame(look);
    const at = performance.now();
    const spanMs = at - last.at;
    seen.screenImages += 1;
    seen.longestGapMs = Math.max(seen.longestGapMs, spanMs);
    seen.numbersMs[numbersAre()] += spanMs;
    if (isLive("video")) seen.videoMs += spanMs;
    if (isLive("scene")) seen.sceneMs += spanMs;
    const note = text("line-note").split(":")[0];
    if (note !== "") seen.noteMs[note] = (seen.noteMs[note] ?? 0) + spanMs;
    const picture = stamp("video-stamp");
    const widthPx = document.querySelector("canvas.sharp")?.width ?? 0;
    if (picture !== null) {
      seen.minWidthPx = Math.min(seen.minWidthPx ?? widthPx, widthPx);
      seen.widthMs[widthPx] = (seen.widthMs[widthPx] ?? 0) + spanMs;
      if (picture.image !== last.picture) {
        seen.pictures += 1;
        seen.agesMs.push(picture.ageMs);
      }
    }
    const scene = stamp("scene-stamp");
    if (scene !== null && scene.image !== last.scene) seen.sceneImages += 1;
    last = { at, picture: picture?.image ?? null, scene: scene?.image ?? null };
  };
  requestAnimationFrame(look);

  window.coaxialRecorder = {
    begin: () => { seen = begun(); last.at = performance.now(); },
    seen: () => ({ ...seen, spanMs: performance.now() - seen.beganAt }),
  };
})();

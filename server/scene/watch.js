// Stands in viser's page before viser does. It keeps an untouched screen alive, tells the page around it
// which image is drawn, and dims the scene by itself when what is drawn is not live.
(() => {
  "use strict";
  const staleAfterMs = __STALE_AFTER_MS__;
  const silentAfterMs = __SILENT_AFTER_MS__;
  const numberNode = __NUMBER_NODE__;
  const boneNode = __BONE_NODE__;
  const numberBase = __NUMBER_BASE__;

  let connected = false;
  let line = null; // the worker that holds viser's WebSocket
  let heardAt = 0; // when it last brought anything
  let drawn = null; // number of the image that is drawn
  let changedAt = -Infinity;
  let contextLost = false;

  const now = () => performance.now();

  const tell = () => {
    if (window.parent === window) return;
    window.parent.postMessage(
      { kind: "coaxial-scene", image_number: drawn, connected: connected && !contextLost },
      location.origin,
    );
  };

  // viser tries again after a lost connection only while its page has the focus, which nobody gives to a
  // screen in theatre.
  document.hasFocus = () => true;

  // Without a graphics card the processor draws the scene, which then takes a whole core from the video and
  // the tracker if it may. A dozen pictures a second are enough for it.
  const drawnByProcessor = (() => {
    const gl = document.createElement("canvas").getContext("webgl");
    const names = gl && gl.getExtension("WEBGL_debug_renderer_info");
    const name = names ? String(gl.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
    const lose = gl && gl.getExtension("WEBGL_lose_context");
    if (lose) lose.loseContext();
    return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
  })();
  if (drawnByProcessor) {
    const leastMs = 80;
    const ownRequest = window.requestAnimationFrame.bind(window);
    let due = new Map();
    let handle = 0;
    let lastAt = -Infinity;
    const tick = (at) => {
      if (at - lastAt < leastMs) {
        ownRequest(tick);
        return;
      }
      lastAt = at;
      const now = due;
      due = new Map();
      for (const callback of now.values()) callback(at);
    };
    window.requestAnimationFrame = (callback) => {
      if (due.size === 0) ownRequest(tick);
      handle += 1;
      due.set(handle, callback);
      return handle;
    };
    window.cancelAnimationFrame = (which) => due.delete(which);
  }

  // viser's WebSocket lives in a worker, whose messages tell how the line is.
  const OwnWorker = window.Worker;
  window.Worker = class extends OwnWorker {
    constructor(...options) {
      super(...options);
      this.addEventListener("message", (event) => {
        const type = event.data && event.data.type;
        if (type === "message_batch") {
          line = this;
          heardAt = now();
        } else if (type === "connected" || type === "closed") {
          line = this;
          heardAt = now();
          connected = type === "connected";
          // What was drawn is of the old line. The next number that moves is of the new one.
          drawn = null;
          changedAt = -Infinity;
          tell();
        }
      });
    }
  };

  addEventListener("webglcontextlost", () => { contextLost = true; drawn = null; tell(); }, true);
  addEventListener("webglcontextrestored", () => { contextLost = false; tell(); }, true);

  // The number is the position of a hidden node, read from the scene graph itself: it is set in the same
  // pass over the same batch as the drill's pose.
  // A translucent bone that hides its own far side is speckled where its triangles come in the wrong order.
  const clear = (nodes) => {
    for (const name of Object.keys(nodes)) {
      if (!name.endsWith(boneNode) || !nodes[name]) continue;
      nodes[name].traverse((part) => { if (part.material) part.material.depthWrite = false; });
    }
  };

  let last = null;
  const look = () => {
    requestAnimationFrame(look);
    const viewer = window.__viserMutable;
    const node = viewer && viewer.nodeRefFromName && viewer.nodeRefFromName[numberNode];
    if (!node || !connected || contextLost) return;
    const number = node.position.x < 1 ? null : (node.position.x - 1) * numberBase + node.position.y;
    if (number === last) return;
    clear(viewer.nodeRefFromName);
    last = number;
    drawn = number;
    changedAt = number === null ? -Infinity : now();
    tell();
  };
  requestAnimationFrame(look);
  tell();

  setInterval(() => {
    const live = connected && !contextLost && drawn !== null && now() - changedAt <= staleAfterMs;
    document.documentElement.dataset.coaxial = live ? "live" : "stale";
    // A server that lost its power says no goodbye: ask for a new line when the old one is silent.
    if (connected && line !== null && now() - heardAt > silentAfterMs) {
      connected = false;
      drawn = null;
      tell();
      heardAt = now();
      line.postMessage({ type: "retry" });
    }
  }, 100);

  addEventListener("DOMContentLoaded", () => {
    if (window.parent !== window) return; // the page around it says it better
    const cover = document.createElement("div");
    cover.id = "coaxial-stale";
    cover.textContent = "SCENE STALE";
    document.documentElement.append(cover);
  });
})();

// Stands in viser's page before viser does. It keeps an untouched screen alive, tells the page around it
// which image is drawn, and dims the scene by itself when what is drawn is not live.
(() => {
  "use strict";
  const staleAfterMs = __STALE_AFTER_MS__;
  const silentAfterMs = __SILENT_AFTER_MS__;
  const numberNode = __NUMBER_NODE__;
  const seenThrough = __SEEN_THROUGH__;
  const numberBase = __NUMBER_BASE__;
  const viewsNode = __VIEWS_NODE__;
  const viewAnglesDeg = __VIEW_ANGLES_DEG__;

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
      {
        kind: "coaxial-scene",
        image_number: drawn,
        connected: connected && !contextLost,
        drawn_by_processor: drawnByProcessor,
      },
      location.origin,
    );
  };

  // viser tries again after a lost connection only while its page has the focus, which nobody gives to a
  // screen in theatre.
  document.hasFocus = () => true;

  // Without a graphics card the processor draws the scene, which then takes a whole core from the video and
  // the tracker if it may.
  const drawnByProcessor = (() => {
    const gl = document.createElement("canvas").getContext("webgl");
    const names = gl && gl.getExtension("WEBGL_debug_renderer_info");
    const name = names ? String(gl.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
    const lose = gl && gl.getExtension("WEBGL_lose_context");
    if (lose) lose.loseContext();
    return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
  })();
  if (drawnByProcessor) {
    // Four samples a pixel and a copy of each image cost the processor more than they show.
    const ownContext = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, options) {
      const cheaper = { antialias: false, preserveDrawingBuffer: false };
      return ownContext.call(this, kind, kind.startsWith("webgl") ? { ...options, ...cheaper } : options);
    };
  }

  // No more images a second than the page around it allows; until it has spoken, a few where the processor
  // draws them. viser draws on demand, in frames that it asks for here.
  const slackMs = 4;
  let minIntervalMs = drawnByProcessor ? Math.min(200, 0.4 * staleAfterMs) : 0;
  const ownRequest = window.requestAnimationFrame.bind(window);
  let due = new Map();
  let handle = 0;
  let lastAt = -Infinity;
  let waiting = false;
  const drawDue = (at) => {
    lastAt = at;
    waiting = false;
    const callbacks = due;
    due = new Map();
    for (const callback of callbacks.values()) callback(at);
  };
  const wait = () => {
    if (waiting) return;
    waiting = true;
    const restMs = minIntervalMs - (now() - lastAt) - slackMs;
    if (restMs > 0) setTimeout(() => ownRequest(drawDue), restMs);
    else ownRequest(drawDue);
  };
  window.requestAnimationFrame = (callback) => {
    handle += 1;
    due.set(handle, callback);
    wait();
    return handle;
  };
  window.cancelAnimationFrame = (which) => due.delete(which);
  addEventListener("message", (event) => {
    if (event.origin !== location.origin || !event.data || event.data.kind !== "coaxial-rate") return;
    const wanted = Number(event.data.min_interval_ms);
    if (wanted >= 0 && wanted <= staleAfterMs) minIntervalMs = wanted;
  });

  // viser's WebSocket lives in a worker, whose messages tell how the line is. Every second without a line viser
  // tries anew and gives up the attempt before: a server that is just starting would never be reached.
  const answerWithinMs = 3000;
  let triedAt = -Infinity;
  const OwnWorker = window.Worker;
  window.Worker = class extends OwnWorker {
    constructor(...options) {
      super(...options);
      this.addEventListener("message", (event) => {
        const type = event.data && event.data.type;
        if (type === "connected" || type === "closed") triedAt = -Infinity;
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

    postMessage(message, ...rest) {
      if (message && message.type === "retry") {
        if (now() - triedAt < answerWithinMs) return;
        triedAt = now();
      }
      super.postMessage(message, ...rest);
    }
  };

  // The page around it has the server again: do not wait for viser's next try.
  addEventListener("message", (event) => {
    if (event.origin !== location.origin || !event.data || event.data.kind !== "coaxial-server") return;
    if (!connected && line !== null) line.postMessage({ type: "retry" });
  });

  addEventListener("webglcontextlost", () => { contextLost = true; drawn = null; tell(); }, true);
  addEventListener("webglcontextrestored", () => { contextLost = false; tell(); }, true);

  // The number is the position of a hidden node, read from the scene graph itself: it is set in the same
  // pass over the same batch as the drill's pose.
  // A translucent bone that hides its own far side is speckled where its triangles come in the wrong order.
  const clear = (nodes) => {
    for (const name of Object.keys(nodes)) {
      if (!seenThrough.some((part) => name.endsWith(part)) || !nodes[name]) continue;
      nodes[name].traverse((part) => { if (part.material) part.material.depthWrite = false; });
    }
  };

  // From where the viewer looks. A view is put in place when it is chosen, and again when it moves; between
  // that a person may turn it freely. Which nodes tell it is in `views.py`.
  const asked = new URLSearchParams(location.search).get("view");
  let view = Object.hasOwn(viewAnglesDeg, asked) ? asked : null;
  let viewedFrom = null;
  const place = (viewer, part) => {
    const node = viewer.nodeRefFromName[`${viewsNode}/${view}_${part}`];
    if (!node) return null;
    node.updateWorldMatrix(true, false);
    return Array.from(node.matrixWorld.elements.slice(12, 15));
  };
  const follow = (viewer) => {
    if (view === null || !viewer.cameraControl || !viewer.camera) return;
    const [eye, target, up] = ["eye", "look", "up"].map((part) => place(viewer, part));
    if (!eye || !target || !up || Math.hypot(...eye.map((v, i) => v - target[i])) < 1) return;
    const told = [...eye, ...target];
    if (viewedFrom && told.every((v, i) => Math.abs(v - viewedFrom[i]) < 0.5)) return;
    viewedFrom = told;
    const length = Math.hypot(...up.map((v, i) => v - eye[i]));
    viewer.camera.up.set(...up.map((v, i) => (v - eye[i]) / length));
    viewer.camera.fov = viewAnglesDeg[view];
    viewer.camera.updateProjectionMatrix();
    viewer.cameraControl.updateCameraUp();
    viewer.cameraControl.setLookAt(...eye, ...target, false);
  };
  addEventListener("message", (event) => {
    if (event.origin !== location.origin || !event.data || event.data.kind !== "coaxial-view") return;
    if (!Object.hasOwn(viewAnglesDeg, event.data.view)) return;
    view = event.data.view;
    viewedFrom = null;
  });

  // A click on the bone, as a point of it in the vertebra frame, which is that of the mesh. three.js is inside of
  // viser's bundle and only reached through its objects.
  const boneNode = __BONE_NODE__;
  const clickWithinPx = 5;
  const clickWithinMs = 600;
  const meshesOf = (viewer) => {
    const found = [];
    for (const [name, node] of Object.entries(viewer.nodeRefFromName)) {
      if (node && name.endsWith(boneNode)) node.traverse((part) => { if (part.isMesh) found.push(part); });
    }
    return found;
  };
  const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  // Share of the way from `start` at which a ray meets a triangle (Moeller and Trumbore 1997); infinite if it misses.
  const meets = (start, way, [a, b, c]) => {
    const [ab, ac] = [minus(b, a), minus(c, a)];
    const normal = cross(way, ac);
    const scale = dot(ab, normal);
    if (Math.abs(scale) < 1e-12) return Infinity;
    const toStart = minus(start, a);
    const u = dot(toStart, normal) / scale;
    const side = cross(toStart, ab);
    const v = dot(way, side) / scale;
    const share = dot(ac, side) / scale;
    return u >= 0 && v >= 0 && u + v <= 1 && share > 0 ? share : Infinity;
  };
  const pointOnMesh = (mesh, camera, x, y) => {
    const { position } = mesh.geometry.attributes;
    const { index } = mesh.geometry;
    mesh.updateWorldMatrix(true, false);
    const fromWorld = mesh.matrixWorld.clone().invert();
    const [start, end] = [-1, 1].map((depth) =>
      camera.position.clone().set(x, y, depth).unproject(camera).applyMatrix4(fromWorld).toArray());
    const way = minus(end, start);
    const corner = (number) => {
      const at = index ? index.getX(number) : number;
      return [position.getX(at), position.getY(at), position.getZ(at)];
    };
    let nearest = Infinity;
    for (let first = 0; first < (index || position).count; first += 3) {
      nearest = Math.min(nearest, meets(start, way, [corner(first), corner(first + 1), corner(first + 2)]));
    }
    return { share: nearest, point: start.map((one, axis) => one + nearest * way[axis]) };
  };
  const clickOn = (event) => {
    const viewer = window.__viserMutable;
    if (window.parent === window || !viewer || !viewer.camera || !viewer.nodeRefFromName) return;
    if (document.documentElement.dataset.coaxial !== "live") return;
    // Searching the bone takes 0.1 s of the page; only where a click marks.
    if (window.frameElement?.dataset.marking !== "true") return;
    const x = (2 * event.clientX) / innerWidth - 1;
    const y = 1 - (2 * event.clientY) / innerHeight;
    const [first] = meshesOf(viewer)
      .map((mesh) => pointOnMesh(mesh, viewer.camera, x, y))
      .filter(({ share }) => share < Infinity)
      .sort((a, b) => a.share - b.share);
    if (!first) return;
    const message = { kind: "coaxial-bone-point", point_in_vertebra_mm: first.point };
    window.parent.postMessage(message, location.origin);
  };
  let pressed = null;
  addEventListener("pointerdown", (event) => {
    pressed = event.isPrimary && event.button === 0 ? { x: event.clientX, y: event.clientY, at: now() } : null;
  }, true);
  addEventListener("pointerup", (event) => {
    // What moves the view is no click.
    const isClick = pressed !== null && event.isPrimary && now() - pressed.at <= clickWithinMs &&
      Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) <= clickWithinPx;
    pressed = null;
    if (isClick) clickOn(event);
  }, true);

  let last = null;
  const look = () => {
    requestAnimationFrame(look);
    const viewer = window.__viserMutable;
    if (viewer && viewer.nodeRefFromName && drawn !== null) follow(viewer);
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
